// Comparison of our rigid solver with Bullet and ODE on the same rubble (one thread, no sleeping):
// time per frame, penetration and residual speed at the end. Prints a Markdown table; * marks
// results that no other beats in both time and depth.
//
//   peers_bench [--hulls N] [--frames N] [--engine sunder|bullet|ode] [--defaults]
//   peers_bench --rays N [--hulls N] [--write FILE]
//
// With --rays, ray casts of ours and of Bullet instead (rays.h).
#include <cstdio>
#include <cstring>
#include <string>

#include "bench/peers/peer.h"
#include "bench/peers/penetration.h"
#include "bench/peers/rays.h"
#include "bench/piles.h"
#include "engine/base/cpu_time.h"
#include "engine/base/parallel.h"
#include "tests/fixtures/flags.h"

namespace sunder::bench {
namespace {

using Make = std::unique_ptr<Peer> (*)(std::span<const BodyDesc>, const Effort&);

/// An engine with a step rate and an iteration count; the first of each engine is its default.
struct Entry {
  const char* engine;
  const char* how;
  Make make;  ///< Null if CMake did not find the engine.
  Effort effort;
  bool is_default;
};

#ifdef SUNDER_BULLET
constexpr Make kBullet = make_bullet;
#else
constexpr Make kBullet = nullptr;
#endif
#ifdef SUNDER_ODE
constexpr Make kOde = make_ode;
#else
constexpr Make kOde = nullptr;
#endif

constexpr Entry kEntries[] = {
    {"sunder", "4 substeps", make_sunder, {60, 4}, true},
    {"sunder", "1 substep", make_sunder, {60, 1}, false},
    {"sunder", "2 substeps", make_sunder, {60, 2}, false},
    {"sunder", "8 substeps", make_sunder, {60, 8}, false},
    {"sunder", "120 Hz, 4 substeps", make_sunder, {120, 4}, false},
    {"bullet", "10 iterations", kBullet, {60, 10}, true},
    {"bullet", "30 iterations", kBullet, {60, 30}, false},
    {"bullet", "120 Hz, 10 iterations", kBullet, {120, 10}, false},
    {"ode", "20 iterations", kOde, {60, 20}, true},
    {"ode", "50 iterations", kOde, {60, 50}, false},
};

struct Options {
  int hulls = 2000;
  int frames = 600;
  std::string engine = "all";
  bool defaults = false;
  int rays = 0;       ///< Above 0: rays are cast instead.
  std::string write;  ///< File for the rays; empty: none.
};

struct Result {
  const Entry* entry;
  double average_ms = 0, worst_ms = 0, last_ms = 0;  ///< Processor time of a frame.
  double mean_mm = 0, max_mm = 0;                    ///< Penetration over overlapping pairs.
  double rms_m_s = 0;
  std::size_t overlapping = 0;
  std::size_t lost = 0;  ///< Bodies outside the pit or without a finite position.
};

void measure_end_state(const Pile& pile, const Peer& peer, Result& result) {
  constexpr double kOut_m = 0.5;
  const double wall_m = pile.bodies[2].shapes[0].center_R.norm() + kOut_m;
  std::vector<Pose> poses;
  double squares = 0;
  std::size_t moving = 0;
  for (std::size_t i = 0; i < pile.bodies.size(); ++i) {
    const BodyState state = peer.state(i);
    poses.push_back(state.X_WB);
    if (pile.bodies[i].is_static) continue;
    const Vec3& at = state.X_WB.position;
    if (!at.allFinite() || at.y() < -kOut_m || std::abs(at.x()) > wall_m ||
        std::abs(at.z()) > wall_m) {
      ++result.lost;
      poses.back().position.setConstant(NAN);  // penetrations() skips bodies without a position
      continue;
    }
    squares += state.velocity_W.squaredNorm();
    ++moving;
  }
  result.rms_m_s = std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, moving)));
  const std::vector<double> depths = penetrations(pile.bodies, poses);
  for (const double depth : depths) {
    result.mean_mm += 1e3 * depth / static_cast<double>(depths.size());
    result.max_mm = std::max(result.max_mm, 1e3 * depth);
  }
  result.overlapping = depths.size();
}

