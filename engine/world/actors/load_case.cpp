#include "engine/world/actors/load_case.h"

#include <algorithm>
#include <limits>
#include <span>

#include "engine/base/roots.h"

namespace sunder {
namespace {

/// Shift of a point towards the centroid of its convex, as a fraction of their distance, that moves
/// a point on a face to the inside.
constexpr double kInside = 1e-2;

/// Smallest thickness of a structure at a point in convex `slot`, along the axes of R; found among
/// the convexes within a radius that grows until it exceeds the thickness.
double local_thickness_m(const Structure& structure, ConvexSlot slot, const Vec3& point_R) {
  const Convex& convex = *structure.convex(slot);
  const Vec3 from_R = point_R + kInside * (convex.solid.centroid - point_R);
  double radius_m = 2 * cube_root(convex.solid.volume_m3);
  for (;; radius_m *= 2) {
    double least_m = std::numeric_limits<double>::infinity();
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 along = Vec3::Unit(axis);
      least_m = std::min(least_m, thickness_along(structure, from_R, along, radius_m) +
                                      thickness_along(structure, from_R, -along, radius_m));
    }
    if (least_m < radius_m || structure.within(from_R, radius_m).size() == structure.size())
      return least_m;
  }
}

/// Divides a wrench about `at_R` among convexes that move as one rigid block.
void add_as_block(const Structure& structure, std::span<const ConvexSlot> block, const Vec3& at_R,
                  const Vec3& force_R, const Vec3& torque_R, std::vector<AppliedForce>& loads) {
  MassProperties all;
  for (const ConvexSlot slot : block) all = all + structure.convex(slot)->solid;
  const Vec3 acceleration = force_R / all.volume_m3;
  const Vec3 turn = all.inertia().ldlt().solve(torque_R + (at_R - all.centroid).cross(force_R));
  for (const ConvexSlot slot : block) {
    const MassProperties& one = structure.convex(slot)->solid;
    loads.push_back({slot, one.volume_m3 * (acceleration + turn.cross(one.centroid - all.centroid)),
                     one.centroid, one.inertia() * turn});
  }
}

}  // namespace

LoadCase make_load_case(const WorldState& world, const Actor& actor, const Quat& rotation_WB,
                        std::vector<AppliedForce>& loads) {
  for (const AppliedForce& force : actor.stress.mean_forces) {
    const Vec3& centroid = actor.structure.convex(force.convex)->solid.centroid;
    loads.push_back({force.convex, force.force_N, centroid, force.torque_Nm});
  }
  LoadCase load;
  load.materials = *world.materials;
  load.loads = loads;
  load.gravity_R = rotation_WB.conjugate() * world.scene.gravity_W;
  load.spin_R = actor.stress.spin_R;
  load.memory = actor.stress.memory;
  load.hinged = world.joints.hinged_convexes(actor.key);
  return load;
}

void add_joint_load(const Structure& structure, const Vec3& at_R, const Vec3& force_R,
                    const Vec3& torque_R, std::vector<AppliedForce>& loads) {
  const ConvexSlot held = nearest(structure, at_R);
  if (torque_R.isZero()) {
    loads.push_back({held, force_R, at_R, torque_R});
    return;
  }
  std::vector<ConvexSlot> block =
      structure.within(at_R, 0.5 * local_thickness_m(structure, held, at_R));
  if (std::ranges::find(block, held) == block.end()) block = {held};
  add_as_block(structure, block, at_R, force_R, torque_R, loads);
}

}  // namespace sunder
