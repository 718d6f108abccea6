#include "engine/world/snapshot.h"

#include <cstddef>
#include <utility>
#include <vector>

#include "engine/base/parallel.h"
#include "engine/model/view_path.h"
#include "engine/world/actors/draw_bends.h"

namespace sunder {
namespace {

constexpr std::size_t kBodiesAChunk = 64;

FrameBody body_of(const Actor& actor, const BodyState& state) {
  return {actor.key,
          state.X_WB,
          actor.weight.com_R,
          state.velocity_W,
          state.angular_velocity_W,
          actor.is_static,
          state.asleep,
          actor.last_frame_key,
          actor.name,
          actor.weight.mass_kg};
}

/// Adds an actor to the sums of a report.
void count(const WorldState& world, const Actor& actor, const BodyState& state,
           FrameReport& report) {
  report.mass_kg += actor.weight.mass_kg;
  report.counts.convexes += actor.structure.size();
  if (!actor.structure.empty()) {
    ++report.counts.compounds;
    report.volume_m3 += actor.volume_m3;
  }
  if (actor.is_static) return;
  ++report.counts.bodies;
  if (!state.asleep) ++report.counts.awake;
  const Vec3 spin_B = state.X_WB.rotation.conjugate() * state.angular_velocity_W;
  report.kinetic_J += 0.5 * actor.weight.mass_kg * state.velocity_W.squaredNorm() +
                      0.5 * spin_B.dot(actor.weight.inertia_R * spin_B);
  report.potential_J -= actor.weight.mass_kg * world.scene.gravity_W.dot(state.X_WB.position);
}

void add(const FrameReport& part, FrameReport& report) {
  report.mass_kg += part.mass_kg;
  report.volume_m3 += part.volume_m3;
  report.kinetic_J += part.kinetic_J;
  report.potential_J += part.potential_J;
  report.counts.convexes += part.counts.convexes;
  report.counts.compounds += part.counts.compounds;
  report.counts.bodies += part.counts.bodies;
  report.counts.awake += part.counts.awake;
}

/// Adds all actors to the sums of a report, in parallel, as the work is bound by memory; sums are
/// over fixed chunks.
void count_all(const WorldState& world, FrameReport& report) {
  const BodyStates states = world.physics->states();
  const std::size_t actors = world.actors.size();
  std::vector<FrameReport> parts((actors + kBodiesAChunk - 1) / kBodiesAChunk);
  for_chunks(actors, kBodiesAChunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
    for (std::size_t i = begin; i < end; ++i)
      count(world, world.actors[i], states[world.actors[i].body], parts[c]);
  });
  for (const FrameReport& part : parts) add(part, report);
}

void add_bodies(const WorldState& world, Frame& frame) {
  const BodyStates states = world.physics->states();
  const std::size_t actors = world.actors.size();
  frame.bodies.resize(actors);
  std::vector<std::vector<Instance>> parts((actors + kBodiesAChunk - 1) / kBodiesAChunk);
  for_chunks(actors, kBodiesAChunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
    for (std::size_t i = begin; i < end; ++i) {
      const Actor& actor = world.actors[i];
      frame.bodies[i] = body_of(actor, states[actor.body]);
      for (const MeshIndex mesh : actor.meshes) {
        if (!mesh.none()) parts[c].push_back({mesh, static_cast<std::uint32_t>(i)});
      }
    }
  });
  for (const std::vector<Instance>& part : parts)
    frame.instances.insert(frame.instances.end(), part.begin(), part.end());
}

/// Adds the ground's meshes, if any, as the last body.
void add_landscape(const WorldState& world, Frame& frame) {
  if (world.landscape.meshes.empty()) return;
  const auto index = static_cast<std::uint32_t>(frame.bodies.size());
  FrameBody& body = frame.bodies.emplace_back();
  body.key = kGroundKey;
  body.is_static = true;
  for (const MeshIndex mesh : world.landscape.meshes) frame.instances.push_back({mesh, index});
}

}  // namespace

FrameReport end_frame(WorldState& world, double mass_to_come_kg, std::uint32_t carried_over) {
  RunLog& log = world.log;
  count_all(world, log.report);
  log.report.mass_kg += log.debris_mass_kg + log.removed_mass_kg + mass_to_come_kg;
  log.report.carried_over = carried_over;
  log.report.limits_hit = log.report.limits.sum();
  log.end_frame(world.clock.frame == 0);
  for (const WorkItem& item : world.physics->take_work()) log.work_counts.add(item);
  log.report.work = log.work_counts.take();
  return std::exchange(log.report, {});
}

std::shared_ptr<Frame> snapshot(WorldState& world, ParticleStage& particles,
                                const FrameReport& report) {
  draw_bends(world);
  world.meshes.draw(world.actors);
  auto frame = std::make_shared<Frame>();
  frame->index = world.clock.frame;
  frame->time_s = world.clock.time_s();
  frame->view = along(world.scene.view_keys, world.scene.view, frame->time_s);
  frame->view.ground_m = world.scene.ground.height_m;
  frame->materials = world.materials;
  frame->names = world.names;
  frame->appearances = world.appearances;
  frame->meshes = world.meshes.publish();
  frame->report = report;
  add_bodies(world, *frame);
  add_landscape(world, *frame);
  for (Actor& actor : world.actors) actor.last_frame_key = actor.key;
  particles.show(*frame);
  frame->report.penetrations_m = world.physics->penetrations();
  frame->report.limits_hit = frame->report.limits.sum();
  return frame;
}

}  // namespace sunder
