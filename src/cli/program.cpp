#include "program.hpp"

#include "ehdjet/core/error.hpp"

#include <cerrno>
#include <cstring>
#include <fcntl.h>
#include <spawn.h>
#include <string_view>
#include <sys/wait.h>

namespace ehdjet::cli {

Pipe make_pipe() {
  int ends[2] = {-1, -1};
  if (::pipe2(ends, O_CLOEXEC) != 0)
    throw RunError(std::string("cannot make a pipe: ") + std::strerror(errno));
  return {Descriptor(ends[0]), Descriptor(ends[1])};
}

Program::Program(std::vector<std::string> arguments, const std::string& hint, int input,
                 int output, int errors)
    : name_(arguments[0]) {
  std::vector<std::string> environment{"LC_ALL=C.UTF-8"};
  for (char** entry = environ; *entry != nullptr; ++entry)
    if (!std::string_view(*entry).starts_with("LC_ALL=")) environment.emplace_back(*entry);
  const auto pointers = [](std::vector<std::string>& texts) {
    std::vector<char*> list;
    for (std::string& text : texts) list.push_back(text.data());
    list.push_back(nullptr);
    return list;
  };
  posix_spawn_file_actions_t actions;
  ::posix_spawn_file_actions_init(&actions);
  ::posix_spawn_file_actions_adddup2(&actions, input, STDIN_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, output, STDOUT_FILENO);
  ::posix_spawn_file_actions_adddup2(&actions, errors, STDERR_FILENO);
  const int error =
      ::posix_spawnp(&process_, name_.c_str(), &actions, nullptr,
                     pointers(arguments).data(), pointers(environment).data());
  ::posix_spawn_file_actions_destroy(&actions);
  if (error == ENOENT) throw RunError(name_ + " not found: " + hint);
  if (error != 0) throw RunError("cannot start " + name_ + ": " + std::strerror(error));
}

void Program::wait() {
  while (process_ > 0 && ::waitpid(process_, &status_, 0) < 0 && errno == EINTR) {
  }
  process_ = 0;
}

void Program::finish() {
  wait();
  if (!WIFEXITED(status_) || WEXITSTATUS(status_) != 0)
    throw RunError(name_ + " failed; its message is above");
}

} // namespace ehdjet::cli
