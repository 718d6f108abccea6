#include "scenes/timing/machine.h"

#include <sys/utsname.h>

#include <algorithm>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>

#include "scenes/timing/timing.h"
#include "solver/rigid/rigid_physics.h"

namespace sunder::scenes {
namespace {

constexpr const char* kUnknown = "unknown";

/// Returns the value of a line "NAME: value" of /proc/self/status; empty if there is none.
std::string status_value(const std::string& name) {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);) {
    if (!line.starts_with(name + ":")) continue;
    const std::size_t start = line.find_first_not_of(" \t", name.size() + 1);
    return start == std::string::npos ? "" : line.substr(start);
  }
  return {};
}

/// Returns the numbers of a list such as "0-3,8".
std::vector<int> numbers_of(const std::string& list) {
  std::vector<int> numbers;
  std::istringstream in(list);
  for (std::string part; std::getline(in, part, ',');) {
    int first = 0, last = 0;
    const int read = std::sscanf(part.c_str(), "%d-%d", &first, &last);
    for (int i = first; read > 0 && i <= (read == 2 ? last : first); ++i) numbers.push_back(i);
  }
  return numbers;
}

/// Returns the governors of processors, each once, as in "performance, powersave".
std::string governors_of(const std::vector<int>& processors) {
  std::set<std::string> governors;
  for (const int processor : processors) {
    std::ifstream in("/sys/devices/system/cpu/cpu" + std::to_string(processor) +
                     "/cpufreq/scaling_governor");
    std::string governor;
    governors.insert(in >> governor ? governor : kUnknown);
  }
  std::string text;
  for (const std::string& governor : governors) text += (text.empty() ? "" : ", ") + governor;
  return text.empty() ? kUnknown : text;
}

std::string environment(const char* name) {
  const char* const value = std::getenv(name);
  return value ? value : "not set";
}

}  // namespace

const char* instructions_of([[maybe_unused]] int lanes) {
#if defined(__x86_64__)
  return lanes == 16 ? "AVX-512" : lanes == 8 ? "AVX2" : "SSE2";
#elif defined(__aarch64__)
  return "NEON";
#else
  return "vectors of the compiler";
#endif
}

std::string allowed_processors() {
  const std::string list = status_value("Cpus_allowed_list");
  return list.empty() ? kUnknown : list;
}

Figures machine_figures() {
  utsname system{};
  const bool is_known = uname(&system) == 0;
  const std::string processors = allowed_processors();
  return {{"/machine/kernel", std::string(is_known ? system.release : kUnknown)},
          {"/machine/instructions", std::string(instructions_of(solver::lanes_in_use(0)))},
          {"/machine/governor", governors_of(numbers_of(processors))},
          {"/machine/processors", processors},
          {"/machine/omp_proc_bind", environment("OMP_PROC_BIND")},
          {"/machine/omp_places", environment("OMP_PLACES")}};
}

double peak_memory_MB() { return std::atof(status_value("VmHWM").c_str()) * 1024 / 1e6; }

Figures state_figures(const StateHash& states, int last_frame) {
  const auto frames = static_cast<std::size_t>(std::min(kStateFrames, last_frame));
  if (states.per_frame().size() <= frames) return {};
  return {{"/state/frames", static_cast<std::int64_t>(frames)},
          {"/state/hash", states.hex(frames + 1)}};
}

}  // namespace sunder::scenes
