#include "fracture/cut/impact_sphere.h"

#include <algorithm>
#include <limits>

#include "engine/geometry/box_distance.h"
#include "fracture/cut/convex_distance.h"

namespace sunder::fracture {

bool ImpactSphere::is_endless() const {
  return radius_m == std::numeric_limits<double>::infinity();
}

bool ImpactSphere::spares(MaterialIndex material) const {
  return std::find(spared.begin(), spared.end(), material) != spared.end();
}

bool ImpactSphere::touches(const Convex& convex) const {
  if (spares(convex.material)) return false;
  if (is_endless()) return true;
  return squared_distance(convex.box, center_R) <= radius_m * radius_m &&
         distance(center_R, convex.polyhedron) <= radius_m;
}

std::vector<ConvexSlot> ImpactSphere::touched(const Structure& structure) const {
  std::vector<ConvexSlot> slots = structure.within(center_R, radius_m);
  std::erase_if(slots, [&](ConvexSlot slot) { return !touches(*structure.convex(slot)); });
  return slots;
}

}  // namespace sunder::fracture
