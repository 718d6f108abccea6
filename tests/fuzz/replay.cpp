// Runs a fuzz target on each file of a folder, with any compiler, so that bugs found stay fixed.
// Usage: fuzz_replay TARGET FOLDER. With libFuzzer (SUNDER_FUZZ) it is the fuzzer of all targets:
// fuzzer TARGET [libFuzzer's arguments].
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <vector>

#include "tests/fuzz/fuzz_target.h"

std::map<std::string, sunder::fuzz::Target>& sunder::fuzz::targets() {
  static std::map<std::string, Target> all;
  return all;
}

namespace {

/// Returns the target that the first argument names; null, after a message, if there is none.
sunder::fuzz::Target find_target(int argc, char** argv) {
  const auto& targets = sunder::fuzz::targets();
  const auto target = argc >= 2 ? targets.find(argv[1]) : targets.end();
  if (target != targets.end()) return target->second;
  std::fprintf(stderr, "usage: %s TARGET FOLDER; targets:", argv[0]);
  for (const auto& [name, run] : targets) std::fprintf(stderr, " %s", name.c_str());
  std::fputs("\n", stderr);
  return nullptr;
}

}  // namespace

#ifdef SUNDER_FUZZ
static sunder::fuzz::Target fuzzed = nullptr;

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
  fuzzed = find_target(*argc, *argv);
  if (!fuzzed) std::exit(2);
  std::rotate(*argv + 1, *argv + 2, *argv + *argc);  // libFuzzer gets the arguments behind the name
  --*argc;
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  fuzzed({data, size});
  return 0;
}
#else
int main(int argc, char** argv) {
  const sunder::fuzz::Target target = find_target(argc, argv);
  if (!target || argc != 3) return 2;
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
    target(data);
  }
  return files.empty() ? 1 : 0;
}
#endif
