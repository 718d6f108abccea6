// From the words of a command line to a command.
#pragma once

#include <functional>

namespace sunder::app {

/// What to do; answers the program's exit code. Help and wrong use are printed here and become
/// commands that do nothing but answer 0 and 2.
std::function<int()> parse_command_line(int argc, char** argv);

}  // namespace sunder::app
