#include "engine/world/particles/particle_stage.h"

#include <algorithm>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/rotation.h"
#include "engine/base/state_checks.h"

namespace sunder {
namespace {

constexpr std::size_t kBodiesInChunk = 64, kDebrisInChunk = 4096;

/// Returns the emission of a face at its position at the start of the frame, with its current
/// motion. If the actor with the face is gone, the face moves as the broken solid did.
ExposedPolygon emission_of(const WorldState& world, const BodyStates& states,
                           const Exposed::Parent& parent, const Exposed::Face& face,
                           std::span<const Vec3> corners_R, std::vector<Vec3>& corners_W) {
  Pose X_WR = parent.motion.X_WR;
  ExposedPolygon emission;
  emission.motion = parent.motion.field;
  emission.opening_speed_m_s = 0;
  emission.material = face.material;
  emission.crumbling = world.material(face.material).crumbling;
  double back_s = parent.since_frame_start_s;
  if (const Actor* owner = world.actors.find(face.owner_key)) {
    const Motion now = motion_of(*owner, states[owner->body]);
    const Vec3 was_W = parent.motion.X_WR * corners_R[0];
    X_WR = now.X_WR;
    emission.motion = now.field;
    const Vec3 velocity_W = emission.motion(X_WR * corners_R[0]);
    emission.opening_speed_m_s = (velocity_W - parent.motion.field(was_W)).norm();
    back_s = world.clock.frame_s();
  }
  // Rotation is undone too, as the corners of a spinning face must stay together.
  VelocityField& motion = emission.motion;
  const Mat3 turn(rotation_by(-back_s * motion.angular_velocity_W));
  const Vec3 was_at_W = motion.at_W - back_s * motion.velocity_W;
  emission.normal_W = turn * (X_WR.rotation * face.normal_R);
  for (const Vec3& corner_R : corners_R)
    corners_W.push_back(was_at_W + turn * (X_WR * corner_R - motion.at_W));
  motion.at_W = was_at_W;
  return emission;
}

void emit(const WorldState& world, const Exposed& exposed, Particles& particles) {
  const BodyStates states = world.physics->states();
  std::vector<ExposedPolygon> emissions;
  std::vector<Vec3> corners_W;
  corners_W.reserve(exposed.corners_R.size());  // spans into it must stay valid
  std::size_t begin = 0;
  for (const Exposed::Face& face : exposed.faces) {
    const std::size_t count = face.corners_end - begin;
    const std::span<const Vec3> corners_R = std::span(exposed.corners_R).subspan(begin, count);
    emissions.push_back(
        emission_of(world, states, exposed.parents[face.parent], face, corners_R, corners_W));
    emissions.back().corners_W = std::span(corners_W).subspan(begin, count);
    begin = face.corners_end;
  }
  if (!emissions.empty()) particles.emit(emissions);
  if (!exposed.chips.empty()) particles.emit(exposed.chips);
}

/// All bodies with their convexes.
struct Surroundings {
  std::vector<ObstacleBody> bodies;
  std::vector<ObstacleShape> shapes;
};

/// Adds the ground's meshes as the last body.
void add_landscape(const WorldState& world, Surroundings& all) {
  const std::vector<ObstacleShape>& obstacles = world.landscape.obstacles;
  if (obstacles.empty()) return;
  const std::size_t first = all.shapes.size() - obstacles.size();
  const auto body = static_cast<std::uint32_t>(all.bodies.size());
  all.bodies.emplace_back().key = kGroundKey;
  for (std::size_t i = 0; i < obstacles.size(); ++i) {
    all.shapes[first + i] = obstacles[i];
    all.shapes[first + i].body = body;
  }
}

/// Returns all bodies; made in parallel, as the work is bound by memory.
Surroundings surroundings(const WorldState& world) {
  const BodyStates states = world.physics->states();
  const std::size_t count = world.actors.size();
  std::vector<std::size_t> first(count + 1);
  for (std::size_t i = 0; i < count; ++i) {
    first[i + 1] = first[i] + std::max(1u, world.actors[i].structure.size());
  }
  Surroundings all{std::vector<ObstacleBody>(count),
                   std::vector<ObstacleShape>(first[count] + world.landscape.obstacles.size())};
  for_chunks(count, kBodiesInChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Actor& actor = world.actors[i];
      const BodyState state = states[actor.body];
      all.bodies[i] = {actor.key,
                       actor.edits,
                       state.X_WB,
                       actor.weight.com_R,
                       state.velocity_W,
                       state.angular_velocity_W,
                       (!actor.is_static || actor.is_kinematic) && !state.asleep};
      const auto body = static_cast<std::uint32_t>(i);
      ObstacleShape* shape = &all.shapes[first[i]];
      actor.structure.for_each([&](ConvexSlot, const Convex& convex) {
        *shape++ = {body, &convex.polyhedron, convex.box, convex.solid.volume_m3};
      });
      if (actor.structure.empty()) {
        *shape = {body, nullptr, {}, 0, ball_radius_m(actor.volume_m3)};
      }
    }
  });
  add_landscape(world, all);
  return all;
}

}  // namespace

const char* ParticleStage::wrong_field(const WorldState& world) const {
  if (!particles_) return nullptr;
  const std::size_t materials = world.materials->size();
  return all_below(particles_->debris().material, materials) &&
                 all_below(particles_->dust().material, materials)
             ? nullptr
             : "particles_";
}

void ParticleStage::run(const WorldState& world, const Exposed& exposed) {
  emit(world, exposed, *particles_);
  const ParticleReport report = particles_->report();
  if (report.debris.alive == 0 && report.dust.alive == 0) return;
  const Surroundings all = surroundings(world);
  particles_->advance(world.clock.frame_s(), {all.bodies, all.shapes, world.scene.ground.height_m});
}

void ParticleStage::show(Frame& frame) {
  if (!particles_) return;
  const DebrisView debris = particles_->debris();
  frame.debris.resize(debris.position_W.size());
  for_chunks(frame.debris.size(), kDebrisInChunk,
             [&](std::size_t begin, std::size_t end, std::size_t) {
               for (std::size_t i = begin; i < end; ++i) {
                 frame.debris[i] = {debris.position_W[i], debris.rotation_WD[i], debris.radius_m[i],
                                    debris.material[i], debris.variant[i]};
               }
             });
  const DustView dust = particles_->dust();
  frame.dust.resize(dust.position_W.size());
  for (std::size_t i = 0; i < frame.dust.size(); ++i) {
    frame.dust[i] = {dust.position_W[i], dust.rotation_WD[i], dust.radius_m[i], dust.opacity[i],
                     dust.material[i]};
  }
  frame.report.counts.debris = static_cast<std::uint32_t>(frame.debris.size());
  frame.report.counts.dust = static_cast<std::uint32_t>(frame.dust.size());
  const ParticleReport report = particles_->report();
  LimitsHit& limits = frame.report.limits;
  if (report.debris.ignored > std::exchange(ignored_debris_, report.debris.ignored))
    ++limits[Limit::kDebris];
  if (report.dust.ignored > std::exchange(ignored_dust_, report.dust.ignored))
    ++limits[Limit::kDust];
}

}  // namespace sunder
