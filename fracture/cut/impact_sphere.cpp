#include "fracture/cut/impact_sphere.h"

#include <algorithm>
#include <limits>

#include "engine/geometry/box_distance.h"
#include "fracture/cut/convex_distance.h"

namespace sunder::fracture {

bool ImpactSphere::is_infinite() const {
  return radius_m == std::numeric_limits<double>::infinity();
}

bool ImpactSphere::is_unbreakable(MaterialIndex material) const {
  return std::find(unbreakable.begin(), unbreakable.end(), material) != unbreakable.end();
}

bool ImpactSphere::touches(const Convex& convex) const {
  if (is_unbreakable(convex.material)) return false;
  if (is_infinite()) return true;
  return squared_distance(convex.box, center_R) <= radius_m * radius_m &&
         distance(center_R, convex.polyhedron) <= radius_m;
}

bool ImpactSphere::is_small_and_held(const Structure& structure, ConvexSlot slot) const {
  if (!(structure.convex(slot)->solid.volume_m3 < smallest_m3)) return false;
  return std::ranges::any_of(structure.ghost_indices(slot), [&](std::uint32_t ghost) {
    return std::ranges::any_of(structure.ghost(ghost).of, [&](std::uint32_t of) {
      return is_unbreakable(structure.convex(ConvexSlot(of))->material);
    });
  });
}

std::vector<ConvexSlot> ImpactSphere::touched(const Structure& structure) const {
  std::vector<ConvexSlot> slots = structure.within(center_R, radius_m);
  std::erase_if(slots, [&](ConvexSlot slot) {
    return !touches(*structure.convex(slot)) || is_small_and_held(structure, slot);
  });
  return slots;
}

}  // namespace sunder::fracture
