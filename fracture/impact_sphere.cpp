#include "fracture/impact_sphere.h"

#include <limits>

#include "fracture/polygon.h"

namespace sunder::fracture {
namespace {

double distance_to_box(const Vec3& point, const Box& box) {
  return (box.min - point).cwiseMax(point - box.max).cwiseMax(0.0).norm();
}

}  // namespace

bool ImpactSphere::is_endless() const {
  return radius_m == std::numeric_limits<double>::infinity();
}

bool ImpactSphere::touches(const Convex& convex) const {
  if (is_endless()) return true;
  return distance_to_box(center_R, convex.box) <= radius_m &&
         distance(center_R, convex.polyhedron) <= radius_m;
}

std::vector<std::uint32_t> ImpactSphere::touched(const Structure& structure) const {
  std::vector<std::uint32_t> slots = structure.within(center_R, radius_m);
  std::erase_if(slots, [&](std::uint32_t slot) { return !touches(*structure.convex(slot)); });
  return slots;
}

}  // namespace sunder::fracture
