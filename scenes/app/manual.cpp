// Manual pages and completions. Read first: described(), the facts about a command that all of them
// are made from.
#include "scenes/app/manual.h"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <vector>

#include "engine/io/bytes.h"
#include "scenes/app/build_info.h"

namespace sunder::app {
namespace {

/// An option or a positional argument of a command.
struct Argument {
  std::vector<std::string> names;  ///< "-o", "--output"; one name without dashes if positional.
  std::string value;               ///< Name of the value; empty for a flag.
  std::string range;               ///< Allowed numbers, as in "0 - 1024"; empty: any.
  std::string initial;             ///< Default; empty if there is none.
  std::string help;
  std::vector<std::string> choices;  ///< Words that the value may be or begin with.
  bool required = false;
  bool repeated = false;  ///< True if it may have several values.
};

struct Described {
  std::string name;  ///< With the names of the commands above, as in "golden test".
  std::string help;
  std::vector<Argument> positionals, options;
  std::vector<Described> commands;
};

/// Returns a choice without the part that the user has to fill in: "follow:NAME" as "follow:".
std::string fixed_part(const std::string& choice) {
  const std::size_t colon = choice.find(':');
  if (const std::size_t end = choice.find('['); end < colon) return choice.substr(0, end);
  return colon == std::string::npos ? choice : choice.substr(0, colon + 1);
}

/// Returns the words of "text: one | two | three, text" or of "{one,two}".
std::vector<std::string> choices_in(const std::string& text, const std::string& type) {
  std::vector<std::string> found;
  if (const std::size_t open = type.find('{'); open != std::string::npos) {
    std::string word;
    for (const char c : type.substr(open + 1)) {
      if (c != ',' && c != '}') {
        word += c;
      } else {
        found.push_back(word);
        word.clear();
      }
    }
    return found;
  }
  const std::string bar = " | ";
  std::size_t at = text.find(bar);
  if (at == std::string::npos) return {};
  std::size_t begin = text.rfind(' ', at - 1);
  begin = begin == std::string::npos ? 0 : begin + 1;
  while (begin < text.size()) {
    const std::size_t end =
        std::min({text.find_first_of(" ;", begin), text.find(", ", begin), text.size()});
    const std::string word = text.substr(begin, end - begin);
    if (word.find_first_of(".<>") == std::string::npos) found.push_back(fixed_part(word));
    if (text.compare(end, bar.size(), bar) != 0) break;
    begin = end + bar.size();
  }
  return found;
}

Argument described(const CLI::Option& option) {
  Argument argument;
  if (option.get_positional()) {
    argument.names = {option.get_name(true)};
  } else {
    for (const std::string& name : option.get_snames()) argument.names.push_back("-" + name);
    for (const std::string& name : option.get_lnames()) argument.names.push_back("--" + name);
  }
  const std::string type = option.get_type_name();
  const bool has_value = option.get_items_expected_max() > 0;
  const std::size_t colon = type.find(':');
  // "A:B" is the name of a value, "INT:0 - 9" a name and a range.
  const bool has_range = colon != std::string::npos && type.find(" - ", colon) != std::string::npos;
  if (has_value) argument.value = has_range ? type.substr(0, colon) : type;
  if (const std::size_t open = argument.value.find(":{"); open != std::string::npos)
    argument.value.resize(open);
  if (has_range) argument.range = type.substr(colon + 1);
  if (has_value && !option.get_default_str().starts_with("/"))  // a folder of this machine
    argument.initial = option.get_default_str();
  argument.help = option.get_description();
  argument.choices = choices_in(argument.help, type);
  argument.required = option.get_required();
  argument.repeated = option.get_expected_max() > 1;
  return argument;
}

Described described(const CLI::App& app, const std::string& name) {
  Described command{name, app.get_description(), {}, {}, {}};
  for (const CLI::Option* option : app.get_options()) {
    (option->get_positional() ? command.positionals : command.options)
        .push_back(described(*option));
  }
  for (const CLI::App* inner : app.get_subcommands([](const CLI::App*) { return true; })) {
    if (inner->get_group().empty()) continue;
    const std::string full = (name.empty() ? "" : name + " ") + inner->get_name();
    command.commands.push_back(described(*inner, full));
  }
  return command;
}

/// Returns the text with each `from` replaced.
std::string replaced(std::string text, std::string_view from, std::string_view to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

std::string joined(const std::vector<std::string>& words, const std::string& separator) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : separator) + word;
  return text;
}

std::string last_word(const std::string& text) { return text.substr(text.rfind(' ') + 1); }

// Manual pages.

/// Returns a text that roff prints unchanged.
std::string roff(const std::string& text) {
  std::string safe = replaced(replaced(text, "\\", "\\e"), "-", "\\-");
  if (safe.starts_with(".") || safe.starts_with("'")) safe.insert(0, "\\&");
  return safe;
}

std::string lowered(std::string text) {
  if (text.size() > 1 && std::islower(static_cast<unsigned char>(text[1])) != 0)
    text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

std::string entry(const Argument& argument) {
  std::vector<std::string> names;
  for (const std::string& name : argument.names) names.push_back("\\fB" + roff(name) + "\\fR");
  std::string text = ".TP\n" + joined(names, ", ");
  if (!argument.value.empty() && argument.names[0].starts_with("-"))
    text += " \\fI" + roff(argument.value) + "\\fR";
  text += "\n" + roff(argument.help) + ".\n";
  if (argument.required) text += "Required.\n";
  if (!argument.range.empty())
    text += "From " + roff(replaced(argument.range, " - ", " to ")) + ".\n";
  if (!argument.initial.empty() && argument.initial != "[]")
    text += "Default: " + roff(argument.initial) + ".\n";
  return text;
}

std::string synopsis(const Described& command) {
  std::string text = ".B " + roff("sunder " + command.name) + "\n";
  std::string words = "[\\fIOPTIONS\\fR]";
  for (const Argument& each : command.positionals) {
    const std::string name = "\\fI" + roff(each.names[0]) + "\\fR" + (each.repeated ? "..." : "");
    words += each.required ? " " + name : " [" + name + "]";
  }
  return text + words + "\n";
}

std::string entries(const Described& command) {
  std::string text;
  for (const Argument& each : command.positionals) text += entry(each);
  for (const Argument& each : command.options) text += entry(each);
  return text;
}

std::string head(const std::string& page, const std::string& help) {
  std::string upper = page;
  std::ranges::transform(upper, upper.begin(), [](unsigned char c) { return std::toupper(c); });
  return ".TH " + roff(upper) + " 1 \"\" \"sunder " + build_info().version +
         "\" \"User Commands\"\n.SH NAME\n" + roff(page) + " \\- " + roff(lowered(help)) + "\n";
}

constexpr const char* kExitStatus =
    ".SH EXIT STATUS\n"
    ".TP\n.B 0\nThe command did what was asked.\n"
    ".TP\n.B 1\nA comparison failed, or a file could not be written.\n"
    ".TP\n.B 2\nThe input was wrong: an option, a scene, a mesh or a recording.\n"
    ".TP\n.B 128 + signal\nThe run was stopped by a signal; results up to there were written.\n";

std::string command_page(const Described& command) {
  std::string text = head("sunder-" + command.name, command.help) + ".SH SYNOPSIS\n";
  const std::vector<Described> alone = {command};
  for (const Described& each : command.commands.empty() ? alone : command.commands)
    text += (&each == &command.commands.front() || command.commands.empty() ? "" : ".br\n") +
            synopsis(each);
  if (command.commands.empty()) text += ".SH OPTIONS\n" + entries(command);
  for (const Described& each : command.commands) {
    std::string title = last_word(each.name);
    std::ranges::transform(title, title.begin(), [](unsigned char c) { return std::toupper(c); });
    text += ".SH " + roff(title) + "\n" + roff(each.help) + ".\n" + entries(each);
  }
  return text + kExitStatus + ".SH SEE ALSO\n.BR sunder (1)\n";
}

std::string program_page(const Described& program) {
  std::string text =
      head("sunder", "simulate and render destruction") +
      ".SH SYNOPSIS\n.B sunder\n\\fICOMMAND\\fR [\\fIOPTIONS\\fR]\n"
      ".SH DESCRIPTION\n"
      "Sunder simulates rigid bodies that break, and draws them.\n"
      "A scene is a TOML file, or the name of a scene that\n.B sunder list\nprints.\n"
      ".SH COMMANDS\n";
  for (const Described& command : program.commands)
    text += ".TP\n.BR " + roff("sunder-" + command.name) + " (1)\n" + roff(command.help) + ".\n";
  text += ".SH OPTIONS\n" + entries(program) + kExitStatus;
  text +=
      ".SH ENVIRONMENT\n.TP\n.B SUNDER_CACHE\nFolder of decomposed meshes.\nDefault: sunder/ in "
      "$XDG_CACHE_HOME or in ~/.cache.\n"
      ".SH EXAMPLES\n.TP\n.B sunder render house \\-o house.mp4\nMake a video of a house that is "
      "shot to rubble.\n.TP\n.B sunder doctor\nReport what is missing on this machine.\n";
  return text;
}

// Completions.

/// Returns a word for the shell, in single quotes.
std::string quoted_word(const std::string& text) {
  return "'" + replaced(text, "'", "'\\''") + "'";
}

std::vector<std::string> option_names(const Described& command) {
  std::vector<std::string> names;
  for (const Argument& option : command.options)
    names.insert(names.end(), option.names.begin(), option.names.end());
  return names;
}

std::vector<std::string> command_names(const Described& command) {
  std::vector<std::string> names;
  for (const Described& each : command.commands) names.push_back(last_word(each.name));
  return names;
}

bool takes_scene(const Described& command) {
  return std::ranges::any_of(command.positionals,
                             [](const Argument& each) { return each.names[0] == "SCENE"; });
}

/// Appends the cases of a command and of those in it to the lists of bash.
void add_bash(const Described& command, std::string& values, std::string& words) {
  for (const Argument& option : command.options) {
    if (option.choices.empty()) continue;
    std::vector<std::string> patterns;
    for (const std::string& name : option.names)
      patterns.push_back(quoted_word(command.name + " " + name));
    values += "    " + joined(patterns, " | ") +
              ") words=" + quoted_word(joined(option.choices, " ")) + " ;;\n";
  }
  if (command.commands.empty()) {
    words += "    " + quoted_word(command.name) +
             ") words=" + quoted_word(joined(option_names(command), " ")) +
             (takes_scene(command) ? "; scene=yes" : "") + " ;;\n";
  }
  for (const Described& each : command.commands) add_bash(each, values, words);
}

std::string bash_completion(const Described& program) {
  std::string values, words, groups;
  for (const Described& command : program.commands) {
    add_bash(command, values, words);
    if (!command.commands.empty())
      groups += "    " + quoted_word(command.name) +
                ") words=" + quoted_word(joined(command_names(command), " ")) + " ;;\n";
  }
  const std::string names =
      joined(command_names(program), " ") + " " + joined(option_names(program), " ");
  return "# Completion of sunder for bash, made from the options of the program.\n"
         "# shellcheck shell=bash\n"
         "_sunder() {\n"
         "  local current=${COMP_WORDS[COMP_CWORD]} previous=${COMP_WORDS[COMP_CWORD - 1]}\n"
         "  local command=${COMP_WORDS[1]} words='' group='' scene=no files=no\n"
         "  case $command in\n" +
         replaced(groups, "words=", "group=") +
         "  esac\n"
         "  if ((COMP_CWORD == 1)); then\n"
         "    words=" +
         quoted_word(names) +
         "\n"
         "  elif [[ -n $group ]] && ((COMP_CWORD == 2)); then\n"
         "    words=$group\n"
         "  else\n"
         "    if [[ -n $group ]]; then command=\"$command ${COMP_WORDS[2]}\"; fi\n"
         "    case \"$command $previous\" in\n" +
         replaced(values, "    '", "      '") +
         "    esac\n"
         "    if [[ -z $words ]]; then\n"
         "      case $command in\n" +
         replaced(words, "    '", "        '") +
         "      esac\n"
         "      if [[ $current != -* ]]; then\n"
         "        words='' files=yes\n"
         "        if [[ $scene == yes && $previous != -* ]]; then\n"
         "          words=$(sunder list --quiet 2>/dev/null)\n"
         "        fi\n"
         "      fi\n"
         "    fi\n"
         "  fi\n"
         "  mapfile -t COMPREPLY < <(compgen -W \"$words\" -- \"$current\")\n"
         "  if [[ $files == yes ]]; then\n"
         "    mapfile -t -O \"${#COMPREPLY[@]}\" COMPREPLY < <(compgen -f -- \"$current\")\n"
         "  fi\n"
         "}\n"
         "complete -o filenames -F _sunder sunder\n";
}

/// Returns a text for the part between brackets of an argument of zsh's _arguments.
std::string zsh_text(const std::string& text) {
  return replaced(replaced(replaced(replaced(text, "\\", "\\\\"), "[", "\\["), "]", "\\]"), ":",
                  "\\:");
}

/// Returns the words of _arguments for an option, one for each of its names.
std::string zsh_option(const Argument& option) {
  std::string text;
  for (const std::string& name : option.names) {
    std::string word = (option.repeated ? "*" : "") + name + "[" + zsh_text(option.help) + "]";
    if (!option.value.empty()) {
      word += ":" + zsh_text(option.value) + ":";
      if (option.choices.empty()) {
        word += "_files";
      } else {
        std::vector<std::string> choices;
        for (const std::string& choice : option.choices) choices.push_back(zsh_text(choice));
        word += "(" + joined(choices, " ") + ")";
      }
    }
    text += " \\\n        " + quoted_word(word);
  }
  return text;
}

std::string zsh_arguments(const Described& command) {
  std::string text = "      _arguments";
  for (const Argument& option : command.options) text += zsh_option(option);
  for (const Argument& each : command.positionals) {
    const bool scene = each.names[0] == "SCENE";
    text += " \\\n        " + quoted_word(std::string(each.repeated ? "*:" : ":") + each.names[0] +
                                          (scene ? ":_sunder_scenes" : ":_files"));
  }
  return text + "\n";
}

std::string zsh_commands(const std::vector<Described>& commands) {
  std::string text;
  for (const Described& each : commands)
    text += " \\\n      " + quoted_word(last_word(each.name) + ":" + each.help);
  return text;
}

std::string zsh_completion(const Described& program) {
  std::string text =
      "#compdef sunder\n"
      "# Completion of sunder for zsh, made from the options of the program.\n\n"
      "_sunder_scenes() {\n"
      "  local -a scenes\n"
      "  scenes=(${(f)\"$(sunder list --quiet 2>/dev/null)\"})\n"
      "  _alternative 'scenes:scene:compadd -a scenes' 'files:file:_files'\n"
      "}\n\n"
      "_sunder() {\n"
      "  local -a commands\n"
      "  if (( CURRENT == 2 )); then\n"
      "    commands=(" +
      zsh_commands(program.commands) +
      ")\n"
      "    _describe command commands\n"
      "    _arguments";
  for (const Argument& option : program.options) text += zsh_option(option);
  text += "\n    return\n  fi\n  local command=$words[2]\n  shift words\n  (( CURRENT-- ))\n";
  std::string cases;
  for (const Described& command : program.commands) {
    for (const Described& each : command.commands)
      cases += "    " + quoted_word(each.name) + ")\n" + zsh_arguments(each) + "      ;;\n";
    if (command.commands.empty()) {
      cases += "    " + quoted_word(command.name) + ")\n" + zsh_arguments(command) + "      ;;\n";
      continue;
    }
    text += "  if [[ $command == " + command.name +
            " ]]; then\n    if (( CURRENT == 2 )); then\n"
            "    commands=(" +
            zsh_commands(command.commands) +
            ")\n"
            "    _describe command commands\n    return\n    fi\n"
            "    command=\"$command $words[2]\"\n    shift words\n    (( CURRENT-- ))\n  fi\n";
  }
  return text + "  case $command in\n" + cases + "  esac\n}\n\n_sunder \"$@\"\n";
}

}  // namespace

std::map<std::string, std::string> manual_files(const CLI::App& program) {
  const Described all = described(program, "");
  std::map<std::string, std::string> files = {{"man1/sunder.1", program_page(all)},
                                              {"bash/sunder", bash_completion(all)},
                                              {"zsh/_sunder", zsh_completion(all)}};
  for (const Described& command : all.commands)
    files["man1/sunder-" + command.name + ".1"] = command_page(command);
  return files;
}

int write_manual(const std::filesystem::path& folder,
                 const std::map<std::string, std::string>& files) {
  for (const auto& [name, text] : files) write_file(folder / name, text);
  return 0;
}

}  // namespace sunder::app
