#include "cli/command.hpp"

#include <cstdlib>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <sys/wait.h>
#include <unistd.h>

namespace ehdjet::test {

Folder::Folder() {
  std::string name = std::filesystem::temp_directory_path() / "ehdjet_cli_XXXXXX";
  if (!mkdtemp(name.data())) throw std::runtime_error("no temporary folder");
  path_ = name;
}

Folder::~Folder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

std::string Folder::file(const std::string& name, const std::string& text) const {
  std::ofstream(path_ / name) << text;
  return path_ / name;
}

Outcome command(const Folder& folder, const std::string& arguments,
                const std::string& before) {
  const std::string line = "cd '" + folder.path().string() + "' && " + before
                           + " '" EHDJET_COMMAND "' " + arguments
                           + " >stdout.txt 2>stderr.txt </dev/null";
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
