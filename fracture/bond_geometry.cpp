#include "fracture/bond_geometry.h"

#include <algorithm>

namespace sunder::fracture {
namespace {

/// Keeps the part of a flat polygon on the inner side of the edge from `p` to `q`, for an edge
/// that runs counter-clockwise about `normal`.
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

/// Area, centroid and second moment as sums over the triangles of a fan.
void integrate(std::span<const Vec3> corners, BondGeometry& bond) {
  Vec3 moment = Vec3::Zero();
  const auto each = [&](auto&& visit) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const Vec3 &a = corners[0], &b = corners[i - 1], &c = corners[i];
      visit(0.5 * (b - a).cross(c - a).dot(bond.normal_R), a, b, c);
    }
  };
  each([&](double area, const Vec3& a, const Vec3& b, const Vec3& c) {
    bond.area_m2 += area;
    moment += area / 3 * (a + b + c);
  });
  if (bond.area_m2 <= 0) return;
  bond.centroid_R = moment / bond.area_m2;
  // ∫ r rᵀ over a triangle is area/12 · (Σ vvᵀ + s sᵀ), v its corners and s their sum.
  each([&](double area, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 u = a - bond.centroid_R, v = b - bond.centroid_R, w = c - bond.centroid_R;
    const Vec3 s = u + v + w;
    bond.second_moment +=
        area / 12 * (u * u.transpose() + v * v.transpose() + w * w.transpose() + s * s.transpose());
  });
  for (const Vec3& corner : corners) {
    bond.reach_m = std::max(bond.reach_m, (corner - bond.centroid_R).norm());
  }
}

}  // namespace

std::vector<Vec3> bond_corners(const Compound& compound, const Bond& bond) {
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

BondGeometry bond_geometry(const Compound& compound, const Bond& bond) {
  BondGeometry result;
  result.normal_R = compound.convexes[bond.a]->polyhedron.faces[bond.face_a].plane.normal;
  integrate(bond_corners(compound, bond), result);
  return result;
}

}  // namespace sunder::fracture
