#include "fracture/check/audit.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/clip_mesh.h"
#include "engine/geometry/polygon_mesh.h"
#include "engine/io/mesh/export_model.h"
#include "fracture/adjacency/islands.h"

namespace sunder::fracture {
namespace {

/// Limit of the product of the corners of two visual meshes whose intersection is computed exactly.
constexpr std::size_t kMostWork = 20'000'000;
constexpr PlaneId kAnyId{2};

/// Returns the distance below which rounding errors dominate.
double tolerance_of(const Box& box) {
  return 4e-15 * std::max(box.min.cwiseAbs().maxCoeff(), box.max.cwiseAbs().maxCoeff());
}

/// Returns true if all of `b` lies beyond a face of `a`.
bool is_beyond_a_face(const ConvexPolyhedron& a, const ConvexPolyhedron& b, double tolerance) {
  return std::any_of(a.faces.begin(), a.faces.end(), [&](const ConvexPolyhedron::Face& face) {
    return std::all_of(b.vertices.begin(), b.vertices.end(), [&](const Vec3& vertex) {
      return face.plane.distance(vertex) >= -tolerance;
    });
  });
}

/// Clips meshes to half-spaces; a mesh becomes empty if nothing is left.
class MeshClipper {
 public:
  explicit MeshClipper(double tolerance) : tolerance_(tolerance) {}

  bool keep_inside(PolygonMesh& mesh, const Plane& plane) {
    const PlaneSide side = clip(mesh, plane, kAnyId, tolerance_, result_, scratch_);
    if (side == PlaneSide::kCut) std::swap(mesh, result_);
    if (side == PlaneSide::kOutside) mesh = {};
    return !mesh.empty();
  }
  void keep_inside(PolygonMesh& mesh, const ConvexPolyhedron& convex) {
    for (const ConvexPolyhedron::Face& face : convex.faces) {
      if (!keep_inside(mesh, face.plane)) return;
    }
  }

 private:
  double tolerance_;
  PolygonMesh result_;
  MeshClipScratch scratch_;
};

/// Returns the signed volume of the part of `solid` in the tetrahedron (apex, p, q, r).
double volume_within(const Vec3& apex, const Vec3& p, const Vec3& q, const Vec3& r,
                     const PolygonMesh& solid, MeshClipper& clipper) {
  const double signed6 = (p - apex).dot((q - apex).cross(r - apex));
  if (signed6 == 0) return 0;
  const std::array<Vec3, 4> corners = {apex, p, q, r};
  PolygonMesh left = solid;
  for (std::size_t i = 0; i < 4; ++i) {
    const Vec3 &u = corners[(i + 1) % 4], &v = corners[(i + 2) % 4], &w = corners[(i + 3) % 4];
    Vec3 normal = (v - u).cross(w - u).normalized();
    if (normal.dot(corners[i] - u) > 0) normal = -normal;
    if (!clipper.keep_inside(left, Plane::through(u, normal))) return 0;
  }
  return std::copysign(mass_properties(left).volume_m3, signed6);
}

/// Returns the volume of the intersection, exactly: `a` is a signed sum of tetrahedra, and so is
/// its intersection with `b`.
double common_solid(const PolygonMesh& a, const PolygonMesh& b, MeshClipper& clipper) {
  const Vec3 apex = a.vertices[a.corners[0]];
  double sum = 0;
  for (std::size_t k = 0; k < a.contours.size(); ++k) {
    const auto corners = a.contour_corners(k);
    for (std::size_t i = 2; i < corners.size(); ++i) {
      sum += volume_within(apex, a.vertices[corners[0]], a.vertices[corners[i - 1]],
                           a.vertices[corners[i]], b, clipper);
    }
  }
  return sum;
}

PolygonMesh surface_of(const Convex& convex) {
  return convex.visual ? *convex.visual : polygon_mesh(convex.polyhedron);
}

/// Returns the counts of each piece's exported surface. Sets `is_walled` to 1 for those with faces
/// between convexes.
std::vector<SurfaceAudit> surfaces_of(std::span<const Compound> pieces,
                                      std::vector<std::uint8_t>& is_walled) {
  std::vector<SurfaceAudit> surfaces(pieces.size());
  is_walled.assign(pieces.size(), 0);
  for_chunks(pieces.size(), 1, [&](std::size_t p, std::size_t, std::size_t) {
    bool has_walls = false;
    surfaces[p] = audit_surface(triangle_mesh(exported_surface(pieces[p], has_walls).mesh));
    is_walled[p] = has_walls ? 1 : 0;
  });
  return surfaces;
}

/// Returns true if three convexes overlap pairwise.
bool has_triple(std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs) {
  std::ranges::sort(pairs);
  const auto has = [&](std::uint32_t a, std::uint32_t b) {
    return std::ranges::binary_search(pairs, std::pair(std::min(a, b), std::max(a, b)));
  };
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    for (std::size_t j = i + 1; j < pairs.size() && pairs[j].first == pairs[i].first; ++j) {
      if (has(pairs[i].second, pairs[j].second)) return true;
    }
  }
  return false;
}

/// Sums the overlaps between convexes of different pieces.
void add_overlaps(std::span<const Compound> pieces, Audit& audit) {
  std::vector<Box> boxes;
  std::vector<std::pair<std::size_t, const Convex*>> convexes;
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    for (const ConvexPtr& convex : pieces[p].convexes) {
      convexes.emplace_back(p, convex.get());
      boxes.push_back(convex->box);
    }
  }
  const Bvh tree(boxes);
  std::vector<double> overlap(boxes.size(), 0);
  std::vector<std::uint8_t> exact(boxes.size(), 1);
  for_chunks(boxes.size(), 16, [&](std::size_t begin, std::size_t end, std::size_t) {
    std::vector<std::uint32_t> found;
    for (std::size_t i = begin; i < end; ++i) {
      found.clear();
      tree.overlaps(boxes[i], found);
      for (const std::uint32_t j : found) {
        if (j <= i || convexes[j].first == convexes[i].first) continue;
        bool sure = true;
        overlap[i] += common_volume(*convexes[i].second, *convexes[j].second, sure);
        exact[i] &= sure ? 1 : 0;
      }
    }
  });
  for (const double volume : overlap) audit.overlap_m3 += volume;
  audit.overlap_is_exact = std::find(exact.begin(), exact.end(), 0) == exact.end();
}

}  // namespace

