#include <gtest/gtest.h>

#include <gmock/gmock.h>
#include <regex>
#include <set>
#include <sstream>
#include <string>

#include "cli/command.hpp"

namespace {

using namespace ehdjet::test;
using testing::AllOf;
using testing::Contains;
using testing::HasSubstr;
using testing::IsSupersetOf;
using testing::Not;

std::set<std::string> words(const std::string& text) {
  std::istringstream in(text);
  std::set<std::string> all;
  for (std::string word; in >> word;) all.insert(word);
  return all;
}

/// What bash offers for a line whose last word is being typed.
std::set<std::string> offered(const Folder& folder, const std::string& line) {
  const auto script =
      folder.file("complete.sh", "source completion.bash\nCOMP_WORDS=(" + line
                                     + ")\n[[ $1 == new ]] && COMP_WORDS+=(\"\")\n"
                                       "COMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_ehdjet\n"
                                       "echo \"${COMPREPLY[@]}\"\n");
  const std::string call = "completion >completion.bash && bash " + script
                           + (line.ends_with(' ') ? " new" : " typed");
  const Outcome o = command(folder, call);
  EXPECT_EQ(o.exit_code, 0) << o.err;
  EXPECT_EQ(o.err, "");
  return words(o.out);
}

/// Every --option in a help text, and every command in that of the program.
std::set<std::string> found(const std::string& help, const char* pattern) {
  const std::regex expression(pattern);
  std::set<std::string> all;
  for (std::sregex_iterator i(help.begin(), help.end(), expression), end; i != end; ++i)
    all.insert((*i)[1]);
  return all;
}

std::set<std::string> commands(const Folder& folder) {
  const std::string help = command(folder, "--help").out;
  return found(help.substr(help.find("Subcommands:")), "\n  ([a-z]+) ");
}

TEST(Completion, offers_every_command_and_every_option_that_help_names) {
  const Folder folder;
  const auto all = commands(folder);
  EXPECT_GT(all.size(), 7u);
  EXPECT_THAT(offered(folder, "ehdjet "), IsSupersetOf(all));
  for (const std::string& name : all) {
    const std::string help = command(folder, name + " --help").out;
    EXPECT_THAT(offered(folder, "ehdjet " + name + " -"),
                IsSupersetOf(found(help, "\n  (?:-[a-z],)?(--[a-z-]+)")))
        << name;
  }
  EXPECT_THAT(offered(folder, "ehdjet bench table2 --"), Contains("--rtol"));
}

TEST(Completion, offers_what_begins_like_the_word_and_leaves_files_to_bash) {
  const Folder folder;
  EXPECT_EQ(offered(folder, "ehdjet ga"), (std::set<std::string>{"gather"}));
  EXPECT_EQ(offered(folder, "ehdjet run x.toml --cont"),
            (std::set<std::string>{"--continue"}));
  EXPECT_EQ(offered(folder, "ehdjet run "), std::set<std::string>{});
  EXPECT_EQ(offered(folder, "ehdjet bench "), (std::set<std::string>{"table2"}));
}

TEST(Manual, has_every_command_and_option_that_help_names) {
  const Folder folder;
  std::string page = command(folder, "manual").out;
  EXPECT_THAT(page, AllOf(HasSubstr(".TH EHDJET 1"), HasSubstr(".SH EXIT STATUS")));
  for (auto at = page.find("\\-"); at != std::string::npos; at = page.find("\\-"))
    page.erase(at, 1);
  const auto all = commands(folder);
  EXPECT_THAT(all, Contains("run"));
  for (const std::string& name : all) {
    const auto begin = page.find(".SS ehdjet " + name + "\n");
    ASSERT_NE(begin, std::string::npos) << name;
    const std::string section = page.substr(begin, page.find("\n.SS ", begin + 1) - begin);
    for (const auto& option :
         found(command(folder, name + " --help").out, "\n  (?:-[a-z],)?(--[a-z-]+)"))
      EXPECT_THAT(section, HasSubstr("\\fB" + option + "\\fR")) << name;
  }
}

} // namespace
