// Stage `snapshot`: the frame as it stands, for the sinks.
#include <utility>

#include "engine/base/parallel.h"
#include "engine/world/actors/actors.h"

namespace sunder {
namespace {

constexpr std::size_t kBodiesAChunk = 64, kParticlesAChunk = 4096;

FrameBody body_of(const World& world, const Actor& actor) {
  const BodyState state = world.physics->state(actor.body);
  return {
      actor.key,       state.X_WB,  actor.weight.com_R, state.velocity_W, state.angular_velocity_W,
      actor.is_static, state.asleep};
}

void count(const World& world, const Actor& actor, const FrameBody& body, FrameReport& report) {
  report.mass_kg += actor.weight.mass_kg;
  report.counts.convexes += actor.structure.size();
  if (!actor.structure.empty()) ++report.counts.compounds;
  if (body.is_static) return;
  ++report.counts.bodies;
  if (!body.asleep) ++report.counts.awake;
  const Vec3 spin_B = body.X_WB.rotation.conjugate() * body.angular_velocity_W;
  report.kinetic_J += 0.5 * actor.weight.mass_kg * body.velocity_W.squaredNorm() +
                      0.5 * spin_B.dot(actor.weight.inertia_R * spin_B);
  report.potential_J -= actor.weight.mass_kg * world.scene.gravity_W.dot(body.X_WB.position);
}

/// What a chunk of actors adds to the frame.
struct Part {
  std::vector<Instance> instances;
  FrameReport report;
};

void add(const Part& part, Frame& frame) {
  frame.instances.insert(frame.instances.end(), part.instances.begin(), part.instances.end());
  FrameReport& report = frame.report;
  report.mass_kg += part.report.mass_kg;
  report.kinetic_J += part.report.kinetic_J;
  report.potential_J += part.report.potential_J;
  report.counts.convexes += part.report.counts.convexes;
  report.counts.compounds += part.report.counts.compounds;
  report.counts.bodies += part.report.counts.bodies;
  report.counts.awake += part.report.counts.awake;
}

/// By several threads, as it is mostly waiting for memory; sums are those of fixed chunks.
void add_bodies(const World& world, Frame& frame) {
  const std::size_t count_all = world.actors.size();
  frame.bodies.resize(count_all);
  std::vector<Part> parts((count_all + kBodiesAChunk - 1) / kBodiesAChunk);
  for_chunks(count_all, kBodiesAChunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
    Part& part = parts[c];
    for (std::size_t i = begin; i < end; ++i) {
      const Actor& actor = world.actors[i];
      frame.bodies[i] = body_of(world, actor);
      for (const MeshIndex mesh : actor.meshes) {
        if (!mesh.none()) part.instances.push_back({mesh, static_cast<std::uint32_t>(i)});
      }
      count(world, actor, frame.bodies[i], part.report);
    }
  });
  for (const Part& part : parts) add(part, frame);
}

/// Debris and dust as they are, and what there was no room for.
void add_particles(World& world, Frame& frame) {
  if (!world.particles) return;
  const DebrisView debris = world.particles->debris();
  frame.debris.resize(debris.position_W.size());
  for_chunks(frame.debris.size(), kParticlesAChunk,
             [&](std::size_t begin, std::size_t end, std::size_t) {
               for (std::size_t i = begin; i < end; ++i) {
                 frame.debris[i] = {debris.position_W[i], debris.rotation_WD[i], debris.radius_m[i],
                                    debris.material[i], debris.variant[i]};
               }
             });
  const DustView dust = world.particles->dust();
  frame.dust.resize(dust.position_W.size());
  for (std::size_t i = 0; i < frame.dust.size(); ++i) {
    frame.dust[i] = {dust.position_W[i], dust.rotation_WD[i], dust.radius_m[i], dust.opacity[i],
                     dust.material[i]};
  }
  frame.report.counts.debris = static_cast<std::uint32_t>(frame.debris.size());
  frame.report.counts.dust = static_cast<std::uint32_t>(frame.dust.size());
  const ParticleReport report = world.particles->report();
  const std::uint64_t ignored = report.debris.ignored + report.dust.ignored;
  if (ignored > std::exchange(world.particles_ignored, ignored)) ++frame.report.limits_hit;
}

}  // namespace

std::shared_ptr<Frame> snapshot(World& world) {
  draw(world);
  auto frame = std::make_shared<Frame>();
  frame->index = world.frame;
  frame->time_s = world.time_s();
  frame->view = world.scene.view;
  frame->view.ground_m = world.scene.ground.height_m;
  frame->materials = world.materials;
  frame->meshes = world.meshes;
  world.meshes_published = true;
  frame->report = std::exchange(world.report, {});
  FrameReport& report = frame->report;
  add_bodies(world, *frame);
  add_particles(world, *frame);
  report.mass_kg += world.debris_mass_kg + world.removed_mass_kg;
  for (std::size_t i = world.next_shot; i < world.scene.shots.size(); ++i) {
    const Shot& shot = world.scene.shots[i];
    report.mass_kg += ball_mass_kg(world, shot.ball);
    for (const Solid& link : shot.links)
      report.mass_kg += weigh(link.compound, *world.materials).mass_kg;
  }
  report.penetrations_m = world.physics->penetrations();
  report.carried_over =
      static_cast<std::uint32_t>(world.waiting.size()) + world.trials_waiting + world.loads_waiting;
  report.momentum_residual =
      world.momentum_moved_Ns > 0 ? world.momentum_error_Ns / world.momentum_moved_Ns : 0;
  world.momentum_error_Ns = world.momentum_moved_Ns = 0;
  frame->breaks = std::exchange(world.breaks, {});
  return frame;
}

}  // namespace sunder
