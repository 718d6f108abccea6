// Manual pages and shell completions, made from the declared options of the commands.
#pragma once

#include <filesystem>
#include <map>
#include <string>

#include <CLI/CLI.hpp>

namespace sunder::app {

/// Returns the texts of the manual pages (man1/sunder.1, and man1/sunder-COMMAND.1 for each
/// command) and of the completions for bash (bash/sunder) and zsh (zsh/_sunder), by the path below
/// a folder. Commands without a group are left out, as in the help.
std::map<std::string, std::string> manual_files(const CLI::App& program);
/// Writes such files to a folder. Returns the exit code 0. Throws FileError.
int write_manual(const std::filesystem::path& folder,
                 const std::map<std::string, std::string>& files);

}  // namespace sunder::app
