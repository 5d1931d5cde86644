#include <cstdio>
#include <cstdlib>

#include "support/mutant.hpp"

// mutate_run FILE NUMBER: makes the mutation of that number, for scripts/mutants.
int main(int argc, char** argv) {
  if (argc != 3) return 2;
  const auto made = ehdjet::test::mutate(argv[1], std::strtoull(argv[2], nullptr, 10));
  std::printf("%s%s\n", made.text.c_str(), made.with_checksums ? "with checksums" : "");
}
