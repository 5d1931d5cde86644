#include <array>
#include <cstdlib>

#include "commands.hpp"

#ifdef __linux__
#include <unistd.h>
#endif

#ifdef __GNUC__
extern "C" [[gnu::weak]] void kmp_set_blocktime(int milliseconds); // LLVM's runtime has it
#endif

namespace ehdjet::cli {

// The OpenMP runtimes of GCC and LLVM let idle threads spin for milliseconds before they sleep. Beside
// another busy process they then hold the processor that the thread needs for which they wait. A
// spin of some ten microseconds is as fast on a machine of one's own. GCC's runtime reads its bound
// when it is loaded, which is before `main`. LLVM's has no bound below a millisecond except 0.
void bound_waiting(char** argv) {
#if defined(__linux__) && defined(__GNUC__)
  constexpr std::array settings{"OMP_WAIT_POLICY", "KMP_BLOCKTIME", "GOMP_SPINCOUNT"};
  for (const char* setting : settings)
    if (std::getenv(setting) != nullptr)
      return; // the user knows better, or this is the second start
  if (kmp_set_blocktime != nullptr) {
    kmp_set_blocktime(0);
    return;
  }
  constexpr const char* turns = "1000"; // some ten microseconds
  if (setenv(settings.back(), turns, 1) != 0) return;
  execv("/proc/self/exe", argv); // comes back only if it fails: then all goes on as before
#else
  (void)argv;
#endif
}

} // namespace ehdjet::cli
