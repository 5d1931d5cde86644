#include "ehdjet/core/new_file.hpp"

#include "ehdjet/core/error.hpp"

#include <cerrno>
#include <cstddef>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <sys/stat.h>
#include <system_error>
#include <unistd.h>
#include <utility>

namespace ehdjet {
namespace {

namespace fs = std::filesystem;

/// The path behind a link, or behind a chain of links, of which the last may lead to nothing.
fs::path followed(fs::path path) {
  constexpr int most_links = 40; // as many as the kernel follows
  std::error_code error;
  for (int i = 0; i < most_links && fs::is_symlink(path, error); ++i) {
    const fs::path to = fs::read_symlink(path, error);
    if (error) break;
    path = to.is_absolute() ? to : path.parent_path() / to;
  }
  return path;
}

/// Renames a file unless the new name exists. Returns errno.
int rename_to_free_name(const fs::path& from, const fs::path& to) {
#ifdef RENAME_NOREPLACE
  if (::renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0)
    return 0;
  if (errno == EEXIST) return errno;
#endif
  // A file system that cannot do that may have hard links.
  if (::link(from.c_str(), to.c_str()) == 0) {
    ::unlink(from.c_str());
    return 0;
  }
  if (errno == EEXIST) return errno;
  struct stat status {};
  if (::lstat(to.c_str(), &status) == 0) return EEXIST;
  return ::rename(from.c_str(), to.c_str()) == 0 ? 0 : errno;
}

} // namespace

void refuse_input(const fs::path& output, const fs::path& input) {
  std::error_code ignored;
  if (!fs::equivalent(output, input, ignored)) return;
  throw InputError(output.string() + " is the file " + input.string()
                   + " that is read: choose another name with -o");
}

NewFile::NewFile(const fs::path& name, bool overwrite)
    : name_(name)
    , target_(followed(name))
    , overwrite_(overwrite) {
  std::error_code error;
  if (fs::is_symlink(target_, error)) fail("its links lead back to it");
  const fs::file_status there = fs::status(target_, error);
  if (fs::is_directory(there)) fail("it is a folder");
  if (fs::exists(there) && !overwrite) refuse_existing();
  if (fs::exists(there)) {
    stream_ = !fs::is_regular_file(there);
    if (::access(target_.c_str(), W_OK) != 0)
      throw InputError("cannot overwrite " + name.string() + ": " + std::strerror(errno));
  }
  target_ = fs::absolute(target_, error);
  if (error) fail(error.message());
  const fs::path folder = target_.parent_path();
  if (!fs::is_directory(folder, error)) fail("there is no folder " + folder.string());
  if (!stream_ && ::access(folder.c_str(), W_OK | X_OK) != 0) fail(std::strerror(errno));
}

NewFile::NewFile(NewFile&& other) noexcept
    : name_(std::move(other.name_))
    , target_(std::move(other.target_))
    , temporary_(std::move(other.temporary_))
    , overwrite_(other.overwrite_)
    , stream_(other.stream_)
    , created_(std::exchange(other.created_, false)) {}

NewFile::~NewFile() {
  if (created_) ::unlink(temporary_.c_str());
}

const fs::path& NewFile::create() {
  if (stream_) return target_;
  EHDJET_EXPECTS(!created_);
  constexpr std::size_t most_characters = 200; // of the 255 that a name may have
  constexpr int most_attempts = 100;           // others may have left theirs
  std::string stem(1, '.');
  stem.append(target_.filename().string(), 0, most_characters)
      .append(1, '.')
      .append(std::to_string(::getpid()));
  int file = -1;
  for (int i = 0; i < most_attempts && file < 0; ++i) {
    temporary_ = target_.parent_path() / stem;
    if (i > 0) temporary_ += std::to_string(-i);
    file =
        ::open(temporary_.c_str(), O_CREAT | O_EXCL | O_RDWR | O_CLOEXEC, 0666); // NOLINT
    if (file < 0 && errno != EEXIST) break;
  }
  if (file < 0) fail(std::strerror(errno));
  created_ = true;
  struct stat old {};
  if (overwrite_ && ::stat(target_.c_str(), &old) == 0)
    (void)::fchmod(file,
                   old.st_mode & 0777U); // who could read the old file can read this one
  ::close(file);
  return temporary_;
}

void NewFile::publish() {
  if (stream_) return;
  EHDJET_EXPECTS(created_);
  const int error = overwrite_
                        ? (::rename(temporary_.c_str(), target_.c_str()) == 0 ? 0 : errno)
                        : rename_to_free_name(temporary_, target_);
  if (error == EEXIST) refuse_existing();
  if (error != 0) fail(std::strerror(error));
  created_ = false;
}

void NewFile::refuse_existing() const {
  throw InputError(name_.string()
                   + " exists: choose another name with -o or overwrite it with --force");
}

void NewFile::fail(const std::string& why) const {
  throw InputError("cannot create " + name_.string() + ": " + why);
}

} // namespace ehdjet
