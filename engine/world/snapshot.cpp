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

void count(const World& world, const Actor& actor, const FrameBody& body, FrameReport& report) {
  report.mass_kg += actor.weight.mass_kg;
  report.counts.convexes += actor.structure.size();
  if (!actor.structure.empty()) {
    ++report.counts.compounds;
    report.volume_m3 += actor.volume_m3;
  }
  if (body.is_static) return;
  ++report.counts.bodies;
  if (!body.asleep) ++report.counts.awake;
  const Vec3 spin_B = body.X_WB.rotation.conjugate() * body.angular_velocity_W;
  report.kinetic_J += 0.5 * actor.weight.mass_kg * body.velocity_W.squaredNorm() +
                      0.5 * spin_B.dot(actor.weight.inertia_R * spin_B);
  report.potential_J -= actor.weight.mass_kg * world.scene.gravity_W.dot(body.X_WB.position);
}

/// Contribution of a chunk of actors to the frame.
struct Part {
  std::vector<Instance> instances;
  FrameReport report;
};

void add(const Part& part, Frame& frame) {
  frame.instances.insert(frame.instances.end(), part.instances.begin(), part.instances.end());
  FrameReport& report = frame.report;
  report.mass_kg += part.report.mass_kg;
  report.volume_m3 += part.report.volume_m3;
  report.kinetic_J += part.report.kinetic_J;
  report.potential_J += part.report.potential_J;
  report.counts.convexes += part.report.counts.convexes;
  report.counts.compounds += part.report.counts.compounds;
  report.counts.bodies += part.report.counts.bodies;
  report.counts.awake += part.report.counts.awake;
}

/// Adds all bodies, in parallel, as the work is bound by memory; sums are over fixed chunks.
void add_bodies(const World& world, Frame& frame) {
  const BodyStates states = world.physics->states();
  const std::size_t count_all = world.actors.size();
  frame.bodies.resize(count_all);
  std::vector<Part> parts((count_all + kBodiesAChunk - 1) / kBodiesAChunk);
  for_chunks(count_all, kBodiesAChunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
    Part& part = parts[c];
    for (std::size_t i = begin; i < end; ++i) {
      const Actor& actor = world.actors[i];
      frame.bodies[i] = body_of(actor, states[actor.body]);
      for (const MeshIndex mesh : actor.meshes) {
        if (!mesh.none()) part.instances.push_back({mesh, static_cast<std::uint32_t>(i)});
      }
      count(world, actor, frame.bodies[i], part.report);
    }
  });
  for (const Part& part : parts) add(part, frame);
}

/// Adds the ground's meshes, if any, as the last body.
void add_landscape(const World& world, Frame& frame) {
  if (world.landscape.meshes.empty()) return;
  const auto index = static_cast<std::uint32_t>(frame.bodies.size());
  FrameBody& body = frame.bodies.emplace_back();
  body.key = kGroundKey;
  body.is_static = true;
  for (const MeshIndex mesh : world.landscape.meshes) frame.instances.push_back({mesh, index});
}

}  // namespace

std::shared_ptr<Frame> snapshot(World& world, ParticleStage& particles,
                                std::span<const Shot> shots_to_come, std::uint32_t carried_over) {
  RunLog& log = world.log;
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
  frame->meshes = world.meshes.publish(world.actors, world.landscape.meshes);
  frame->report = std::exchange(log.report, {});
  FrameReport& report = frame->report;
  add_bodies(world, *frame);
  add_landscape(world, *frame);
  for (Actor& actor : world.actors) actor.last_frame_key = actor.key;
  particles.show(*frame);
  report.mass_kg += log.debris_mass_kg + log.removed_mass_kg;
  for (const Shot& shot : shots_to_come) {
    report.mass_kg += ball_mass_kg(shot.ball, *world.materials);
    for (const Solid& link : shot.links)
      report.mass_kg += mass_of(link.compound, *world.materials).mass_kg;
  }
  report.penetrations_m = world.physics->penetrations();
  report.carried_over = carried_over;
  report.limits_hit = report.limits.sum();
  log.end_frame(report, frame->index == 0);
  frame->breaks = std::exchange(log.breaks, {});
  return frame;
}

}  // namespace sunder
