// The program `sunder`. Read first: commands.h, then the file of a command.
// processor_check.cpp runs before main().
#include <malloc.h>

#include <cstdio>

#include "engine/base/check.h"
#include "scenes/app/command_line.h"
#include "scenes/app/run.h"
#include "scenes/file/error_list.h"

int main(int argc, char** argv) {
  // Keep freed memory for the next frame: for a large solid, returning it and getting zeroed pages
  // takes a third of the time of its stress computation.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 1 << 30);
  sunder::app::clean_up_on_signals();
  try {
    const int code = sunder::app::parse_command_line(argc, argv)();
    if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
    throw sunder::FileError("standard output cannot be written");
  } catch (const sunder::scenes::InputErrors& errors) {
    for (const std::string& error : errors.all())
      std::fprintf(stderr, "error: %s\n", error.c_str());
    return 2;
  } catch (const sunder::InputError& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "failed: %s\n", error.what());
    const int stopped = sunder::app::stop_signal();
    return stopped != 0 ? 128 + stopped : 1;
  }
}
