// Parses the command line of the program.
#pragma once

#include <functional>

namespace sunder::app {

/// Returns the command of a command line; calling it returns the program's exit code. For help and
/// wrong use, prints the text here and returns a command that only returns 0 or 2. Throws
/// InputError for unknown words.
std::function<int()> parse_command_line(int argc, char** argv);

}  // namespace sunder::app
