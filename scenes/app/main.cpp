// The program `sunder`. Read first: commands.h, then one file a command; run.cpp is what a run is
// made of.
#include <cstdio>

#include "engine/base/check.h"
#include "scenes/app/command_line.h"

int main(int argc, char** argv) {
  try {
    return sunder::app::parse_command_line(argc, argv)();
  } catch (const sunder::InputError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failed: %s\n", error.what());
    return 1;
  }
}
