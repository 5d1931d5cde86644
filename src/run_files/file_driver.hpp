#pragma once

#include <hdf5.h>
#if H5_VERSION_GE(1, 13, 2)
#include <H5FDdevelop.h> // where later versions keep what a file driver needs
#endif

#include <cstddef>
#include <filesystem>
#include <map>
#include <utility>
#include <vector>

namespace ehdjet::hdf5 {

/// Free parts of a file. Parts that touch are joined, and the first one that fits is taken.
class FreeSpace {
public:
  void add(haddr_t address, hsize_t size);
  /// Takes `size` bytes and returns their address, or HADDR_UNDEF if no part fits. A block that
  /// fits into one page never crosses a page boundary: the kernel writes all of a page or nothing.
  haddr_t take(hsize_t size);

private:
  std::map<haddr_t, hsize_t> parts_; ///< size by address
};

/// The right to replace a file, which nobody has while a run writes it or another one replaces it. A file
/// system without locks always gives it.
///
/// A run holds a shared lock on its file, which other programs can therefore read. Who wants to replace
/// the file asks for an exclusive one.
class ReplaceLock {
public:
  explicit ReplaceLock(const char* path);
  ~ReplaceLock();
  ReplaceLock(const ReplaceLock&) = delete;
  ReplaceLock& operator=(const ReplaceLock&) = delete;
  [[nodiscard]] bool is_refused() const { return refused_; }

private:
  int descriptor_;
  bool refused_ = false;
};

/// The HDF5 file driver of run files: every commit is a transaction.
///
/// HDF5 rewrites its indices in place and in an arbitrary order. If the process were killed during
/// a flush, the file could not be opened any more. This driver does not change anything that the
/// last commit refers to. New data go to unused space at once. Rewrites of existing parts wait in
/// memory until `commit`. It writes them in an order in which the file is readable after each
/// single write: file end, data, heaps, chunk indices from the root down, and finally the object
/// headers, which contain the number of rows.
///
/// laws   : a process killed at any instant leaves the last commit, or the next one, or the next
///          one with some data sets still at their old length; so does a full disk
/// cost   : the rewritten parts in memory, a few hundred bytes per data set
/// errors : a crash of the machine after a commit that was not followed by `sync` may damage the file
/// checked: dying_within_any_write_of_a_small_run_keeps_the_last_flush
class FileDriver : public H5FD_t {
public:
  /// File access properties that select this driver for H5Fcreate and H5Fopen. The caller closes
  /// them.
  static hid_t access_properties();
  /// The driver behind an open file.
  static FileDriver& of(hid_t file);

  /// Makes everything that HDF5 has written part of the file. Must be called after H5Fflush.
  void commit();
  /// Each commit from now on keeps `size` bytes of the disk behind the end of the file. If a later one fails,
  /// they are still there when the file is opened again. 0: the next commits may use them.
  void keep_room(hsize_t size) { room_ = size; }
  /// Marks `size` bytes at `address` as free after the next commit.
  void release(haddr_t address, hsize_t size);
  /// Sees to it that the last commit survives a crash of the machine.
  void sync();
  /// The path of the file: `name`, another one if it was renamed, empty if it was removed or replaced.
  [[nodiscard]] std::filesystem::path place(const std::filesystem::path& name) const;
  /// Stops all writing. Closing the file then leaves the last commit.
  void abandon(int error);
  /// errno of the write that failed; 0 if none has failed.
  [[nodiscard]] int error() const { return error_; }

private:
  struct Rewrite {
    H5FD_mem_t type;
    haddr_t address;
    std::vector<unsigned char> bytes;
    [[nodiscard]] haddr_t end() const { return address + bytes.size(); }
    [[nodiscard]] int rank() const;
  };
  struct Callbacks;

  haddr_t allocate(hsize_t size);
  void set_end(haddr_t end);
  bool read(haddr_t address, std::size_t size, unsigned char* to);
  bool write(H5FD_mem_t type, haddr_t address, std::size_t size, const unsigned char* from);
  bool write_now(haddr_t address, std::size_t size, const unsigned char* from);
  [[nodiscard]] bool is_new(haddr_t address, std::size_t size) const;
  bool extend();

  int descriptor_ = -1;
  int error_ = 0;
  bool ever_committed_ = false;
  haddr_t end_ = 0, committed_end_ = 0;
  hsize_t room_ = 0;
  haddr_t room_end_ = 0;                         ///< what the disk has for sure
  std::map<haddr_t, hsize_t> new_;               ///< allocated since the last commit
  std::vector<std::pair<haddr_t, hsize_t>> old_; ///< free after the next commit
  FreeSpace free_;                               ///< free now
  std::vector<Rewrite> rewrites_;                ///< of committed parts, oldest first
};

} // namespace ehdjet::hdf5
