#include "fracture/stress/bond_geometry.h"

#include <algorithm>

#include "engine/base/state_checks.h"
#include "engine/geometry/polygon_mesh.h"
#include "fracture/stress/spring_math.h"

namespace sunder::fracture {
namespace {

/// Keeps the part of a flat polygon on the inner side of the edge from `p` to `q`, which runs
/// counter-clockwise about `normal`.
void cut_by_edge(const Vec3& p, const Vec3& q, const Vec3& normal, std::vector<Vec3>& polygon,
                 std::vector<Vec3>& kept) {
  const Vec3 inward = normal.cross(q - p);
  kept.clear();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& from = polygon[i];
    const Vec3& to = polygon[i + 1 < polygon.size() ? i + 1 : 0];
    const double a = inward.dot(from - p), b = inward.dot(to - p);
    if (a >= 0) kept.push_back(from);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) kept.push_back(from + a / (a - b) * (to - from));
  }
  polygon.swap(kept);
}

using CapContours = std::vector<std::vector<Vec3>>;

/// Calls `visit(area, a, b, c)` for triangles of the contours. Areas are signed, so that sums are
/// correct for concave polygons and for holes.
template <class Visit>
void for_triangles(const CapContours& contours, const Vec3& normal, const Visit& visit) {
  for (const std::vector<Vec3>& corners : contours) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const Vec3 &a = corners[0], &b = corners[i - 1], &c = corners[i];
      visit(0.5 * (b - a).cross(c - a).dot(normal), a, b, c);
    }
  }
}

/// Computes area, centroid and second moment as sums over triangles.
void integrate(const CapContours& contours, BondGeometry& bond) {
  Vec3 moment = Vec3::Zero();
  for_triangles(contours, bond.normal_R,
                [&](double area, const Vec3& a, const Vec3& b, const Vec3& c) {
                  bond.area_m2 += area;
                  moment += area / 3 * (a + b + c);
                });
  if (bond.area_m2 <= 0) return;
  bond.centroid_R = moment / bond.area_m2;
  // ∫ r rᵀ over a triangle is area/12 · (Σ vvᵀ + s sᵀ), v its corners and s their sum.
  for_triangles(
      contours, bond.normal_R, [&](double area, const Vec3& a, const Vec3& b, const Vec3& c) {
        const Vec3 u = a - bond.centroid_R, v = b - bond.centroid_R;
        const Vec3 w = c - bond.centroid_R, s = u + v + w;
        bond.second_moment +=
            area / 12 *
            (u * u.transpose() + v * v.transpose() + w * w.transpose() + s * s.transpose());
      });
  for (const std::vector<Vec3>& corners : contours) {
    for (const Vec3& corner : corners) {
      bond.reach_m = std::max(bond.reach_m, (corner - bond.centroid_R).norm());
    }
  }
}

/// Returns the cap of a convex's visual mesh in one of its faces; empty for an internal convex.
CapContours cap(const Convex& convex, std::uint32_t face) {
  CapContours contours;
  if (convex.is_internal()) return contours;
  const PolygonMesh& mesh = *convex.visual;
  const PlaneId id = convex.polyhedron.faces[face].id;
  for (std::size_t f = first_cap(mesh); f < mesh.faces.size(); ++f) {
    if (mesh.faces[f].id != id) continue;
    for (std::uint32_t k = 0; k < mesh.faces[f].contour_count; ++k) {
      std::vector<Vec3>& contour = contours.emplace_back();
      for (const std::uint32_t v : mesh.contour_corners(mesh.faces[f].first_contour + k)) {
        contour.push_back(mesh.vertices[v]);
      }
    }
  }
  return contours;
}

double area_of(const CapContours& contours, const Vec3& normal) {
  double sum = 0;
  for_triangles(contours, normal,
                [&](double area, const Vec3&, const Vec3&, const Vec3&) { sum += area; });
  return sum;
}

/// Returns the smaller cap of a bond's convexes, seen against a's normal; empty if both are
/// internal.
CapContours smaller_cap(const Compound& compound, const Bond& bond) {
  const Vec3& normal = compound.convexes[bond.a]->polyhedron.faces[bond.face_a].plane.normal;
  CapContours a = cap(*compound.convexes[bond.a], bond.face_a);
  CapContours b = cap(*compound.convexes[bond.b], bond.face_b);
  for (std::vector<Vec3>& contour : b) std::reverse(contour.begin(), contour.end());
  if (a.empty()) return b;
  return b.empty() || area_of(a, normal) <= area_of(b, normal) ? a : b;
}

/// Returns the overlap of the two faces of a bond.
std::vector<Vec3> common_polygon(const Compound& compound, const Bond& bond) {
  const ConvexPolyhedron& a = compound.convexes[bond.a]->polyhedron;
  const ConvexPolyhedron& b = compound.convexes[bond.b]->polyhedron;
  std::vector<Vec3> polygon, scratch;
  for (const std::uint32_t v : a.face_corners(bond.face_a)) polygon.push_back(a.vertices[v]);
  const auto other = b.face_corners(bond.face_b);
  for (std::size_t i = 0; i < other.size() && !polygon.empty(); ++i) {
    // Seen along a's normal, the other face runs clockwise.
    const std::size_t next = i + 1 < other.size() ? i + 1 : 0;
    cut_by_edge(b.vertices[other[next]], b.vertices[other[i]], a.faces[bond.face_a].plane.normal,
                polygon, scratch);
  }
  return polygon;
}

}  // namespace

std::vector<Vec3> bond_corners(const Compound& compound, const Bond& bond) {
  std::vector<Vec3> corners;
  for (const std::vector<Vec3>& contour : smaller_cap(compound, bond)) {
    corners.insert(corners.end(), contour.begin(), contour.end());
  }
  return corners.empty() ? common_polygon(compound, bond) : corners;
}

const char* BondGeometry::wrong_field() const {
  if (!is_within(centroid_R, kMostShape_m)) return "centroid_R";
  if (!is_unit(normal_R)) return "normal_R";
  if (!is_bounded(area_m2, kMostShape_m)) return "area_m2";
  if (!is_semidefinite(second_moment, kMostShape_m)) return "second_moment";
  return is_bounded(reach_m, kMostShape_m) ? nullptr : "reach_m";
}

BondGeometry bond_geometry(const Compound& compound, const Bond& bond) {
  BondGeometry result;
  result.normal_R = compound.convexes[bond.a]->polyhedron.faces[bond.face_a].plane.normal;
  const CapContours contours = smaller_cap(compound, bond);
  if (contours.empty()) {
    integrate({common_polygon(compound, bond)}, result);
    return result;
  }
  integrate(contours, result);
  if (!(result.area_m2 > 0)) return result;
  result.second_moment *= bond.area_m2 / result.area_m2;
  result.area_m2 = bond.area_m2;
  return result;
}

}  // namespace sunder::fracture
