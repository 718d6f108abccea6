#include "engine/world/simulation.h"

#include <optional>
#include <utility>
#include <vector>

#include "engine/base/cpu_time.h"
#include "engine/base/loop_count.h"
#include "engine/base/trace.h"
#include "engine/model/work_log.h"
#include "engine/world/act/act_stage.h"
#include "engine/world/act/moves.h"
#include "engine/world/actors/hinges.h"
#include "engine/world/actors/landscape.h"
#include "engine/world/actors/make_actor.h"
#include "engine/world/break/break_stage.h"
#include "engine/world/inspect.h"
#include "engine/world/load/load_stage.h"
#include "engine/world/particles/particle_stage.h"
#include "engine/world/snapshot.h"

namespace sunder {
namespace {

/// Measures the time of each stage of a frame, from the end of the last one.
class StageClock {
 public:
  void end(Stage stage, FrameReport& report) {
    const double now_ms = cpu_ms();
    report.stage_ms[static_cast<int>(stage)] += watch_.lap_ms();
    report.stage_cpu_ms[static_cast<int>(stage)] += now_ms - std::exchange(cpu_ms_, now_ms);
    const LoopTimes loops = LoopCount::times();
    report.stage_loops[static_cast<int>(stage)] += loops - std::exchange(loops_, loops);
  }

 private:
  LoopTimes loops_ = LoopCount::times();
  Stopwatch watch_;
  double cpu_ms_ = cpu_ms();
};

/// Advances all bodies by a step, removes joints that broke, and updates plastic hinges.
void solve(World& world) {
  const Clock& clock = world.clock;
  const SolveReport report = world.physics->solve(clock.dt_s, clock.substeps);
  world.log.add_solve(report, world.scene.gravity_W.norm() * clock.dt_s);
  world.log.report.joints_lost += world.joints.take_broken(*world.physics);
  update_hinges(world);
}

}  // namespace

/// The world and the stages.
struct Simulation::Parts {
  World world;
  std::unique_ptr<Breaker> breaker;
  ActStage act;
  BreakStage breaks;
  LoadStage loads;
  ParticleStage particles;
  bool started = false;   ///< Frame 0 has been returned.
  bool inspects = false;  ///< Frames get inspections.
  bool counts_loops = false;

  Parts(Scene scene, std::unique_ptr<Physics> physics, std::unique_ptr<Breaker> breaks_by,
        std::unique_ptr<Particles> moves)
      : world(std::move(scene), std::move(physics)),
        breaker(std::move(breaks_by)),
        breaks(world.scene.limits),
        loads(world.scene.limits),
        particles(std::move(moves)) {
    if (particles.any()) world.exposed.emplace();
  }
};

Simulation::Simulation(Scene scene, std::unique_ptr<Physics> physics,
                       std::unique_ptr<Breaker> breaker, std::unique_ptr<Particles> particles)
    : parts_(std::make_unique<Parts>(std::move(scene), std::move(physics), std::move(breaker),
                                     std::move(particles))) {
  World& world = parts_->world;
  add_ground(world);
  add_compounds(world, world.scene.solids);
  for (const Ball& ball : world.scene.balls) add_ball(world, ball);
  for (Actor& actor : world.actors) actor.name = actor.key;
  for (const Joint& joint : world.scene.joints) {  // keys are still indices
    world.joints.add(*world.physics, world.actors, joint);
  }
  start_moves(world);
  parts_->loads.prepare(world, *parts_->breaker);
}

Simulation::~Simulation() = default;

void Simulation::inspect() { parts_->inspects = true; }

void Simulation::count_loops() { parts_->counts_loops = true; }

FramePtr Simulation::next() {
  auto& [world, breaker, act, breaks, loads, particles, started, inspects, counts_loops] = *parts_;
  std::optional<LoopCount> count;
  if (counts_loops) count.emplace();
  if (started) {
    const double frame_s = world.clock.frame_s();
    const double end_s = static_cast<double>(world.clock.frame + 1) * frame_s;
    if (end_s > world.scene.duration_s + 0.5 * frame_s) return nullptr;
    ++world.clock.frame;
    breaks.begin_frame();
    loads.begin_frame();
    for (int i = 0; i < world.clock.steps_per_frame; ++i) advance();
  }
  started = true;
  const TraceSpan span(kStageNames[static_cast<int>(Stage::kSnapshot)]);
  StageClock clock;
  for (const WorkItem& item : world.physics->take_work()) world.log.work_counts.add(item);
  auto frame = snapshot(world, particles, act.shots_to_come(world.scene),
                        breaks.deferred() + loads.deferred());
  frame->report.work = world.log.work_counts.take();
  clock.end(Stage::kSnapshot, frame->report);
  if (inspects) frame->inspection = sunder::inspect(world, *breaker, *frame);
  return frame;
}

void Simulation::advance() {
  Parts& parts = *parts_;
  World& world = parts.world;
  const Breaker& breaker = *parts.breaker;
  StageClock clock;
  const auto timed = [&](Stage stage, const auto& work) {
    const TraceSpan span(kStageNames[static_cast<int>(stage)]);
    work();
    clock.end(stage, world.log.report);
  };
  std::vector<ActorImpact> impacts;  // of blasts
  timed(Stage::kAct, [&] { impacts = parts.act.run(world); });
  timed(Stage::kCollide, [&] { world.physics->collide(world.clock.horizon_s()); });
  timed(Stage::kBreak, [&] { parts.breaks.run(world, breaker, impacts); });
  timed(Stage::kAct, [&] { parts.act.push(world); });
  timed(Stage::kSolve, [&] { solve(world); });
  timed(Stage::kLoad, [&] { parts.loads.run(world, breaker); });
  timed(Stage::kParticles, [&] {
    if (!parts.particles.any() || !world.clock.ends_frame()) return;
    // Faces exposed by a blast emit particles after the blast's impulse, at the speed of their
    // parting.
    const bool delayed = parts.act.has_blast_impulse();
    WorkSpan span(world.log.work_counts, Stage::kParticles, "particles");
    parts.particles.run(world, delayed ? Exposed{} : std::exchange(*world.exposed, {}));
    span.count(parts.particles.alive());
    if (delayed) world.exposed->delay(world.clock.frame_s());
  });
  ++world.clock.step;
}

}  // namespace sunder
