#include "engine/world/actors/bearing.h"

namespace sunder {

LoadCase make_load_case(const World& world, const Actor& actor, const Quat& rotation_WB,
                        std::vector<Load>& loads) {
  for (const ConvexForce& press : actor.stress.pressing) {
    const Vec3& centroid = actor.structure.convex(press.convex)->solid.centroid;
    loads.push_back({press.convex, press.force_R, centroid, press.torque_R});
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

}  // namespace sunder
