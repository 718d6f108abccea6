// Stage `particles`: debris and dust come off what breaks laid bare, and move among the bodies.
//
// Read first: particle_stage(). Particles move once a frame, whatever the step, as they are for
// the eye; what breaks within a frame is noted as if it had been there from the frame's start.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/parallel.h"
#include "engine/geometry/triangulate_face.h"
#include "engine/world/actors/actors.h"

namespace sunder {
namespace {

double radius_of_ball_m(double volume_m3) {
  return std::cbrt(volume_m3 * 3 / (4 * std::numbers::pi));
}

/// How much of the frame has passed before this step.
double elapsed_s(const World& world) {
  return static_cast<double>(world.step % static_cast<std::uint64_t>(world.steps_per_frame)) *
         world.scene.accuracy.dt_s;
}

/// A face where it was when the frame began, moving as it does now; a face of what is gone again
/// moves as the solid did that it came off.
Emission emission_of(World& world, const Exposed::Face& face, std::span<const Vec3> corners_R,
                     std::vector<Vec3>& corners_W) {
  const Exposed::Parent& parent = world.exposed.parents[face.parent];
  Pose X_WR = parent.X_WR;
  Emission emission;
  emission.motion = parent.motion;
  emission.parting_m_s = 0;
  emission.material = face.material;
  emission.crumbling = world.material(face.material).crumbling;
  double back_s = parent.back_s;
  if (const Actor* owner = world.find(face.owner_key)) {
    const BodyState now = world.physics->state(owner->body);
    const Vec3 was_W = parent.X_WR * corners_R[0];
    X_WR = {now.X_WB * Vec3(-owner->weight.com_R), now.X_WB.rotation};
    emission.motion = {now.X_WB.position, now.velocity_W, now.angular_velocity_W};
    const Vec3 velocity_W = emission.motion(X_WR * corners_R[0]);
    emission.parting_m_s = (velocity_W - parent.motion(was_W)).norm();
    back_s = world.steps_per_frame * world.scene.accuracy.dt_s;
  }
  emission.normal_W = X_WR.rotation * face.normal_R;
  for (const Vec3& corner_R : corners_R) {
    const Vec3 corner_W = X_WR * corner_R;
    corners_W.push_back(corner_W - back_s * emission.motion(corner_W));
  }
  emission.motion.at_W -= back_s * emission.motion.velocity_W;
  return emission;
}

void emit(World& world) {
  Exposed& crumbs = world.exposed;
  std::vector<Emission> emissions;
  std::vector<Vec3> corners_W;
  corners_W.reserve(crumbs.corners_R.size());  // spans into it stay
  std::size_t begin = 0;
  for (const Exposed::Face& face : crumbs.faces) {
    const std::size_t count = face.corners_end - begin;
    const std::span<const Vec3> corners_R = std::span(crumbs.corners_R).subspan(begin, count);
    emissions.push_back(emission_of(world, face, corners_R, corners_W));
    emissions.back().corners_W = std::span(corners_W).subspan(begin, count);
    begin = face.corners_end;
  }
  if (!emissions.empty()) world.particles->emit(emissions);
  if (!crumbs.chips.empty()) world.particles->emit(crumbs.chips);
  crumbs = {};
}

/// All bodies as they stand, with the convexes they consist of.
struct Surroundings {
  std::vector<ObstacleBody> bodies;
  std::vector<ObstacleShape> shapes;
};

/// By several threads, as it is mostly waiting for memory.
Surroundings surroundings(const World& world) {
  constexpr std::size_t kChunk = 64;
  const std::size_t count = world.actors.size();
  std::vector<std::size_t> first(count + 1);
  for (std::size_t i = 0; i < count; ++i) {
    first[i + 1] = first[i] + std::max(1u, world.actors[i].structure.size());
  }
  Surroundings all{std::vector<ObstacleBody>(count), std::vector<ObstacleShape>(first[count])};
  for_chunks(count, kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const Actor& actor = world.actors[i];
      const BodyState state = world.physics->state(actor.body);
      all.bodies[i] = {actor.key,
                       actor.edits,
                       state.X_WB,
                       actor.weight.com_R,
                       state.velocity_W,
                       state.angular_velocity_W,
                       !actor.is_static && !state.asleep};
      const auto body = static_cast<std::uint32_t>(i);
      ObstacleShape* shape = &all.shapes[first[i]];
      actor.structure.for_each([&](std::uint32_t, const Convex& convex) {
        *shape++ = {body, &convex.polyhedron, convex.box, convex.solid.volume_m3, 0};
      });
      if (actor.structure.empty()) {
        *shape = {body, nullptr, {}, 0, radius_of_ball_m(actor.volume_m3)};
      }
    }
  });
  return all;
}

