#include "scenes/app/subcommand.h"

#include <algorithm>
#include <string_view>

#include "engine/base/check.h"
#include "scenes/file/keys.h"

namespace sunder::app {
namespace {

std::string unknown(const std::string& what, const std::string& word,
                    const std::vector<std::string>& names) {
  const std::vector<std::string_view> known(names.begin(), names.end());
  return what + scenes::did_you_mean(word, known);
}

void check_options(const CLI::App& command, std::span<char*> words, const std::string& of) {
  std::vector<std::string> names;
  for (const CLI::Option* option : command.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  for (const std::string_view given : words) {
    if (given == "--") return;
    const std::string word(given.substr(0, given.find('=')));
    if (!word.starts_with("--") || std::ranges::find(names, word) != names.end()) continue;
    throw InputError(unknown("unknown option '" + word + "'", word, names) + "; see " + of +
                     "--help");
  }
}

}  // namespace

void check_words(const CLI::App& program, std::span<char*> words, const std::string& of) {
  const auto commands = program.get_subcommands([](const CLI::App*) { return true; });
  if (commands.empty()) return check_options(program, words, of);
  const std::string word = words.empty() ? "" : words[0];
  if (word.starts_with("-")) return;
  std::vector<std::string> names;
  for (const CLI::App* command : commands) names.push_back(command->get_name());
  const auto found = std::ranges::find(names, word);
  if (found != names.end()) {
    const CLI::App& command = *commands[static_cast<std::size_t>(found - names.begin())];
    return check_words(command, words.subspan(1), of + word + " ");
  }
  const std::string wrong = word.empty() ? of + "is incomplete: a command is missing"
                                         : "unknown command '" + of + word + "'";
  const std::vector<std::string_view> known(names.begin(), names.end());
  throw InputError(unknown(wrong, word, names) + "; commands: " + scenes::join(known));
}

}  // namespace sunder::app
