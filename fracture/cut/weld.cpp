#include "fracture/cut/weld.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>
#include <vector>

#include "engine/geometry/clip.h"

namespace sunder::fracture {
namespace {

constexpr double kRelativeTolerance = 1e-9;  // Relative tolerance of volumes and areas.
constexpr double kVolumeRounding = 5e-13;    // No volume is gained or lost but by rounding.
constexpr double kDistanceRounding = 1e-13;  // Rounding of distances, over the farthest coordinate.

bool is_near(double value, double expected, double tolerance = kRelativeTolerance) {
  return std::abs(value - expected) <= tolerance * expected;
}

bool has_face(const ConvexPolyhedron& polyhedron, PlaneId id) {
  return std::ranges::any_of(polyhedron.faces, [&](const auto& face) { return face.id == id; });
}

/// Clips a cell by the planes of the parts' faces that have all parts on one side.
ConvexPolyhedron clipped_cell(ConvexPolyhedron cell, std::span<const ConvexPtr> parts) {
  ConvexPolyhedron next;
  ClipScratch scratch;
  Box box;
  for (const ConvexPtr& part : parts) box.extend(part->box);
  const double tolerance_m =
      kDistanceRounding * std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
  const auto is_inside = [&](const Plane& plane) {
    return std::ranges::all_of(parts, [&](const ConvexPtr& part) {
      return std::ranges::all_of(part->polyhedron.vertices, [&](const Vec3& vertex) {
        return plane.distance(vertex) <= tolerance_m;
      });
    });
  };
  for (const ConvexPtr& part : parts) {
    for (const ConvexPolyhedron::Face& face : part->polyhedron.faces) {
      if (face.id.none() || has_face(cell, face.id) || !is_inside(face.plane)) continue;
      if (clip(cell, face.plane, face.id, tolerance_m, next, scratch) == PlaneSide::kCut)
        std::swap(cell, next);
    }
  }
  return cell;
}

/// Gives a face of `whole` the kind and the shading of the parts' faces in it; returns the area of
/// these, or nothing if there are none, or some of another kind.
std::optional<double> merge_face(std::span<const ConvexPtr> parts, ConvexPolyhedron::Face& face,
                                 ConvexPolyhedron& whole) {
  std::optional<FaceKind> kind;
  double area_m2 = 0;
  std::vector<double> nearest(face.corner_count, std::numeric_limits<double>::infinity());
  for (const ConvexPtr& part : parts) {
    const ConvexPolyhedron& of = part->polyhedron;
    for (std::size_t f = 0; f < of.faces.size(); ++f) {
      if (of.faces[f].id != face.id) continue;
      if (kind.value_or(of.faces[f].kind) != of.faces[f].kind) return {};
      kind = of.faces[f].kind;
      area_m2 += face_area(of, f);
      for (std::uint32_t c = 0; c < face.corner_count; ++c) {
        const std::uint32_t corner = face.first_corner + c;
        for (std::uint32_t k = 0; k < of.faces[f].corner_count; ++k) {
          const std::uint32_t other = of.faces[f].first_corner + k;
          const double square =
              (whole.vertices[whole.corners[corner]] - of.vertices[of.corners[other]])
                  .squaredNorm();
          if (square >= nearest[c]) continue;
          nearest[c] = square;
          whole.corner_normals[corner] = of.corner_normals[other];
        }
      }
    }
  }
  if (!kind) return {};
  face.kind = *kind;
  return area_m2;
}

/// Gives the faces of `whole` the kind and the shading of the parts' faces in them. Returns false
/// unless these cover all of them.
bool merge_faces(std::span<const ConvexPtr> parts, std::span<const Ghost> ghosts,
                 ConvexPolyhedron& whole) {
  double area_m2 = 0, covered_m2 = 0;
  for (std::size_t f = 0; f < whole.faces.size(); ++f) {
    const std::optional<double> of_parts_m2 = merge_face(parts, whole.faces[f], whole);
    if (!of_parts_m2) return false;
    covered_m2 += *of_parts_m2;
    area_m2 += face_area(whole, f);
  }
  for (const Ghost& ghost : ghosts) {
    const ConvexPolyhedron& of = ghost.convex->polyhedron;
    for (std::size_t f = 0; f < of.faces.size(); ++f)
      if (has_face(whole, of.faces[f].id)) covered_m2 += ghost.sign * face_area(of, f);
  }
  return is_near(covered_m2, area_m2);
}

}  // namespace

ConvexPtr weld(const AlignedPattern& pattern, const AlignedPattern::Cell& cell,
               std::span<const ConvexPtr> parts, std::span<const Ghost> ghosts) {
  double volume_m3 = 0;
  for (const ConvexPtr& part : parts) {
    if (!part->is_internal() || part->material != parts[0]->material ||
        !(part->X_RT == parts[0]->X_RT))
      return nullptr;
    volume_m3 += part->solid.volume_m3;
  }
  for (const Ghost& ghost : ghosts) volume_m3 += ghost.sign * ghost.convex->solid.volume_m3;
  ConvexPolyhedron whole = pattern.polyhedron(cell);
  if (!is_near(volume_m3, cell.volume)) {
    whole = clipped_cell(std::move(whole), parts);
    if (!is_near(volume_m3, mass_properties(whole).volume_m3, kVolumeRounding)) return nullptr;
  }
  if (!merge_faces(parts, ghosts, whole)) return nullptr;
  // Passes a copy, without the memory that clip() reserves.
  return make_convex(whole, parts[0]->material, nullptr, parts[0]->X_RT);
}

}  // namespace sunder::fracture
