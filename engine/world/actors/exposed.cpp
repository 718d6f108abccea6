#include "engine/world/actors/exposed.h"

#include "engine/geometry/triangulate_face.h"
#include "engine/world/actors/world_state.h"

namespace sunder {
namespace {

/// Calls `use` with the corners of convex polygons that cover the visible part of a convex's face:
/// the face, or the triangles of its visual mesh's cap, which may be smaller.
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

void Exposed::delay(double time_s) {
  for (Parent& parent : parents) parent.since_frame_start_s -= time_s;
  for (DebrisPiece& chip : chips) chip.center_W += time_s * chip.velocity_W;
}

void note_exposed(WorldState& world, const Structure& structure, const BreakEdit& edit,
                  const Motion& before, std::span<const std::uint32_t> piece_keys) {
  if (!world.exposed || edit.loose.exposed.empty()) return;
  Exposed& all = *world.exposed;
  all.parents.push_back({before, world.clock.elapsed_s()});
  for (const ExposedFace& exposed : edit.loose.exposed) {
    const Convex& convex = edit.exposed_convex(structure, exposed);
    if (!(world.material(exposed.material).crumbling.particles_per_m2 > 0)) continue;
    Exposed::Face face;
    face.parent = static_cast<std::uint32_t>(all.parents.size() - 1);
    face.owner_key = piece_keys[exposed.piece];
    face.normal_R = convex.polyhedron.faces[exposed.face].plane.normal;
    face.material = exposed.material;
    for_polygons(convex, exposed.face, [&](std::span<const Vec3> polygon_R) {
      all.corners_R.insert(all.corners_R.end(), polygon_R.begin(), polygon_R.end());
      face.corners_end = all.corners_R.size();
      all.faces.push_back(face);
    });
  }
}

void note_chip(WorldState& world, const Compound& piece, const Motion& motion) {
  if (!world.exposed) return;
  const CompoundMass weight = mass_of(piece, *world.materials);
  const Vec3 center_W = motion.X_WR * weight.com_R;
  const Vec3 velocity_W = motion.field(center_W);
  world.exposed->chips.push_back({center_W - world.clock.elapsed_s() * velocity_W,
                                  ball_radius_m(volume(piece)), velocity_W,
                                  motion.field.angular_velocity_W, piece.convexes[0]->material});
}

}  // namespace sunder
