#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace ehdjet {

/// Anything that ends a command with a message for the user. The exit code is part of the
/// type: 1 the run failed, 2 the input is wrong, 3 a bug in ehdjet.
class Error : public std::runtime_error {
public:
  explicit Error(const std::string& message, int exit_code = 1)
      : std::runtime_error(message)
      , exit_code_(exit_code) {}
  [[nodiscard]] int exit_code() const { return exit_code_; }

private:
  int exit_code_;
};

/// The user's input is wrong: scene, command line or data file. Raised before anything runs.
/// The message names file, line, key, value, unit and the allowed range, as far as they apply.
class InputError : public Error {
public:
  explicit InputError(const std::string& message)
      : Error(message, 2) {}
};

/// The run failed: NaN, step size collapse, disk full, interruption. The message says at
/// what time, bead and force term.
class RunError : public Error {
public:
  explicit RunError(const std::string& message)
      : Error(message, 1) {}
};

/// A broken precondition: a bug in ehdjet or in the program that calls it.
class ContractViolation : public Error {
public:
  explicit ContractViolation(const std::string& message)
      : Error(message, 3) {}
};

[[noreturn]] void contract_failed(const char* kind, const char* condition, const char* file,
                                  int line);

} // namespace ehdjet

/// Preconditions of public functions. Every build checks them; none is inside a loop over beads.
#define EHDJET_EXPECTS(ok)                                                                 \
  ((ok) ? void(0) : ::ehdjet::contract_failed("precondition", #ok, __FILE__, __LINE__))
