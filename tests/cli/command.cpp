#include "cli/command.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <sys/wait.h>

namespace ehdjet::test {

Outcome command(const Folder& folder, const std::string& arguments,
                const std::string& before) {
  const std::string line = "cd '" + folder.path().string() + "' && " + before
                           + " '" EHDJET_COMMAND "' </dev/null " + arguments
                           + " >stdout.txt 2>stderr.txt";
  const int status =
      std::system(line.c_str()); // NOLINT(cert-env33-c): the shell is the user
  Outcome o;
  o.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  o.out = text_of(folder / "stdout.txt"), o.err = text_of(folder / "stderr.txt");
  return o;
}

std::string text_of(const std::filesystem::path& file) {
  std::ifstream in(file);
  return {std::istreambuf_iterator<char>(in), {}};
}

} // namespace ehdjet::test
