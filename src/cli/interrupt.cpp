#include "interrupt.hpp"

#include <algorithm>
#include <array>
#include <csignal>
#include <cstddef>

namespace ehdjet::cli {
namespace {

struct Signal {
  int number;
  const char* name;
};
constexpr std::array<Signal, 4> signals{
    {{SIGINT, "SIGINT"},
     {SIGTERM, "SIGTERM"},
     {SIGHUP, "SIGHUP"},     // the terminal has gone
     {SIGXCPU, "SIGXCPU"}}}; // a limit of computing time

volatile std::sig_atomic_t received = 0, wants_checkpoint = 0;

// A terminal that closes sends SIGHUP twice, and a limit of computing time a signal each second.
bool comes_again(int signal) {
  return signal == SIGHUP || signal == SIGXCPU;
}

extern "C" void note_signal(int signal) {
  received = signal;
  std::signal(signal, comes_again(signal) ? note_signal : SIG_DFL);
}

extern "C" void note_checkpoint(int /*signal*/) {
  wants_checkpoint = 1;
}

} // namespace

InterruptGuard::InterruptGuard() {
  received = 0;
  wants_checkpoint = 0;
  struct sigaction action {};
  action.sa_handler = note_checkpoint;
  action.sa_flags = SA_RESTART;
  ::sigaction(SIGUSR1, &action, nullptr);
  for (const Signal& s : signals) {
    const auto before = std::signal(s.number, note_signal);
    if (before == SIG_IGN && s.number == SIGHUP) std::signal(s.number, SIG_IGN); // nohup
  }
}

InterruptGuard::~InterruptGuard() {
  for (const Signal& s : signals)
    if (std::signal(s.number, SIG_DFL) == SIG_IGN) std::signal(s.number, SIG_IGN);
  std::signal(SIGUSR1, SIG_DFL);
}

bool InterruptGuard::checkpoint_wanted() {
  if (wants_checkpoint == 0) return false;
  wants_checkpoint = 0;
  return true;
}

const char* InterruptGuard::signal_name() {
  const int last = received;
  const auto* const found = std::ranges::find(signals, last, &Signal::number);
  return found == signals.end() ? nullptr : found->name;
}

} // namespace ehdjet::cli
