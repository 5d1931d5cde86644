#include "ehdjet/io/text_output.hpp"

#include "ehdjet/core/error.hpp"

#include <cerrno>
#include <cstring>

namespace ehdjet {

TextOutput::TextOutput(const std::filesystem::path& path, bool overwrite,
                       const std::filesystem::path& input)
    : path_(path) {
  if (!input.empty()) refuse_input(path, input);
  target_.emplace(path, overwrite);
}

void TextOutput::complete() {
  drain();
  text_ = fmt::memory_buffer(); // many that wait for each other must not keep their memory
  if (std::FILE* file = file_.release(); file != nullptr && std::fclose(file) != 0)
    fail(errno);
}

void TextOutput::publish() {
  if (target_) target_->publish();
}

void TextOutput::drain() {
  if (!file_ && target_) {
    file_.reset(std::fopen(target_->create().c_str(), "wb"));
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
