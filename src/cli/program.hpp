#pragma once

#include <string>
#include <sys/types.h>
#include <unistd.h>
#include <utility>
#include <vector>

/// Other programs, started without a shell.
namespace ehdjet::cli {

/// A file descriptor with one owner.
class Descriptor {
public:
  explicit Descriptor(int number)
      : number_(number) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept
      : number_(std::exchange(other.number_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int get() const { return number_; }
  void close() {
    if (number_ >= 0) ::close(number_);
    number_ = -1;
  }

private:
  int number_;
};

struct Pipe {
  Descriptor out, in;
};

/// errors : RunError
Pipe make_pipe();

/// Another program, which reads from `input` and writes to `output` and `errors`, in the same language everywhere.
class Program {
public:
  /// `hint`: what to do if it is not there. errors : RunError if it cannot be started
  Program(std::vector<std::string> arguments, const std::string& hint, int input,
          int output, int errors = STDERR_FILENO);
  ~Program() { wait(); }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  void wait();
  /// Waits for its end. errors : RunError if it failed
  void finish();

private:
  std::string name_;
  pid_t process_ = 0;
  int status_ = 0;
};

} // namespace ehdjet::cli
