#include "scenes/app/run.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "engine/base/parallel.h"
#include "engine/model/scene_accuracy.h"
#include "fracture/pattern_breaker.h"
#include "scenes/file/planar.h"
#include "scenes/file/schema.h"
#include "solver/particles/debris_and_dust.h"
#include "solver/planar/planar_physics.h"
#include "solver/rigid/rigid_physics.h"

namespace sunder::app {

namespace {

/// Of the air that carries dust: what the largest scenes need, and what a frame can spare.
const Eigen::Vector3i kAirCells(40, 24, 40);

constexpr const char* kCases = "sunder-cases";

/// Writes breaks that went wrong to files, and says so when the run is over.
std::shared_ptr<fracture::FailureLog> failure_log() {
  const auto tell = [](fracture::FailureLog* log) {
    if (log->failed() > 0) {
      std::fprintf(stderr,
                   "%llu convexes were left whole because their parts did not add up; "
                   "%zu breaks are kept in %s/, to look into by `sunder fracture`\n",
                   static_cast<unsigned long long>(log->failed()), log->files(), kCases);
    }
    delete log;
  };
  return {new fracture::FailureLog(kCases), tell};
}

/// As many dimensions as the scene needs.
std::unique_ptr<Physics> make_physics(const Scene& scene) {
  if (scene.planar) {
    solver::PlanarOptions planar;
    planar.gravity_W = scene.gravity_W;
    planar.piece_m = scenes::planar_piece_m(scene);
    return solver::make_planar_physics(planar);
  }
  solver::RigidOptions rigid;
  rigid.gravity_W = scene.gravity_W;
  rigid.max_colors = scene.solver.max_colors;
  rigid.sweeps = scene.solver.sweeps;
  rigid.lanes = scene.solver.lanes;
  return solver::make_rigid_physics(rigid);
}

std::vector<std::string> warnings_of(const Scene& scene) {
  const std::string warning = accuracy_warning(scene, scenes::kMostSubsteps);
  return warning.empty() ? std::vector<std::string>{} : std::vector{warning};
}

}  // namespace

std::unique_ptr<Simulation> make_simulation(Scene scene) {
  for (const std::string& warning : warnings_of(scene))
    std::fprintf(stderr, "warning: %s: %s\n", scene.name.c_str(), warning.c_str());
  std::unique_ptr<Particles> particles;
  if (scene.limits.debris + scene.limits.dust > 0) {
    solver::DebrisAndDustOptions options;
    options.gravity_W = scene.gravity_W;
    options.seed = scene.seed;
    options.air_cells = kAirCells;
    options.limits = {scene.limits.debris, scene.limits.dust};
    particles = solver::make_debris_and_dust(options);
  }
  std::unique_ptr<Physics> physics = make_physics(scene);
  return std::make_unique<Simulation>(std::move(scene), std::move(physics),
                                      fracture::make_pattern_breaker(failure_log()),
                                      std::move(particles));
}

RunInfo run_info(const Scene& scene, const scenes::LoadOptions& load) {
  const auto breaks = [&](const Solid& solid) {
    return std::any_of(solid.compound.convexes.begin(), solid.compound.convexes.end(),
                       [&](const ConvexPtr& convex) {
                         return scene.materials[convex->material.value].breakable();
                       });
  };
  const bool scripted = !scene.shots.empty() || !scene.blasts.empty() || !scene.removals.empty() ||
                        !scene.drives.empty();
  const bool any = std::any_of(scene.solids.begin(), scene.solids.end(), breaks);
  return {scene.name,
          load.preset,
          threads(),
          scene.accuracy,
          {{"fracture", any ? "on" : "off: nothing here is breakable"},
           {"script", scripted ? "on" : "off: nothing happens"},
           {"sleeping", "on"},
           {"third_dimension", scene.planar ? "off: planar = true, so Box2D moves it" : "on"}},
          {scene.solver.max_colors, scene.solver.sweeps, solver::lanes_in_use(scene.solver.lanes)},
          warnings_of(scene)};
}

int last_frame(const Scene& scene, int wanted) {
  const int all = static_cast<int>(std::lround(scene.duration_s * 60));
  return wanted < 0 ? all : std::min(all, wanted);
}

Progress::Progress(std::string title, int last_frame, bool quiet)
    : title_(std::move(title)), last_(last_frame), quiet_(quiet), terminal_(isatty(2) == 1) {}

std::string Progress::line(int frame) const {
  const double elapsed_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double left_s = frame > 0 ? elapsed_s / frame * (last_ - frame) : 0;
  char text[160];
  std::snprintf(text, sizeof text, "%s: frame %d of %d, %.0f s left", title_.c_str(), frame, last_,
                left_s);
  return text;
}

void Progress::take(const FramePtr& frame) {
  const int index = static_cast<int>(frame->index);
  if (quiet_ || last_ <= 0 || index < next_report_) return;
  if (terminal_) {
    constexpr int kWidth = 30;
    const auto done = static_cast<std::size_t>(std::min(kWidth, kWidth * index / last_));
    std::fprintf(stderr, "\r[%s%s] %s\033[K", std::string(done, '#').c_str(),
                 std::string(kWidth - done, ' ').c_str(), line(index).c_str());
    next_report_ = index + 1;
  } else {
    if (index > 0) std::fprintf(stderr, "%s\n", line(index).c_str());
    next_report_ = index + std::max(1, last_ / 5);
  }
}

void Progress::finish() {
  if (!quiet_ && terminal_) std::fputs("\n", stderr);
}

}  // namespace sunder::app
