// Commands of a benchmark program that has several.
#pragma once

#include <cstdio>
#include <initializer_list>
#include <string>

#include "tests/fixtures/flags.h"

namespace sunder::bench {

/// A command: its name, what it prints, and its main function.
struct Command {
  const char* name;
  const char* prints;
  int (*run)(int argc, char** argv);
};

/// Runs the command that the first argument names. The command's argv[0] is the program and the
/// command; its arguments follow. If there is no such command, prints all and returns kUsageError.
inline int run_command(int argc, char** argv, std::initializer_list<Command> commands) {
  for (const Command& command : commands) {
    if (argc < 2 || argv[1] != std::string(command.name)) continue;
    std::string name = std::string(argv[0]) + " " + command.name;
    argv[1] = name.data();
    return command.run(argc - 1, argv + 1);
  }
  std::fprintf(stderr, "usage: %s COMMAND [OPTIONS]\n", argv[0]);
  for (const Command& command : commands)
    std::fprintf(stderr, "  %-14s %s\n", command.name, command.prints);
  return kUsageError;
}

}  // namespace sunder::bench
