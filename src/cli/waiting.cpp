#include <array>
#include <cstdlib>

#include "commands.hpp"

#ifdef __linux__
#include <unistd.h>
#endif

namespace ehdjet::cli {

// The OpenMP runtime of GCC lets idle threads spin for milliseconds before they sleep. Beside another
// busy process they then hold the processor that the thread needs for which they wait. A bounded time is as
// fast on a machine of one's own. The runtime reads the bound when it is loaded, which is before `main`.
void bound_waiting(char** argv) {
#if defined(__linux__) && defined(__GNUC__) && !defined(__clang__)
  constexpr const char* turns = "1000"; // some ten microseconds
  constexpr std::array settings{"OMP_WAIT_POLICY", "GOMP_SPINCOUNT"};
  for (const char* setting : settings)
    if (std::getenv(setting) != nullptr)
      return; // the user knows better, or this is the second start
  if (setenv(settings.back(), turns, 1) != 0) return;
  execv("/proc/self/exe", argv); // comes back only if it fails: then all goes on as before
#else
  (void)argv;
#endif
}

} // namespace ehdjet::cli
