// Runs random scenes with random shots, one after another, and checks every frame: all values are
// finite, mass is conserved, limits hold, and memory does not grow.
//
//   soak [--time S | --scenes N] [--seed FIRST] [--out FOLDER]
//
// The scene that is running is in FOLDER/soak.toml, with the command that runs it, and stays there
// if the program crashes. The exit code is 1 if a check fails.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <string>

#include "engine/base/check.h"
#include "engine/model/frame.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"
#include "tests/fixtures/flags.h"
#include "tests/fuzz/random_scene.h"

#ifdef __GLIBC__
extern "C" int malloc_trim(std::size_t pad);  // of <malloc.h>
#endif

namespace sunder::fuzz {
namespace {

constexpr int kMaxFrames = 180;          // largest number of frames of a scene
constexpr double kMassTolerance = 1e-9;  // relative
constexpr double kLongRun_s = 300;       // shortest run whose memory is checked
/// Largest growth of memory in a long run: a factor, and an addition to it.
constexpr double kMaxMemoryGrowth = 1.05, kMemoryAllowance_MiB = 8;

struct Options {
  double time_s = 0;
  int scenes = 0, seed = 1;
  std::string out = ".";
};

struct Tally {
  std::uint64_t scenes = 0, frames = 0, breaks = 0, limits_hit = 0;
  std::uint32_t most_bodies = 0;
  std::map<std::string, int> by_name;
};

double seconds() {
  using Clock = std::chrono::steady_clock;
  static const Clock::time_point start = Clock::now();
  return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Returns the resident memory in MiB, after free memory of the heap is returned; 0 if unknown.
double resident_MiB() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
  std::ifstream statm("/proc/self/statm");
  double all = 0, resident = 0;
  statm >> all >> resident;
  return resident * static_cast<double>(sysconf(_SC_PAGESIZE)) / (1 << 20);
}

/// Returns a description of the first fault of a frame, or an empty string.
std::string find_fault(const Frame& frame, const Limits& limits, double mass_kg) {
  for (const FrameBody& body : frame.bodies) {
    const bool finite = body.X_WB.position.allFinite() && body.velocity_W.allFinite() &&
                        body.angular_velocity_W.allFinite() &&
                        std::abs(body.X_WB.rotation.norm() - 1) < 1e-6;
    if (!finite) return "body " + std::to_string(body.key) + " is not finite";
  }
  for (const FrameDebris& chip : frame.debris)
    if (!chip.position_W.allFinite()) return "debris is not finite";
  for (const FrameDust& puff : frame.dust)
    if (!puff.position_W.allFinite()) return "dust is not finite";
  const FrameReport& report = frame.report;
  if (!(std::abs(report.mass_kg - mass_kg) <= kMassTolerance * mass_kg))
    return "mass is " + std::to_string(report.mass_kg) + ", was " + std::to_string(mass_kg);
  if (!std::isfinite(report.kinetic_J)) return "energy is not finite";
  if (report.counts.bodies > limits.bodies) return "more bodies than limits.bodies";
  if (frame.debris.size() > limits.debris) return "more debris than limits.debris";
  if (frame.dust.size() > limits.dust) return "more dust than limits.dust";
  return {};
}

/// Runs a scene; returns a description of its first fault, or an empty string.
std::string run(const RandomScene& given, Tally& tally) {
  Scene scene = scenes::parse_scene(given.text, given.file, {given.preset, {}});
  Limits limits = scene.limits;
  // Shots are added even if there are limits.bodies bodies.
  for (const Shot& shot : scene.shots)
    limits.bodies += 1 + static_cast<std::uint32_t>(shot.links.size());
  const auto simulation = scenes::make_simulation(std::move(scene));
  double mass_kg = 0;
  for (int i = 0; i < kMaxFrames; ++i) {
    const FramePtr frame = simulation->next();
    if (!frame) break;
    if (i == 0) mass_kg = frame->report.mass_kg;
    const std::string fault = find_fault(*frame, limits, mass_kg);
    if (!fault.empty()) return "frame " + std::to_string(frame->index) + ": " + fault;
    ++tally.frames;
    tally.breaks += frame->breaks.size();
    tally.limits_hit += frame->report.limits_hit;
    tally.most_bodies = std::max(tally.most_bodies, frame->report.counts.bodies);
  }
  ++tally.scenes;
  ++tally.by_name[given.name];
  return {};
}

void write_scene(const std::filesystem::path& path, const RandomScene& scene, int seed) {
  std::ofstream(path) << "# seed " << seed << ", in " << scene.file << ": sunder simulate "
                      << path.string() << " --preset " << scene.preset << "\n"
                      << scene.text;
}

void print(const Tally& tally, double memory_MiB) {
  std::printf(
      "%6.0f s: %llu scenes, %llu frames, %llu breaks, at most %u bodies, %llu limits hit, "
      "%.0f MiB\n",
      seconds(), static_cast<unsigned long long>(tally.scenes),
      static_cast<unsigned long long>(tally.frames), static_cast<unsigned long long>(tally.breaks),
      tally.most_bodies, static_cast<unsigned long long>(tally.limits_hit), memory_MiB);
  std::fflush(stdout);
}

int soak(const Options& options) {
  const std::filesystem::path scene_path = std::filesystem::path(options.out) / "soak.toml";
  Tally tally;
  double first_MiB = 0, last_MiB = 0, printed_s = 0;
  for (int i = 0; options.scenes > 0 ? i < options.scenes : seconds() < options.time_s; ++i) {
    const int seed = options.seed + i;
    const RandomScene scene = random_scene(static_cast<std::uint64_t>(seed));
    write_scene(scene_path, scene, seed);
    std::string fault;
    try {
      fault = run(scene, tally);
    } catch (const InputError& error) {
      fault = error.what();
    }
    if (!fault.empty()) {
      std::fprintf(stderr, "seed %d: %s; see %s\n", seed, fault.c_str(), scene_path.c_str());
      return 1;
    }
    last_MiB = resident_MiB();
    if (seconds() < options.time_s / 6) first_MiB = std::max(first_MiB, last_MiB);
    if (seconds() > printed_s + 30) print(tally, last_MiB), printed_s = seconds();
  }
  print(tally, last_MiB);
  for (const auto& [name, count] : tally.by_name) std::printf("%5d %s\n", count, name.c_str());
  std::filesystem::remove(scene_path);
  if (options.time_s < kLongRun_s ||
      last_MiB <= kMaxMemoryGrowth * first_MiB + kMemoryAllowance_MiB)
    return 0;
  std::fprintf(stderr, "memory grew from %.0f to %.0f MiB\n", first_MiB, last_MiB);
  return 1;
}

}  // namespace
}  // namespace sunder::fuzz

int main(int argc, char** argv) {
  sunder::fuzz::Options options;
  if (!sunder::read_flags(argc, argv,
                          {{"--time", &options.time_s, "S"},
                           {"--scenes", &options.scenes, "N"},
                           {"--seed", &options.seed, "FIRST"},
                           {"--out", &options.out, "FOLDER"}}))
    return sunder::kUsageError;
  if ((options.time_s > 0) == (options.scenes > 0)) {
    std::fprintf(stderr, "give either --time or --scenes\n");
    return sunder::kUsageError;
  }
  return sunder::fuzz::soak(options);
}