double common_volume(const Convex& a, const Convex& b, bool& exact) {
  const double tolerance = std::max(tolerance_of(a.box), tolerance_of(b.box));
  if (is_beyond_a_face(a.polyhedron, b.polyhedron, 4 * tolerance)) return 0;
  if (is_beyond_a_face(b.polyhedron, a.polyhedron, 4 * tolerance)) return 0;
  MeshClipper clipper(tolerance);
  PolygonMesh part_a = surface_of(a);
  clipper.keep_inside(part_a, b.polyhedron);
  if (part_a.empty() || !b.visual) return mass_properties(part_a).volume_m3;
  PolygonMesh part_b = surface_of(b);
  clipper.keep_inside(part_b, a.polyhedron);
  if (part_b.empty() || !a.visual) return mass_properties(part_b).volume_m3;
  if (part_a.corners.size() * part_b.corners.size() > kMostWork) {
    exact = false;
    return std::min(mass_properties(part_a).volume_m3, mass_properties(part_b).volume_m3);
  }
  return common_solid(part_a, part_b, clipper);
}

std::optional<DoubleCountedVolume> double_counted_volume(const Compound& compound) {
  constexpr std::size_t kMostPairs = 2000;
  std::vector<const Ghost*> ghosts;
  for (const Ghost& ghost : compound.ghosts) {
    if (ghost.sign == 0 && ghost.of.size() == 2) ghosts.push_back(&ghost);
  }
  if (ghosts.size() > kMostPairs) return std::nullopt;
  std::vector<double> volume(ghosts.size());
  std::vector<std::uint8_t> exact_of(ghosts.size());
  for_chunks(ghosts.size(), 1, [&](std::size_t g, std::size_t, std::size_t) {
    bool exact = true;
    const std::vector<std::uint32_t>& of = ghosts[g]->of;
    // The volume is negative where a part is inside out.
    volume[g] =
        std::max(0.0, common_volume(*compound.convexes[of[0]], *compound.convexes[of[1]], exact));
    exact_of[g] = exact ? 1 : 0;
  });
  std::vector<std::pair<std::uint32_t, std::uint32_t>> pairs;
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    const std::vector<std::uint32_t>& of = ghosts[g]->of;
    if (volume[g] > 0) pairs.emplace_back(std::minmax(of[0], of[1]));
  }
  return DoubleCountedVolume{
      std::accumulate(volume.begin(), volume.end(), 0.0),
      std::find(exact_of.begin(), exact_of.end(), 0) == exact_of.end() && !has_triple(pairs)};
}

SurfaceAudit audit_surfaces(std::span<const Compound> pieces) {
  std::vector<std::uint8_t> is_walled;
  SurfaceAudit sum;
  for (const SurfaceAudit& surface : surfaces_of(pieces, is_walled)) sum += surface;
  return sum;
}

Audit audit(std::span<const Compound> pieces) {
  Audit audit;
  audit.pieces = pieces.size();
  std::vector<std::uint8_t> is_walled;
  const std::vector<SurfaceAudit> surfaces = surfaces_of(pieces, is_walled);
  double overlaps_m3 = 0;  // which the surfaces count more than once
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    const Compound& piece = pieces[p];
    audit.convexes += piece.convexes.size();
    audit.surface += surfaces[p];
    audit.walled_pieces += is_walled[p];
    audit.watertight_pieces += surfaces[p].is_sound() && !is_walled[p] ? 1 : 0;
    overlaps_m3 -= volume(piece);
    for (const ConvexPtr& convex : piece.convexes) {
      overlaps_m3 += convex->solid.volume_m3;
      audit.negative_volumes += convex->solid.volume_m3 > 0 ? 0 : 1;
    }
    const auto islands = find_islands(piece);
    if (!islands.empty()) audit.islands += *std::max_element(islands.begin(), islands.end()) + 1;
  }
  audit.volume_m3 = audit.surface.volume_m3 - overlaps_m3;
  add_overlaps(pieces, audit);
  return audit;
}

}  // namespace sunder::fracture
