#include "file_driver.hpp"

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <iterator>
#include <new>
#include <string>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>

namespace ehdjet::hdf5 {
namespace {

constexpr hsize_t page = 4096;

// The first address >= `address` where `size` bytes cross no page boundary, if they fit in a page.
haddr_t fit(haddr_t address, hsize_t size) {
  const bool crosses = size <= page && address % page + size > page;
  return crosses ? (address / page + 1) * page : address;
}

// Locks an open file until it is closed. Returns false if another lock stands against it.
bool lock(int descriptor, int type) {
#ifdef F_OFD_SETLK
  struct flock whole {};
  whole.l_type = static_cast<short>(type), whole.l_whence = SEEK_SET;
  return ::fcntl(descriptor, F_OFD_SETLK, &whole) == 0 // NOLINT: POSIX declares it so
         || (errno != EACCES && errno != EAGAIN);
#else
  (void)type;
  return descriptor >= 0;
#endif
}

} // namespace

void FreeSpace::add(haddr_t address, hsize_t size) {
  if (size == 0) return;
  auto next = parts_.upper_bound(address);
  if (next != parts_.begin()) {
    const auto previous = std::prev(next);
    if (previous->first + previous->second == address) {
      address = previous->first, size += previous->second;
      parts_.erase(previous);
    }
  }
  if (next != parts_.end() && next->first == address + size) {
    size += next->second;
    parts_.erase(next);
  }
  parts_.emplace(address, size);
}

haddr_t FreeSpace::take(hsize_t size) {
  for (auto it = parts_.begin(); it != parts_.end(); ++it) {
    const auto [begin, length] = *it;
    const haddr_t address = fit(begin, size);
    if (address + size > begin + length) continue;
    parts_.erase(it);
    add(begin, address - begin);
    add(address + size, begin + length - address - size);
    return address;
  }
  return HADDR_UNDEF;
}

ReplaceLock::ReplaceLock(const char* path)
    : descriptor_(::open(path, O_RDWR | O_CLOEXEC)) { // NOLINT: POSIX declares it so
  refused_ = descriptor_ >= 0 && !lock(descriptor_, F_WRLCK);
}

ReplaceLock::~ReplaceLock() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

// Position in the order of a commit. A chunk index is a tree whose nodes begin with "TREE", node
// type, level. HDF5 splits a node by moving entries to a new sibling. If the parent is written
// first, it refers to both nodes, and all entries are found in either state of the child. If the
// child were written first, entries would be missing.
int FileDriver::Rewrite::rank() const {
  switch (type) {
  case H5FD_MEM_SUPER:
    return 0;
  case H5FD_MEM_DRAW:
    return 1;
  case H5FD_MEM_GHEAP:
  case H5FD_MEM_LHEAP:
    return 2;
  case H5FD_MEM_BTREE: {
    const bool is_index = bytes.size() > 5 && std::memcmp(bytes.data(), "TREE", 4) == 0;
    return 3 + 255 - (is_index ? bytes[5] : 0);
  }
  default:
    return 1000;
  }
}

bool FileDriver::is_new(haddr_t address, std::size_t size) const {
  if (!ever_committed_) return true;
  const auto next = new_.upper_bound(address);
  if (next == new_.begin()) return false;
  const auto& [begin, length] = *std::prev(next);
  return address + size <= begin + length;
}

haddr_t FileDriver::allocate(hsize_t size) {
  haddr_t address = free_.take(size);
  if (address == HADDR_UNDEF) {
    address = fit(end_, size);
    free_.add(end_, address - end_);
    end_ = address + size;
  }
  new_[address] = size;
  return address;
}

// HDF5 moves the end when it opens a file, and when it enlarges the last block. What that adds is as new as a
// block of its own: if it waited with the rewrites, others could refer to it before it is there.
void FileDriver::set_end(haddr_t end) {
  const haddr_t begin = std::max(end_, committed_end_);
  end_ = end;
  if (end <= begin) return;
  const auto last = new_.empty() ? new_.end() : std::prev(new_.end());
  if (last != new_.end() && last->first + last->second == begin)
    last->second += end - begin;
  else
    new_[begin] = end - begin;
}

void FileDriver::release(haddr_t address, hsize_t size) {
  old_.emplace_back(address, size);
}

bool FileDriver::read(haddr_t address, std::size_t size, unsigned char* to) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t n =
        ::pread(descriptor_, to + done, size - done, static_cast<off_t>(address + done));
    if (n < 0 && errno == EINTR) continue;
    if (n < 0) return false;
    if (n == 0) break;
    done += static_cast<std::size_t>(n);
  }
  std::memset(to + done, 0, size - done); // HDF5 expects zeros beyond the end
  for (const Rewrite& held : rewrites_) {
    const haddr_t begin = std::max(address, held.address),
                  end = std::min(address + size, held.end());
    if (begin >= end) continue;
    std::memcpy(to + (begin - address), held.bytes.data() + (begin - held.address),
                end - begin);
  }
  return true;
}

