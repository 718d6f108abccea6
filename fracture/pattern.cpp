#include "fracture/pattern.h"

#include "engine/base/check.h"

namespace sunder::fracture {

std::vector<Plane> box_planes() {
  std::vector<Plane> planes;
  for (int axis = 0; axis < 3; ++axis) {
    planes.push_back({Vec3::Unit(axis), -Pattern::kHalfExtent});
    planes.push_back({-Vec3::Unit(axis), -Pattern::kHalfExtent});
  }
  return planes;
}

ConvexPolyhedron pattern_box() {
  ConvexPolyhedron box =
      make_box(Vec3::Constant(-Pattern::kHalfExtent), Vec3::Constant(Pattern::kHalfExtent));
  const std::vector<Plane> planes = box_planes();
  for (ConvexPolyhedron::Face& face : box.faces) {
    face.kind = FaceKind::kInterior;
    for (std::uint32_t i = 0; i < planes.size(); ++i) {
      if (face.plane.normal.dot(planes[i].normal) > 0.5) face.id = pattern_plane(i, false);
    }
  }
  return box;
}

void finish(Pattern& pattern) {
  std::vector<Box> boxes;
  for (std::uint32_t i = 0; i < pattern.cells.size(); ++i) {
    Cell& cell = pattern.cells[i];
    cell.volume = mass_properties(cell.polyhedron).volume_m3;
    cell.color = i;
    boxes.push_back(bounds(cell.polyhedron));
  }
  pattern.tree = Bvh(boxes);
}

Pattern make_pattern(const PatternSpec& spec, double /*radius_m*/, std::uint64_t seed) {
  switch (spec.kind) {
    case PatternSpec::Kind::kWeb:
      return web_pattern(spec.rings, spec.spokes, spec.jitter, seed);
    case PatternSpec::Kind::kVoronoi:
      return voronoi_pattern(spec.cells, spec.falloff, seed);
    case PatternSpec::Kind::kNone:
      break;
  }
  throw InputError("a material without a pattern cannot be broken");
}

}  // namespace sunder::fracture
