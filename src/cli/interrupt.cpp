#include "interrupt.hpp"

#include <csignal>

namespace ehdjet::cli {
namespace {

volatile std::sig_atomic_t received = 0;

extern "C" void note_signal(int signal) {
  received = signal;
  std::signal(signal, SIG_DFL);
}

} // namespace

InterruptGuard::InterruptGuard() {
  received = 0;
  std::signal(SIGINT, note_signal);
  std::signal(SIGTERM, note_signal);
}

InterruptGuard::~InterruptGuard() {
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

const char* InterruptGuard::signal_name() {
  if (received == SIGINT) return "SIGINT";
  if (received == SIGTERM) return "SIGTERM";
  return nullptr;
}

} // namespace ehdjet::cli
