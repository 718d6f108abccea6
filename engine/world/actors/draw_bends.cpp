#include "engine/world/actors/draw_bends.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "engine/model/bent_section.h"
#include "engine/model/piece_mesh.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

bool has_moved(const Pose& from, const Pose& to, const Vec3& at, double reach_m) {
  const double turned = 2 * (to.rotation * from.rotation.conjugate()).vec().norm();
  return turned > kRedrawAngle_rad || (to * at - from * at).norm() > kRedrawSlide * reach_m;
}

/// Returns the hidden flags of a convex's faces from those of an earlier convex, matched by the
/// planes' names; new faces are visible.
std::vector<std::uint8_t> hidden_in(const Convex& now, const Convex& before,
                                    const std::vector<std::uint8_t>& hidden) {
  std::vector<std::uint8_t> flags;
  for (const ConvexPolyhedron::Face& face : now.polyhedron.faces) {
    const auto& faces = before.polyhedron.faces;
    const auto old = std::ranges::find(faces, face.id, &ConvexPolyhedron::Face::id);
    flags.push_back(old == faces.end() ? 0 : hidden[static_cast<std::size_t>(old - faces.begin())]);
  }
  return flags;
}

void draw(WorldState& world, Actor& actor, HingeSide& side, const BentSide& bent,
          const Plane& plane) {
  const std::vector<Ended> all = end_side(bent, plane, PlaneId{2});
  std::vector<ConvexPtr> before = std::exchange(side.redrawn, {});
  for (const Ended& ended : all) {
    const ConvexPtr& convex = actor.structure.convex(ended.slot);
    side.redrawn.push_back(convex);
    std::erase(before, convex);
    const std::vector<std::uint8_t>& hidden = actor.hidden[ended.slot.value];
    const auto mesh = ended.convex
                          ? make_mesh(*ended.convex, hidden_in(*ended.convex, *convex, hidden))
                          : nullptr;
    if (mesh) {
      world.meshes.override_mesh(actor, ended.slot, mesh);
    } else {
      world.meshes.hide(actor, ended.slot);
    }
  }
  if (before.empty()) return;
  actor.structure.for_each([&](ConvexSlot slot, const Convex&) {
    if (std::ranges::find(before, actor.structure.convex(slot)) != before.end())
      world.meshes.override_mesh(actor, slot, nullptr);
  });
}

void draw(WorldState& world, Joints::Live& joint) {
  Hinge& hinge = *joint.hinge;
  Actor &a = *world.actors.find(joint.a.key), &b = *world.actors.find(joint.b.key);
  const Pose X_AB = relative_rest(*world.physics, a, b);
  const SectionEnd end_a = hinge.end_a(), end_b = hinge.end_b();
  const double reach_m = hinge.reach_m();
  if (!has_moved(hinge.drawn_X_AB, X_AB, end_b.centroid, reach_m)) return;
  const BentSide side_a{a.structure, hinge.a.slots, hinge.a.faces, hinge.areas_m2, end_a, reach_m};
  const BentSide side_b{b.structure, hinge.b.slots, hinge.b.faces, hinge.areas_m2, end_b, reach_m};
  const std::optional<MeetingPlane> meeting = meeting_plane(side_a, side_b, X_AB);
  if (!meeting) return;
  hinge.drawn_X_AB = X_AB;
  if (meeting->ends_a) draw(world, a, hinge.a, side_a, meeting->planes.a);
  if (meeting->ends_b) draw(world, b, hinge.b, side_b, meeting->planes.b);
}

}  // namespace

void draw_bends(WorldState& world) {
  for (Joints::Live& joint : world.joints.live())
    if (joint.hinge) draw(world, joint);
}

}  // namespace sunder
