#include "fracture/pattern/pattern.h"

#include <filesystem>
#include <fstream>

#include "engine/base/check.h"
#include "engine/base/random.h"
#include "engine/geometry/clip.h"
#include "engine/io/bytes.h"

namespace sunder::fracture {

Plane plane_parallel_to_y(const Vec2& a, const Vec2& b) {
  const Vec2 along = (b - a).normalized();
  return Plane::through(Vec3(a.x(), 0, a.y()), Vec3(along.y(), 0, -along.x()));
}

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

ConvexPolyhedron cut_cell(const std::vector<Plane>& planes, std::span<const PlaneId> sides) {
  ConvexPolyhedron cell = pattern_box(), cut;
  ClipScratch scratch;
  for (const PlaneId id : sides) {
    const Plane& stored = planes[plane_index(id)];
    const Plane plane = plane_flipped(id) ? stored.flipped() : stored;
    const PlaneSide side = clip(cell, plane, id, 1e-14 * Pattern::kHalfExtent, cut, scratch);
    if (side == PlaneSide::kOutside) return {};
    if (side == PlaneSide::kCut) std::swap(cell, cut);
  }
  return cell;
}

std::uint32_t add_outer_cells(Pattern& pattern, const Box& inner) {
  const auto first = static_cast<std::uint32_t>(pattern.planes.size());
  for (int axis = 0; axis < 3; ++axis) {
    pattern.planes.push_back({Vec3::Unit(axis), -inner.max[axis]});
    pattern.planes.push_back({-Vec3::Unit(axis), inner.min[axis]});
  }
  std::vector<PlaneId> sides;
  for (std::uint32_t i = 0; i < 6; ++i) {
    sides.push_back(pattern_plane(first + i, true));
    ConvexPolyhedron cell = cut_cell(pattern.planes, sides);
    if (!cell.empty()) pattern.cells.push_back({std::move(cell), 0, 0, true});
    sides.back() = pattern_plane(first + i, false);
  }
  return first;
}

void join_colors(Pattern& pattern, int count, std::uint64_t seed) {
  std::vector<Cell*> inner;
  std::vector<Vec3> centers;
  for (Cell& cell : pattern.cells) {
    if (cell.outer) continue;
    inner.push_back(&cell);
    centers.push_back(mass_properties(cell.polyhedron).centroid);
  }
  if (count <= 0 || inner.size() <= static_cast<std::size_t>(count)) return;
  Random random(seed, 4);
  std::vector<Vec3> seeds;
  for (int i = 0; i < count; ++i) {
    seeds.push_back(centers[random.below(static_cast<std::uint32_t>(centers.size()))]);
  }
  for (std::size_t i = 0; i < inner.size(); ++i) {
    std::uint32_t nearest = 0;
    for (std::uint32_t s = 1; s < seeds.size(); ++s) {
      const double gain = (seeds[nearest] - centers[i]).norm() - (seeds[s] - centers[i]).norm();
      if (gain > 0) nearest = s;
    }
    inner[i]->color = nearest;
  }
  auto next = static_cast<std::uint32_t>(count);
  for (Cell& cell : pattern.cells) {
    if (cell.outer) cell.color = next++;
  }
}

namespace {

Pattern make_cells(const PatternSpec& spec, const PatternScale& scale, std::uint64_t seed) {
  switch (spec.kind) {
    case PatternSpec::Kind::kVoronoi:
      return voronoi_pattern(spec.cells, spec.falloff, scale.whole, seed);
    case PatternSpec::Kind::kWeb:
      return web_pattern(spec.rings, spec.spokes, spec.jitter, seed);
    case PatternSpec::Kind::kRadial:
      return web_pattern(1, spec.cells, spec.jitter, seed);
    case PatternSpec::Kind::kBrick:
      return brick_pattern(spec.brick_m / scale.unit_m);
    case PatternSpec::Kind::kSlabs:
      return slab_pattern(spec.cells, spec.jitter, seed);
    case PatternSpec::Kind::kGrid:
      return grid_pattern(spec.cells);
    case PatternSpec::Kind::kFile: {
      std::error_code error;
      check_file_size(spec.file, file_kinds::kPattern);
      std::ifstream file(spec.file);
      if (!file || !std::filesystem::is_regular_file(spec.file, error))
        throw InputError(spec.file + ": cannot be read; give the path of an .obj file");
      return read_pattern(file, spec.file);
    }
    case PatternSpec::Kind::kNone:
      break;
  }
  throw InputError("a material without a pattern cannot be broken");
}

}  // namespace

Pattern make_pattern(const PatternSpec& spec, const PatternScale& scale, std::uint64_t seed) {
  Pattern pattern = make_cells(spec, scale, seed);
  join_colors(pattern, spec.colors, seed);
  return pattern;
}

}  // namespace sunder::fracture
