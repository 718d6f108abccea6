#include "fracture/pattern/align.h"

#include <algorithm>

#include "engine/base/check.h"
#include "engine/base/hash.h"

namespace sunder::fracture {
namespace {

/// Returns the bounding box, in P, of a box in R.
Box box_in_pattern(const Box& box_R, const AlignedPattern& aligned) {
  const Vec3 center = aligned.P_of_R * (box_R.center() - aligned.placement.origin_R);
  const Vec3 half = aligned.P_of_R.cwiseAbs() * (0.5 * box_R.extent());
  return {center - half, center + half};
}

}  // namespace

Plane AlignedPattern::plane(PlaneId pattern_id) const {
  const Plane& stored = planes[plane_index(pattern_id)];
  return plane_flipped(pattern_id) ? stored.flipped() : stored;
}

PlaneId AlignedPattern::name(PlaneId pattern_id) const {
  const std::uint64_t key = combine(event, plane_index(pattern_id)) | 2;  // Never 0.
  return {(key & ~std::uint64_t{1}) | (plane_flipped(pattern_id) ? 1 : 0)};
}

void AlignedPattern::overlapping(const Box& box_R, std::vector<std::uint32_t>& found) const {
  found.clear();
  std::vector<std::uint32_t> indices;
  pattern->tree.overlaps(box_in_pattern(box_R, *this), indices);
  std::size_t at = 0;
  for (const std::uint32_t index : indices) {
    while (at < cells.size() && cells[at].index < index) ++at;
    if (at == cells.size()) break;
    if (cells[at].index == index && cells[at].box.overlaps(box_R)) {
      found.push_back(static_cast<std::uint32_t>(at));
    }
  }
}

ConvexPolyhedron AlignedPattern::polyhedron(const Cell& cell) const {
  ConvexPolyhedron result = pattern->cells[cell.index].polyhedron;
  const std::span<const Vec3> moved = cell_vertices(cell);
  std::copy(moved.begin(), moved.end(), result.vertices.begin());
  for (ConvexPolyhedron::Face& face : result.faces) {
    face.plane = plane(face.id);
    face.id = name(face.id);
    const Vec3f normal = face.plane.normal.cast<float>();
    std::fill_n(result.corner_normals.begin() + face.first_corner, face.corner_count, normal);
  }
  return result;
}

AlignedPattern align(const Pattern& pattern, const Placement& placement, std::uint64_t event,
                     const Box& interest_R) {
  AlignedPattern aligned;
  aligned.pattern = &pattern;
  aligned.event = event;
  aligned.placement = placement;
  const double determinant = placement.linear.determinant();
  SUNDER_CHECK(determinant > 0);
  aligned.P_of_R = placement.linear.inverse();
  aligned.planes.reserve(pattern.planes.size());
  for (const Plane& plane : pattern.planes) {
    const Vec3 normal = aligned.P_of_R.transpose() * plane.normal;
    const double length = normal.norm();
    const Vec3 unit = normal / length;
    aligned.planes.push_back({unit, plane.d / length - unit.dot(placement.origin_R)});
  }
  std::vector<std::uint32_t> indices;
  pattern.tree.overlaps(box_in_pattern(interest_R, aligned), indices);
  for (const std::uint32_t index : indices) {
    const Cell& cell = pattern.cells[index];
    AlignedPattern::Cell moved{index, {}, cell.volume * determinant, 0, 0};
    moved.first_vertex = static_cast<std::uint32_t>(aligned.vertices.size());
    moved.vertex_count = static_cast<std::uint32_t>(cell.polyhedron.vertices.size());
    for (const Vec3& vertex_P : cell.polyhedron.vertices) {
      aligned.vertices.push_back(placement * vertex_P);
      moved.box.extend(aligned.vertices.back());
    }
    aligned.cells.push_back(moved);
  }
  return aligned;
}

}  // namespace sunder::fracture
