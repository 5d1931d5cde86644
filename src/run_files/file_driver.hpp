#pragma once

#include <hdf5.h>
#if H5_VERSION_GE(1, 13, 2)
#include <H5FDdevelop.h> // where later versions keep what a file driver needs
#endif

#include <cstddef>
#include <map>
#include <utility>
#include <vector>

namespace ehdjet::hdf5 {

/// Free stretches of a file: first fit, neighbours joined.
class FreeSpace {
public:
  void add(haddr_t address, hsize_t size);
  /// Address of a stretch of `size` bytes, taken out; HADDR_UNDEF if there is none. What fits
  /// into one page never crosses a page boundary: the kernel writes a page whole or not at all.
  haddr_t take(hsize_t size);

private:
  std::map<haddr_t, hsize_t> stretches_;
};

/// How HDF5 reaches the disk here: every commit is a transaction.
///
/// HDF5 rewrites its indices in place and in no useful order, so that a process killed half-way
/// through a flush leaves a file nobody can open. This driver never touches what the last
/// committed state refers to: new data go to unused space at once, rewrites of existing parts
/// wait in memory until `commit`, which makes them in an order where each single write leaves a
/// readable file (below: file end, data, heaps, chunk indices from the root down, and last the
/// object headers, which say how many rows there are).
///
/// laws   : a process killed at any instant leaves the last commit, or the next one, or the next
///          one with some data sets still at their old length; so does a full disk
/// cost   : the rewritten parts in memory, a few hundred bytes per data set
/// errors : survives the end of the process, not that of the machine (no fsync)
/// checked: dying_within_any_write_of_a_small_run_keeps_the_last_flush
class FileDriver : public H5FD_t {
public:
  /// File access properties that select this driver for H5Fcreate and H5Fopen; the caller closes.
  static hid_t access_properties();
  /// The driver behind an open file.
  static FileDriver& of(hid_t file);

  /// Makes everything that HDF5 has written part of the file; to be called after H5Fflush.
  void commit();
  /// `size` bytes at `address` are not needed any more once the next commit is done.
  void release(haddr_t address, hsize_t size);
  /// Gives up: nothing reaches the file any more, closing it leaves the last commit.
  void abandon(int error);
  /// errno of the write that failed; 0 as long as all is well.
  [[nodiscard]] int error() const { return error_; }

private:
  struct Rewrite {
    H5FD_mem_t type;
    haddr_t address;
    std::vector<unsigned char> bytes;
    [[nodiscard]] haddr_t end() const { return address + bytes.size(); }
    [[nodiscard]] int rank() const;
  };
  struct Callbacks; // what HDF5 calls

  haddr_t allocate(hsize_t size);
  bool read(haddr_t address, std::size_t size, unsigned char* to);
  bool write(H5FD_mem_t type, haddr_t address, std::size_t size, const unsigned char* from);
  bool write_now(haddr_t address, std::size_t size, const unsigned char* from);
  [[nodiscard]] bool is_new(haddr_t address, std::size_t size) const;
  bool set_length(haddr_t length);

  int descriptor_ = -1;
  int error_ = 0;
  bool ever_committed_ = false;
  haddr_t end_ = 0, committed_end_ = 0;
  std::map<haddr_t, hsize_t> new_;               ///< given out since the last commit
  std::vector<std::pair<haddr_t, hsize_t>> old_; ///< free after the next commit
  FreeSpace free_;                               ///< free now
  std::vector<Rewrite> rewrites_;                ///< of committed parts, oldest first
};

} // namespace ehdjet::hdf5
