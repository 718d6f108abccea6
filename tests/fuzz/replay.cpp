// Runs a fuzz target on each file of a folder, with any compiler, so that bugs found stay fixed.
// Usage: fuzz_replay TARGET FOLDER. With libFuzzer (SUNDER_FUZZ) it is the fuzzer of SUNDER_FUZZED.
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/fuzz_target.h"

std::map<std::string, sunder::fuzz::Target>& sunder::fuzz::targets() {
  static std::map<std::string, Target> all;
  return all;
}

#ifdef SUNDER_FUZZED
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  sunder::fuzz::targets().at(SUNDER_FUZZED)({data, size});
  return 0;
}
#else
int main(int argc, char** argv) {
  const auto& targets = sunder::fuzz::targets();
  const auto target = argc == 3 ? targets.find(argv[1]) : targets.end();
  if (target == targets.end()) {
    std::fprintf(stderr, "usage: fuzz_replay TARGET FOLDER; targets:");
    for (const auto& [name, run] : targets) std::fprintf(stderr, " %s", name.c_str());
    std::fputs("\n", stderr);
    return 2;
  }
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator(argv[2])) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const std::filesystem::path& file : files) {
    std::printf("%s\n", file.c_str());
    std::fflush(stdout);  // so that the output names this file if the target aborts
    std::ifstream in(file, std::ios::binary);
    const std::vector<char> bytes{std::istreambuf_iterator<char>(in), {}};
    const std::vector<std::uint8_t> data(bytes.begin(), bytes.end());
    target->second(data);
  }
  return files.empty() ? 1 : 0;
}
#endif
