#include "engine/world/simulation.h"

#include <algorithm>
#include <cmath>

#include "engine/base/trace.h"
#include "engine/world/actors/actors.h"
#include "engine/world/actors/joints.h"

namespace sunder {
namespace {

constexpr double kFrame_s = 1.0 / 60;

void collide(World& world) { world.physics->collide(world.horizon_s()); }

/// Moves everything; what the momentum did not come from gravity or static bodies is an error.
void solve(World& world) {
  const SolveReport report =
      world.physics->solve(world.scene.accuracy.dt_s, world.scene.accuracy.substeps);
  note_broken_joints(world);
  world.momentum_error_Ns +=
      (report.momentum_after_Ns - report.momentum_before_Ns - report.external_impulse_Ns).norm();
  // At rest weight and support cancel: what changed hands is the weight, not the sum of both.
  world.momentum_moved_Ns += report.momentum_before_Ns.norm() + report.mass_kg *
                                                                    world.scene.gravity_W.norm() *
                                                                    world.scene.accuracy.dt_s;
  world.report.counts.contacts = report.contacts;
  world.report.frozen += report.frozen;
}

void add_ground(World& world) {
  ShapeDesc plane;
  plane.kind = ShapeDesc::Kind::kHalfSpace;
  plane.friction = world.scene.ground.friction;
  plane.restitution = world.scene.ground.restitution;
  BodyDesc body;
  body.X_WB.position = Vec3(0, world.scene.ground.height_m, 0);
  body.is_static = true;
  body.shapes = {plane};
  body.tag = kGroundKey;
  world.physics->replace({}, std::span(&body, 1));
}

int steps_per_frame(double dt_s) {
  return std::max(1, static_cast<int>(std::lround(kFrame_s / dt_s)));
}

}  // namespace

Simulation::Simulation(Scene scene, std::unique_ptr<Physics> physics,
                       std::unique_ptr<Breaker> breaker, std::unique_ptr<Particles> particles)
    : world_(std::make_unique<World>()) {
  World& world = *world_;
  world.scene = std::move(scene);
  world.physics = std::move(physics);
  world.breaker = std::move(breaker);
  world.particles = std::move(particles);
  world.steps_per_frame = steps_per_frame(world.scene.accuracy.dt_s);
  world.materials = std::make_shared<const std::vector<Material>>(world.scene.materials);
  add_ground(world);
  add_compounds(world, world.scene.solids);
  for (const Ball& ball : world.scene.balls) add_ball(world, ball);
  for (const Joint& joint : world.scene.joints) add_joint(world, joint);  // keys are indices still
}

Simulation::~Simulation() = default;

FramePtr Simulation::next() {
  World& world = *world_;
  const int steps = world.steps_per_frame;
  if (world.started) {
    const double frame_s = steps * world.scene.accuracy.dt_s;
    if (static_cast<double>(world.frame + 1) * frame_s > world.scene.duration_s + 0.5 * frame_s) {
      return nullptr;
    }
    ++world.frame;
    world.parts_left = world.scene.limits.parts_a_frame;
    const std::int64_t load_work = world.scene.limits.load_work_a_frame;
    world.load_work_left = std::min(load_work, world.load_work_left + load_work);
    for (int i = 0; i < steps; ++i) advance();
  }
  world.started = true;
  const Stopwatch watch;
  auto frame = snapshot(world);
  frame->report.stage_ms[static_cast<int>(Stage::kSnapshot)] = watch.ms();
  return frame;
}

void Simulation::advance() {
  World& world = *world_;
  const auto stage = [&](Stage name, void (*work)(World&)) {
    const Stopwatch watch;
    work(world);
    world.report.stage_ms[static_cast<int>(name)] += watch.ms();
  };
  stage(Stage::kAct, act_stage);
  stage(Stage::kCollide, collide);
  stage(Stage::kBreak, break_stage);
  stage(Stage::kAct, push_stage);
  stage(Stage::kSolve, solve);
  stage(Stage::kLoad, load_stage);
  stage(Stage::kParticles, particle_stage);
  ++world.step;
}

}  // namespace sunder
