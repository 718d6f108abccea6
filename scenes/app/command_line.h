// Parses the command line of the program.
#pragma once

#include <functional>

namespace sunder::app {

/// Returns the command of a command line; calling it returns the program's exit code. Prints help
/// and errors of use, and then the command only returns 0 or 2. Throws InputError for unknown
/// words.
std::function<int()> parse_command_line(int argc, char** argv);

}  // namespace sunder::app