/// Calls `use` with the corners of convex polygons that make up what a convex shows in a face: the
/// face, or triangles of its visual mesh's cap there, which is often less.
template <class Use>
void for_polygons(const Convex& convex, std::uint32_t face, const Use& use) {
  const ConvexPolyhedron& hull = convex.polyhedron;
  std::vector<Vec3> polygon;
  if (convex.is_internal()) {
    for (const std::uint32_t v : hull.face_corners(face)) polygon.push_back(hull.vertices[v]);
    use(polygon);
    return;
  }
  const PolygonMesh& visual = *convex.visual;
  for (std::size_t f = first_cap(visual); f < visual.faces.size(); ++f) {
    if (visual.faces[f].id != hull.faces[face].id) continue;
    for (const Triangle& triangle : triangulate(visual, f)) {
      polygon.clear();
      for (const std::uint32_t c : triangle) polygon.push_back(visual.vertices[visual.corners[c]]);
      use(polygon);
    }
  }
}

}  // namespace

void crumble(World& world, const Structure& structure, const BreakEdit& edit, const Motion& before,
             std::span<const std::uint32_t> piece_keys) {
  if (!world.particles || edit.loose.exposed.empty()) return;
  Exposed& crumbs = world.exposed;
  crumbs.parents.push_back({before.X_WR,
                            {before.point_W, before.velocity_W, before.angular_velocity_W},
                            elapsed_s(world)});
  for (const ExposedFace& exposed : edit.loose.exposed) {
    const Convex& convex = edit.exposed_convex(structure, exposed);
    if (!(world.material(convex.material).crumbling.particles_per_m2 > 0)) continue;
    Exposed::Face face;
    face.parent = static_cast<std::uint32_t>(crumbs.parents.size() - 1);
    face.owner_key = piece_keys[exposed.piece];
    face.normal_R = convex.polyhedron.faces[exposed.face].plane.normal;
    face.material = convex.material;
    for_polygons(convex, exposed.face, [&](std::span<const Vec3> polygon_R) {
      crumbs.corners_R.insert(crumbs.corners_R.end(), polygon_R.begin(), polygon_R.end());
      face.corners_end = crumbs.corners_R.size();
      crumbs.faces.push_back(face);
    });
  }
}

void add_chip(World& world, const Compound& piece, const Motion& motion) {
  if (!world.particles) return;
  const Weight weight = weigh(piece, *world.materials);
  const Vec3 center_W = motion.X_WR * weight.com_R;
  const VelocityField field{motion.point_W, motion.velocity_W, motion.angular_velocity_W};
  const Vec3 velocity_W = field(center_W);
  world.exposed.chips.push_back({center_W - elapsed_s(world) * velocity_W,
                                 radius_of_ball_m(volume(piece)), velocity_W,
                                 motion.angular_velocity_W, piece.convexes[0]->material});
}

void particle_stage(World& world) {
  if (!world.particles) return;
  if ((world.step + 1) % static_cast<std::uint64_t>(world.steps_per_frame) != 0) return;
  emit(world);
  const ParticleReport report = world.particles->report();
  if (report.debris.alive == 0 && report.dust.alive == 0) return;
  const Surroundings all = surroundings(world);
  world.particles->advance(world.steps_per_frame * world.scene.accuracy.dt_s,
                           {all.bodies, all.shapes, world.scene.ground.height_m});
}

}  // namespace sunder