bool FileDriver::write(H5FD_mem_t type, haddr_t address, std::size_t size,
                       const unsigned char* from) {
  if (error_ != 0) return true; // closing an abandoned file then reports no error
  if (is_new(address, size)) return write_now(address, size, from);
  std::erase_if(rewrites_, [&](const Rewrite& held) {
    return address <= held.address && held.end() <= address + size;
  });
  rewrites_.push_back({type, address, {from, from + size}});
  return true;
}

bool FileDriver::write_now(haddr_t address, std::size_t size, const unsigned char* from) {
  std::size_t done = 0;
  while (done < size) {
    const ssize_t n =
        ::pwrite(descriptor_, from + done, size - done, static_cast<off_t>(address + done));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      abandon(n < 0 ? errno : ENOSPC);
      return false;
    }
    done += static_cast<std::size_t>(n);
  }
  return true;
}

// The length is set first: a file shorter than its superblock says counts as truncated.
bool FileDriver::extend() {
  if (room_ > 0 && room_end_ < end_ + room_) {
    const int refused =
        ::posix_fallocate(descriptor_, static_cast<off_t>(end_), static_cast<off_t>(room_));
    if (refused == ENOSPC || refused == EFBIG || refused == EDQUOT) {
      abandon(refused);
      return false;
    }
    if (refused == 0) room_end_ = end_ + room_;
  }
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0 || static_cast<haddr_t>(status.st_size) >= end_
      || ::ftruncate(descriptor_, static_cast<off_t>(end_)) == 0)
    return true;
  abandon(errno);
  return false;
}

void FileDriver::commit() {
  if (error_ != 0 || !extend()) return;
  std::stable_sort(rewrites_.begin(), rewrites_.end(),
                   [](const Rewrite& a, const Rewrite& b) { return a.rank() < b.rank(); });
  for (const Rewrite& held : rewrites_)
    if (!write_now(held.address, held.bytes.size(), held.bytes.data())) return;
  rewrites_.clear();
  new_.clear();
  for (const auto& [address, size] : old_) free_.add(address, size);
  old_.clear();
  committed_end_ = end_;
  ever_committed_ = true;
}

void FileDriver::sync() {
  if (error_ != 0 || ::fdatasync(descriptor_) == 0) return;
  if (errno != EINVAL && errno != ENOSYS && errno != EROFS) abandon(errno);
}

std::filesystem::path FileDriver::place(const std::filesystem::path& name) const {
  struct stat own {
  }, there{};
  const auto has_name = [&](const std::filesystem::path& path) {
    return ::stat(path.c_str(), &there) == 0 && there.st_dev == own.st_dev
           && there.st_ino == own.st_ino;
  };
  if (::fstat(descriptor_, &own) != 0 || has_name(name)) return name;
  if (own.st_nlink == 0) return {};
  std::error_code error;
  const auto now =
      std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor_), error);
  return !error && has_name(now) ? now : name;
}

void FileDriver::abandon(int error) {
  if (error_ == 0) error_ = error;
}

// The functions that HDF5 calls. They must not throw, because HDF5 is written in C.
struct FileDriver::Callbacks {
  static FileDriver& self(H5FD_t* file) { return *static_cast<FileDriver*>(file); }
  static const FileDriver& self(const H5FD_t* file) {
    return *static_cast<const FileDriver*>(file);
  }

