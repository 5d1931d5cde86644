#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <gmock/gmock.h>
#include <pty.h>
#include <string>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "cli/command.hpp"

namespace {

using namespace ehdjet::test;
using testing::HasSubstr;
using testing::Not;

/// What a run of less than a second writes to a terminal of so many columns, the last ones after a change of size.
std::string on_terminal(const Folder& folder, const std::vector<unsigned short>& columns,
                        const char* kind = "xterm") {
  winsize size{.ws_row = 24, .ws_col = columns.front(), .ws_xpixel = 0, .ws_ypixel = 0};
  int terminal = -1;
  const pid_t child = ::forkpty(&terminal, nullptr, nullptr, &size);
  if (child == 0) {
    ::setenv("TERM", kind, 1);
    if (::chdir(folder.path().c_str()) == 0)
      ::execl(EHDJET_COMMAND, EHDJET_COMMAND, "run", EHDJET_SCENES "/pvp.toml", "--force",
              "-o", "jet.h5", "--set", "run.max_wall_time=0.8", nullptr);
    ::_exit(127);
  }
  std::string text;
  std::array<char, 4096> part{};
  for (ssize_t n = 0; (n = ::read(terminal, part.data(), part.size())) > 0;) {
    text.append(part.data(), static_cast<std::size_t>(n));
    size.ws_col = columns.back();
    if (text.find(" left") != std::string::npos) ::ioctl(terminal, TIOCSWINSZ, &size);
  }
  ::close(terminal);
  int status = 0;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(WEXITSTATUS(status), 1) << text; // stopped by run.max_wall_time
  return text;
}

/// The progress lines: what stands between the start of a line and the control that clears the rest.
std::vector<std::string> lines_of(const std::string& text) {
  const std::string clear = "\x1b[J";
  std::vector<std::string> lines;
  for (std::size_t end = text.find(clear); end != std::string::npos;
       end = text.find(clear, end + 1)) {
    const std::size_t begin = text.rfind('\r', end);
    lines.push_back(text.substr(begin + 1, end - begin - 1));
  }
  return lines;
}

TEST(Progress, is_one_line_that_fits_into_a_terminal_of_any_width) {
  const Folder folder;
  for (const unsigned short columns : std::vector<unsigned short>{12, 40, 80, 200}) {
    const auto lines = lines_of(on_terminal(folder, {columns}));
    ASSERT_GT(lines.size(), 1U) << columns;
    EXPECT_THAT(lines.front(), HasSubstr(" %"));
    for (const std::string& line : lines) {
      EXPECT_LT(line.size(), columns);
      EXPECT_THAT(line, Not(HasSubstr("\n")));
    }
  }
}

TEST(Progress, becomes_shorter_when_the_terminal_does) {
  const Folder folder;
  const auto lines = lines_of(on_terminal(folder, {120, 30}));
  ASSERT_GT(lines.size(), 2U);
  EXPECT_GT(lines.front().size(), 60U);
  EXPECT_LT(lines[lines.size() - 2].size(), 30U); // the last one is empty
}

TEST(Progress, sends_no_controls_to_a_terminal_that_knows_none) {
  const Folder folder;
  EXPECT_THAT(on_terminal(folder, {80}, "dumb"), Not(HasSubstr("\x1b")));
}

} // namespace
