#include "ehdjet/io/text_output.hpp"

#include "ehdjet/core/error.hpp"

#include <cerrno>
#include <cstring>
#include <system_error>

namespace ehdjet {

void refuse_existing(const std::filesystem::path& path, bool overwrite) {
  std::error_code ignored;
  if (!overwrite && std::filesystem::exists(path, ignored))
    throw InputError(path.string()
                     + " exists: choose another name with -o or overwrite it with --force");
}

TextOutput::TextOutput(const std::filesystem::path& path, bool overwrite)
    : path_(path) {
  refuse_existing(path, overwrite);
}

void TextOutput::close() {
  drain();
  if (std::FILE* file = file_.release(); file != nullptr && std::fclose(file) != 0)
    fail(errno);
}

void TextOutput::drain() {
  if (!file_ && !path_.empty()) {
    file_.reset(std::fopen(path_.c_str(), "wb"));
    if (!file_)
      throw InputError("cannot create " + path_.string() + ": " + std::strerror(errno));
  }
  std::FILE* to = file_ ? file_.get() : stdout;
  if (std::fwrite(text_.data(), 1, text_.size(), to) != text_.size()
      || std::fflush(to) != 0)
    fail(errno);
  text_.clear();
}

void TextOutput::fail(int error) const {
  throw RunError(fmt::format("cannot write {}: {}",
                             path_.empty() ? "standard output" : path_.string(),
                             std::strerror(error)));
}

} // namespace ehdjet