  static H5FD_t* open(const char* name, unsigned flags, hid_t, haddr_t) noexcept {
    int how = O_CLOEXEC | ((flags & H5F_ACC_RDWR) != 0 ? O_RDWR : O_RDONLY);
    if ((flags & H5F_ACC_CREAT) != 0) how |= O_CREAT;
    if ((flags & H5F_ACC_EXCL) != 0) how |= O_EXCL;
    if ((flags & H5F_ACC_TRUNC) != 0) how |= O_TRUNC;
    const int descriptor = ::open(name, how, 0666); // NOLINT: POSIX declares it so
    if (descriptor < 0) return nullptr;
    auto* file = new (std::nothrow) FileDriver{};
    if (file == nullptr) {
      ::close(descriptor);
      return nullptr;
    }
    struct stat status {};
    if ((flags & H5F_ACC_RDWR) != 0) (void)lock(descriptor, F_RDLCK); // see ReplaceLock
    file->descriptor_ = descriptor;
    file->ever_committed_ = ::fstat(descriptor, &status) == 0 && status.st_size > 0;
    file->committed_end_ = static_cast<haddr_t>(status.st_size);
    return file;
  }
  static herr_t close(H5FD_t* file) noexcept {
    FileDriver& driver = self(file);
    if (!driver.rewrites_.empty() || !driver.new_.empty()) driver.commit();
    haddr_t end = driver.committed_end_;
    if (driver.error_ != 0) end = std::max(end, driver.room_end_);
    const bool ok = ::ftruncate(driver.descriptor_, static_cast<off_t>(end)) == 0;
    const bool closed = ::close(driver.descriptor_) == 0;
    delete &driver;
    return ok && closed ? 0 : -1;
  }
  static herr_t query(const H5FD_t*, unsigned long* flags) noexcept {
    // No flag lets HDF5 combine writes, so that each write keeps its type.
    *flags = H5FD_FEAT_DEFAULT_VFD_COMPATIBLE;
    return 0;
  }
  static haddr_t allocate(H5FD_t* file, H5FD_mem_t, hid_t, hsize_t size) noexcept {
    return self(file).allocate(size);
  }
  static herr_t release(H5FD_t*, H5FD_mem_t, hid_t, haddr_t, hsize_t) noexcept {
    return 0; // HDF5 reports only space at the end of the file; see FileDriver::release
  }
  static haddr_t allocated_end(const H5FD_t* file, H5FD_mem_t) noexcept {
    return self(file).end_;
  }
  static herr_t set_allocated_end(H5FD_t* file, H5FD_mem_t, haddr_t end) noexcept {
    self(file).set_end(end);
    return 0;
  }
  static haddr_t length(const H5FD_t* file, H5FD_mem_t) noexcept {
    struct stat status {};
    return ::fstat(self(file).descriptor_, &status) == 0
               ? static_cast<haddr_t>(status.st_size)
               : 0;
  }
  static herr_t handle(H5FD_t* file, hid_t, void** to) noexcept {
    *to = &self(file);
    return 0;
  }
  static herr_t read(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t address, size_t size,
                     void* to) noexcept {
    return self(file).read(address, size, static_cast<unsigned char*>(to)) ? 0 : -1;
  }
  static herr_t write(H5FD_t* file, H5FD_mem_t type, hid_t, haddr_t address, size_t size,
                      const void* from) noexcept {
    return self(file).write(type, address, size, static_cast<const unsigned char*>(from))
               ? 0
               : -1;
  }
};

hid_t FileDriver::access_properties() {
  static const H5FD_class_t callbacks = [] {
    H5FD_class_t c{};
#if H5_VERSION_GE(1, 13, 2)
    c.version = H5FD_CLASS_VERSION,
    c.value = static_cast<H5FD_class_value_t>(512); // from the range for private drivers
#endif
    c.name = "ehdjet_transactions";
    c.maxaddr = (haddr_t{1} << 62U) - 1;
    c.fc_degree = H5F_CLOSE_STRONG; // closing the file closes all objects in it
    c.open = Callbacks::open, c.close = Callbacks::close, c.query = Callbacks::query;
    c.alloc = Callbacks::allocate, c.free = Callbacks::release;
    c.get_eoa = Callbacks::allocated_end, c.set_eoa = Callbacks::set_allocated_end;
    c.get_eof = Callbacks::length, c.get_handle = Callbacks::handle;
    c.read = Callbacks::read, c.write = Callbacks::write;
    return c;
  }();
  static const hid_t driver = H5FDregister(&callbacks);
  const hid_t properties = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_driver(properties, driver, nullptr);
  // HDF5 passes each request for space on unchanged. Metadata get checksums instead of symbol
  // tables.
  H5Pset_meta_block_size(properties, 0);
  H5Pset_small_data_block_size(properties, 0);
  H5Pset_sieve_buf_size(properties, 0);
  H5Pset_libver_bounds(properties, H5F_LIBVER_V18, H5F_LIBVER_LATEST);
  return properties;
}

FileDriver& FileDriver::of(hid_t file) {
  void* driver = nullptr;
  H5Fget_vfd_handle(file, H5P_DEFAULT, &driver);
  return *static_cast<FileDriver*>(driver);
}

} // namespace ehdjet::hdf5
