#include "command_tree.hpp"

#include "ehdjet/core/version.hpp"

#include <algorithm>
#include <cctype>
#include <fmt/format.h>
#include <iterator>
#include <string_view>
#include <utility>
#include <vector>

#include "commands.hpp"
#include "standard_streams.hpp"

namespace ehdjet::cli {
namespace {

using Options = std::vector<const CLI::Option*>;

/// Options of a command and of the groups in it (which are commands without a name).
Options options_of(const CLI::App& command) {
  Options all = command.get_options();
  for (const CLI::App* group : command.get_subcommands({}))
    if (group->get_name().empty())
      std::ranges::copy(options_of(*group), std::back_inserter(all));
  return all;
}

/// Commands with their full names, each before those within it: "bench", "bench table2".
using Commands = std::vector<std::pair<std::string, const CLI::App*>>;
void add_commands(const CLI::App& parent, const std::string& before, Commands& all) {
  for (const CLI::App* command : parent.get_subcommands({})) {
    if (command->get_name().empty()) continue;
    const std::string name = before + command->get_name();
    all.emplace_back(name, command);
    add_commands(*command, name + ' ', all);
  }
}
Commands commands_of(const CLI::App& app) {
  Commands all;
  add_commands(app, "", all);
  return all;
}

std::vector<std::string> flags_of(const CLI::Option& option) {
  std::vector<std::string> flags;
  for (const std::string& name : option.get_snames()) flags.push_back('-' + name);
  for (const std::string& name : option.get_lnames()) flags.push_back("--" + name);
  return flags;
}

std::string joined(const std::vector<std::string>& words, std::string_view between) {
  std::string text;
  for (const std::string& word : words)
    text += (text.empty() ? "" : std::string(between)) + word;
  return text;
}

/// What may follow a command: its options, and the names of the commands within it.
std::string words_after(const CLI::App& command) {
  std::vector<std::string> words;
  for (const CLI::App* inner : command.get_subcommands({}))
    if (!inner->get_name().empty()) words.push_back(inner->get_name());
  for (const CLI::Option* option : options_of(command))
    std::ranges::copy(flags_of(*option), std::back_inserter(words));
  return joined(words, " ");
}

/// Text that troff prints as it is.
std::string troff(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (out.empty() && (c == '.' || c == '\'')) out += "\\&"; // no request
    if (c == '\\')
      out += "\\e";
    else if (c == '-')
      out += "\\-";
    else if (c == '\n')
      out += ' ';
    else
      out += c;
  }
  return out;
}

std::string value_name(const CLI::Option& option) {
  return option.get_items_expected_max() == 0 ? "" : option.get_type_name();
}

std::string manual_entry(const CLI::Option& option) {
  std::string head;
  if (option.nonpositional()) {
    std::vector<std::string> flags;
    for (const std::string& flag : flags_of(option))
      flags.push_back("\\fB" + troff(flag) + "\\fR");
    head = joined(flags, ", ");
    if (const std::string value = value_name(option); !value.empty())
      head += " \\fI" + troff(value) + "\\fR";
  } else {
    head = "\\fI" + troff(option.get_name()) + "\\fR";
  }
  std::string text = option.get_description();
  if (!option.get_default_str().empty()) text += " [" + option.get_default_str() + ']';
  return fmt::format(".TP\n{}\n{}\n", head, troff(text));
}

/// "ehdjet run [options] SCENE"
std::string synopsis(const std::string& name, const CLI::App& command) {
  std::string line = fmt::format("\\fBehdjet {}\\fR [\\fIoptions\\fR]", troff(name));
  for (const CLI::Option* option : options_of(command))
    if (!option->nonpositional())
      line += fmt::format(" \\fI{}\\fR", troff(option->get_name()));
  return line;
}

} // namespace

std::string bash_completion(const CLI::App& app) {
  std::string text = fmt::format(
      "# Completion of ehdjet {} for bash, made by `ehdjet completion`. Try it with\n"
      "#   source <(ehdjet completion)\n"
      "_ehdjet() {{\n"
      "  local command='' word words\n"
      "  for word in \"${{COMP_WORDS[@]:1:COMP_CWORD-1}}\"; do\n"
      "    case \"$command $word\" in\n",
      version::number);
  for (const auto& [name, command] : commands_of(app))
    text += fmt::format("      \" {}\") command=\" {}\" ;;\n", name, name);
  text += "    esac\n  done\n  case $command in\n";
  for (const auto& [name, command] : commands_of(app))
    text += fmt::format("    \" {}\") words=\"{}\" ;;\n", name, words_after(*command));
  text += fmt::format("    *) words=\"{}\" ;;\n", words_after(app));
  text +=
      "  esac\n"
      "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"${COMP_WORDS[COMP_CWORD]}\")\n"
      "  # Without a dash a file may be meant.\n"
      "  if [[ -n $command && ${COMP_WORDS[COMP_CWORD]} != -* ]]; then\n"
      "    local inner=()\n"
      "    for word in \"${COMPREPLY[@]}\"; do [[ $word == -* ]] || inner+=(\"$word\"); "
      "done\n"
      "    COMPREPLY=(\"${inner[@]}\")\n"
      "  fi\n"
      "}\n"
      "complete -o default -F _ehdjet ehdjet\n";
  return text;
}

std::string manual_page(const CLI::App& app) {
  std::string text = fmt::format(".TH EHDJET 1 \"\" \"ehdjet {}\" \"User Commands\"\n"
                                 ".SH NAME\nehdjet \\- simulate electrospinning jets\n"
                                 ".SH SYNOPSIS\n",
                                 version::number);
  const Commands commands = commands_of(app);
  for (std::size_t i = 0; i < commands.size(); ++i)
    text +=
        (i == 0 ? "" : ".br\n") + synopsis(commands[i].first, *commands[i].second) + '\n';
  text += ".SH DESCRIPTION\n"
          "An electrically charged viscoelastic jet is a chain of beads from the nozzle to "
          "the fibre "
          "on the collector. A scene file (TOML, SI units) says what is simulated; a run "
          "file (HDF5) "
          "has the results.\n.SH OPTIONS\n";
  for (const CLI::Option* option : options_of(app)) text += manual_entry(*option);
  text += ".SH COMMANDS\n";
  for (const auto& [name, command] : commands) {
    text +=
        fmt::format(".SS ehdjet {}\n{}.\n", troff(name), troff(command->get_description()));
    for (const CLI::Option* option : options_of(*command)) text += manual_entry(*option);
  }
  text += ".SH EXIT STATUS\n"
          ".TP\n0\nSuccess.\n"
          ".TP\n1\nThe run failed. A message names the time, the bead and the force.\n"
          ".TP\n2\nThe input is wrong. A message names the file, the line, the key and the "
          "allowed "
          "range.\n"
          ".TP\n3\nA bug in ehdjet.\n"
          ".SH SEE ALSO\n.BR h5dump (1),\n.BR gnuplot (1),\n.BR paraview (1)\n";
  return text;
}

void add_command_tree_commands(CLI::App& app) {
  app.add_subcommand("completion", "Print the completion of commands and options for bash")
      ->callback([&app] { print_result("{}", bash_completion(app)); });
  app.add_subcommand("manual", "Print the manual page, for man")->callback([&app] {
    print_result("{}", manual_page(app));
  });
}

} // namespace ehdjet::cli