Result run(const Pile& pile, const Entry& entry, const Options& options) {
  const std::unique_ptr<Peer> peer = entry.make(pile.bodies, entry.effort);
  const int steps = static_cast<int>(std::lround(entry.effort.rate_Hz / 60));
  const int last = std::min(60, options.frames);
  Result result{&entry};
  for (int frame = 0; frame < options.frames; ++frame) {
    const double start = cpu_ms();
    for (int i = 0; i < steps; ++i) peer->step(1 / entry.effort.rate_Hz);
    const double ms = cpu_ms() - start;
    result.average_ms += ms / options.frames;
    result.worst_ms = std::max(result.worst_ms, ms);
    if (frame >= options.frames - last) result.last_ms += ms / last;
  }
  measure_end_state(pile, *peer, result);
  return result;
}

bool is_beaten(const Result& result, std::span<const Result> all) {
  return std::any_of(all.begin(), all.end(), [&](const Result& other) {
    return other.lost <= result.lost && other.average_ms < result.average_ms &&
           other.mean_mm < result.mean_mm;
  });
}

/// Prints how much faster ours is than another engine at its defaults: with our defaults, and with
/// our fastest setting that has no more penetration.
void compare(const Result& theirs, std::span<const Result> all) {
  double fastest_ms = 0;
  for (const Result& ours : all) {
    if (std::strcmp(ours.entry->engine, "sunder") != 0) continue;
    if (ours.entry->is_default) {
      std::printf("%s, defaults of both: %.1f times the time, %.1f times the mean depth of ours\n",
                  theirs.entry->engine, theirs.average_ms / ours.average_ms,
                  theirs.mean_mm / ours.mean_mm);
    }
    if (ours.mean_mm > theirs.mean_mm || ours.lost > theirs.lost) continue;
    if (fastest_ms == 0 || ours.average_ms < fastest_ms) fastest_ms = ours.average_ms;
  }
  if (fastest_ms > 0) {
    std::printf("%s at its default, ours at no more depth: %.1f times the time\n",
                theirs.entry->engine, theirs.average_ms / fastest_ms);
  }
}

void run_all(const Options& options) {
  set_threads(1);
  const Pile pile = rubble(options.hulls);
  std::printf("%d hulls, %d frames, one thread, sleeping off; processor time\n\n", options.hulls,
              options.frames);
  std::printf(
      "| engine | effort | ms average / worst / last 60 | depth mm mean / max | overlapping "
      "pairs | rms m/s | lost | |\n|---|---|---|---|---|---|---|---|\n");
  std::vector<Result> results;
  for (const Entry& entry : kEntries) {
    if (options.engine != "all" && options.engine != entry.engine) continue;
    if (options.defaults && !entry.is_default) continue;
    if (!entry.make) {
      if (entry.is_default) std::printf("| %s | skipped: not found | | | | | | |\n", entry.engine);
      continue;
    }
    results.push_back(run(pile, entry, options));
    std::fprintf(stderr, "%s, %s: %.2f ms\n", entry.engine, entry.how, results.back().average_ms);
  }
  for (const Result& r : results) {
    std::printf("| %s | %s | %.2f / %.1f / %.2f | %.3f / %.1f | %zu | %.1e | %zu | %s |\n",
                r.entry->engine, r.entry->how, r.average_ms, r.worst_ms, r.last_ms, r.mean_mm,
                r.max_mm, r.overlapping, r.rms_m_s, r.lost, is_beaten(r, results) ? "" : "*");
  }
  std::printf("\n");
  for (const Result& r : results) {
    if (r.entry->is_default && std::strcmp(r.entry->engine, "sunder") != 0) compare(r, results);
  }
}

}  // namespace
}  // namespace sunder::bench

int main(int argc, char** argv) {
  sunder::bench::Options options;
  if (!sunder::read_flags(argc, argv,
                          {{"--hulls", &options.hulls, "N"},
                           {"--frames", &options.frames, "N"},
                           {"--engine", &options.engine, "sunder|bullet|ode"},
                           {"--defaults", &options.defaults},
                           {"--rays", &options.rays, "N"},
                           {"--write", &options.write, "FILE"}},
                          [&] {
                            return options.hulls > 0 && options.frames > 0 && options.rays >= 0 &&
                                   (options.write.empty() || options.rays > 0);
                          }))
    return sunder::kUsageError;
  if (options.rays > 0) {
    sunder::set_threads(1);
    sunder::bench::compare_rays(options.hulls, options.rays, options.write);
  } else {
    sunder::bench::run_all(options);
  }
}
