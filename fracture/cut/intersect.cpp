#include "fracture/cut/intersect.h"

#include <utility>

#include "fracture/cut/cutter.h"
#include "fracture/cut/surface.h"

namespace sunder::fracture {
namespace {

Intersection intersect_internal(const AlignedPattern& pattern, const ConvexPtr& convex) {
  Cutter cutter(pattern, convex);
  Intersection result;
  result.failed = !cutter.cut(cutter.min_part_m3(convex->solid.volume_m3));
  if (result.failed) {
    result.parts.push_back({cutter.largest_cell(), convex});
    return result;
  }
  result.debris_volume_m3 = cutter.debris_m3();
  for (Draft& draft : cutter.drafts()) {
    result.parts.push_back({draft.cell, std::move(draft.convex)});
  }
  return result;
}

}  // namespace

Intersection intersect(const AlignedPattern& pattern, const ConvexPtr& convex, const Fit& fit) {
  return convex->is_internal() ? intersect_internal(pattern, convex)
                               : intersect_surface(pattern, convex, fit);
}

}  // namespace sunder::fracture
