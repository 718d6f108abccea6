// Timing of a frame by stage, from 1,000 to 100,000 convexes, and memory bandwidth and clock of the
// machine: the tables of docs/scale.md.
//
//   solver_bench scale [--most N] [--threads N] [--only rubble|solid|machine]
//
// Each run is a process of its own, so that its peak memory can be measured. Begin at run().
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <thread>
#include <vector>

#include "bench/solver/solver_bench.h"
#include "engine/base/cpu_time.h"
#include "engine/base/parallel.h"
#include "engine/model/frame.h"
#include "engine/world/simulation.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"
#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/contact/kernels/constraint_block.h"
#include "tests/fixtures/flags.h"

namespace sunder::bench {
namespace {

/// Number of untimed and of timed frames of a run.
constexpr int kWarmUp = 15, kTimed = 8;

/// Result that a run sends to its parent process.
struct Costs {
  double stage_ms[kStages] = {};  ///< Mean processor time per frame.
  double wall_ms = 0, worst_ms = 0;
  Counts counts;
  double resident_MB = 0;  ///< Peak resident memory.
};

/// Edges of a block of at least `count` unit cells.
struct Block {
  std::size_t x = 1, y = 1, z = 1;
  explicit Block(std::size_t count) {
    while (x * x * x < count) ++x;
    z = x;
    y = (count + x * z - 1) / (x * z);
  }
  std::size_t count() const { return x * y * z; }
};

constexpr const char* kHead =
    "[scene]\ndescription = \"x\"\n[limits]\nbodies = 200000\ndebris = 0\ndust = 0\n";

/// Returns a scene of loose boxes in shifted layers, all of which are in contact and awake.
std::string rubble(std::size_t count) {
  constexpr std::size_t kMostCopies = 20000;  // per solid
  const Block block(count);
  const auto row = [](std::size_t n, const std::string& step) {
    return "{ count = " + std::to_string(n) + ", " + step + " }";
  };
  std::string text = kHead;
  const std::size_t layers = std::max<std::size_t>(1, kMostCopies / (block.x * block.z));
  for (std::size_t first = 0; first < block.y; first += layers) {
    const auto at = [&](double step_m) {
      return std::to_string(step_m * static_cast<double>(first));
    };
    text += "[[solid]]\nstructure = \"box\"\nsize_m = [0.3, 0.25, 0.35]\nposition = [" + at(0.11) +
            ", " + at(0.2501) + ", " + at(0.07) + "]\nrepeat = [" +
            row(block.x, "step_m = [0.4, 0, 0]") + ", " + row(block.z, "step_m = [0, 0, 0.45]") +
            ", " + row(std::min(layers, block.y - first), "step_m = [0.11, 0.2501, 0.07]") + "]\n";
  }
  return text;
}

/// Returns a scene of one solid of at least `count` convexes that is hit during the timed frames.
std::string solid(std::size_t count) {
  const Block block(count);
  const auto size = [](std::size_t n) { return std::to_string(0.5 * static_cast<double>(n)); };
  const std::string z = std::to_string(0.25 * static_cast<double>(block.z) + 6);
  return std::string(kHead) +
         "[[solid]]\nstructure = \"box\"\nblock_m = 0.5\nanchored = \"bottom\"\n" + "size_m = [" +
         size(block.x) + ", " + size(block.y) + ", " + size(block.z) +
         "]\n[[script.shot]]\ntime_s = 0.2\nradius_m = 0.4\nspeed_m_s = 60\nfrom = [0, 2, " + z +
         "]\nat = [0, 2, 0]\n";
}

Costs run(const std::string& text, int threads) {
  set_threads(threads);
  const auto simulation = scenes::make_simulation(scenes::parse_scene(text, "scale.toml", {}));
  Costs costs;
  for (int i = 0; i < kWarmUp; ++i) simulation->next();
  for (int i = 0; i < kTimed; ++i) {
    const FramePtr frame = simulation->next();
    double frame_ms = 0;
    for (int s = 0; s < kStages; ++s) {
      costs.stage_ms[s] += frame->report.stage_cpu_ms[s] / kTimed;
      costs.wall_ms += frame->report.stage_ms[s] / kTimed;
      frame_ms += frame->report.stage_cpu_ms[s];
    }
    costs.worst_ms = std::max(costs.worst_ms, frame_ms);
    costs.counts = frame->report.counts;
  }
  rusage used{};
  getrusage(RUSAGE_SELF, &used);
  costs.resident_MB = static_cast<double>(used.ru_maxrss) / 1024;
  return costs;
}

/// Calls run() in a child process. Returns false if the child failed.
bool run_in_child(const std::string& text, int threads, Costs& costs) {
  int ends[2];
  if (pipe(ends) != 0) return false;
  const pid_t child = fork();
  if (child == 0) {
    const Costs found = run(text, threads);
    const bool sent = write(ends[1], &found, sizeof found) == sizeof found;
    _exit(sent ? 0 : 1);
  }
  close(ends[1]);
  const bool got = child > 0 && read(ends[0], &costs, sizeof costs) == sizeof costs;
  close(ends[0]);
  int status = 0;
  if (child > 0) waitpid(child, &status, 0);
  return got && status == 0;
}

void table(const char* name, std::string (*scene)(std::size_t), std::size_t most, int threads) {
  std::printf("\n| %s: convexes | threads |", name);
  for (const char* stage : kStageNames) std::printf(" %s |", stage);
  std::printf(" frame | worst | wall | µs a convex | contacts | MB |\n|---|---|");
  for (int s = 0; s < kStages + 6; ++s) std::printf("---|");
  std::printf("\n");
  for (std::size_t count = 1000; count <= most;
       count = count % 3 == 1 ? 3 * count : count / 3 * 10) {
    for (int t = 1; t <= threads; t *= 2) {
      Costs costs;
      if (!run_in_child(scene(count), t, costs)) {
        std::printf("| %zu | %d | failed |\n", count, t);
        continue;
      }
      std::printf("| %zu | %d |", Block(count).count(), t);
      double all_ms = 0;
      for (const double ms : costs.stage_ms) std::printf(" %.2f |", ms), all_ms += ms;
      std::printf(" %.1f | %.1f | %.1f | %.2f | %u | %.0f |\n", all_ms, costs.worst_ms,
                  costs.wall_ms, 1e3 * all_ms / static_cast<double>(Block(count).count()),
                  costs.counts.contacts, costs.resident_MB);
      std::fflush(stdout);
    }
  }
}

/// Returns the memory bandwidth of McCalpin's triad, a = b + 3 c, over arrays larger than the
/// caches: GB/s of `threads` threads if each had a processor to itself, the best of ten rounds.
double triad_GB_s(int threads) {
  constexpr std::size_t kCount = std::size_t{1} << 23;
  std::vector<double> a(kCount), b(kCount, 1), c(kCount, 2);
  double best = 0;
  set_threads(threads);
  for (int round = 0; round < 10; ++round) {
    const double before_ms = cpu_ms();
    for_chunks(kCount, kCount / 64, [&](std::size_t begin, std::size_t end, std::size_t) {
      for (std::size_t i = begin; i < end; ++i) a[i] = b[i] + 3 * c[i];
    });
    best = std::max(best, 3e-6 * threads * sizeof(double) * kCount / (cpu_ms() - before_ms));
  }
  return a[kCount / 2] == 7 ? best : 0;
}

/// Returns the effective clock rate from a chain of dependent additions, one per cycle.
double clock_GHz() {
  double best = 0;
  for (int round = 0; round < 5; ++round) {
    constexpr std::uint64_t kAdditions = 50'000'000;
    std::uint64_t x = static_cast<std::uint64_t>(round);
    const double before_ms = cpu_ms();
    for (std::uint64_t i = 0; i < kAdditions; ++i) asm volatile("add $1, %0" : "+r"(x));
    best = std::max(best, 1e-6 * static_cast<double>(kAdditions) / (cpu_ms() - before_ms));
  }
  return best;
}

void machine(int threads) {
  std::printf("\nclock: %.2f GHz by additions each of which needs the one before\n", clock_GHz());
  for (int t = 1; t <= threads; t *= 2)
    std::printf("triad: %.1f GB/s by %d threads\n", triad_GB_s(t), t);
  using namespace solver;
  constexpr std::uint32_t kWide = 8;
  std::printf(
      "bytes: %zu a pair, %zu a manifold, %zu a shape without its hull's arrays, %zu a "
      "manifold in a sweep\n",
      sizeof(Pair), sizeof(Manifold), sizeof(Shape), sizeof(ConstraintBlock<kWide>) / kWide);
}

}  // namespace

int measure_scale(int argc, char** argv) {
  int most = 100000, threads = static_cast<int>(std::thread::hardware_concurrency());
  std::string only;
  if (!read_flags(argc, argv,
                  {{"--most", &most, "N"},
                   {"--threads", &threads, "N"},
                   {"--only", &only, "rubble|solid|machine"}}))
    return kUsageError;
  const auto wanted = [&](const char* name) { return only.empty() || only == name; };
  if (wanted("rubble")) table("rubble", rubble, static_cast<std::size_t>(most), threads);
  if (wanted("solid")) table("one solid, hit", solid, static_cast<std::size_t>(most), threads);
  if (wanted("machine")) machine(threads);  // last: a process with threads cannot fork
  return 0;
}

}  // namespace sunder::bench
