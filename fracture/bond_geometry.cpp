#include "fracture/bond_geometry.h"

namespace sunder::fracture {
namespace {

/// Keeps the part of a flat polygon on the inner side of the edge from `p` to `q`, for an edge
/// that runs counter-clockwise about `normal`.
std::vector<Vec3> cut_by_edge(const std::vector<Vec3>& polygon, const Vec3& p, const Vec3& q,
                              const Vec3& normal) {
  const Vec3 inward = normal.cross(q - p);
  std::vector<Vec3> kept;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec3& from = polygon[i];
    const Vec3& to = polygon[(i + 1) % polygon.size()];
    const double a = inward.dot(from - p), b = inward.dot(to - p);
    if (a >= 0) kept.push_back(from);
    if ((a > 0 && b < 0) || (a < 0 && b > 0)) kept.push_back(from + a / (a - b) * (to - from));
  }
  return kept;
}

std::vector<Vec3> corners_of(const ConvexPolyhedron& polyhedron, std::uint32_t face) {
  std::vector<Vec3> corners;
  for (const std::uint32_t v : polyhedron.face_corners(face)) {
    corners.push_back(polyhedron.vertices[v]);
  }
  return corners;
}

/// Area, centroid and second moment as sums over the triangles of a fan.
void integrate(BondGeometry& bond) {
  const std::vector<Vec3>& corners = bond.corners_R;
  Vec3 moment = Vec3::Zero();
  for (const bool second : {false, true}) {
    for (std::size_t i = 2; i < corners.size(); ++i) {
      const Vec3 &a = corners[0], &b = corners[i - 1], &c = corners[i];
      const double area = 0.5 * (b - a).cross(c - a).dot(bond.normal_R);
      const Vec3 middle = (a + b + c) / 3;
      if (!second) {
        bond.area_m2 += area;
        moment += area * middle;
        continue;
      }
      // ∫ r rᵀ over a triangle = area/12 · (Σ vvᵀ + 9 m mᵀ), v its corners and m its middle.
      const Vec3& o = bond.centroid_R;
      const Vec3 m = middle - o;
      bond.second_moment += area / 12 *
                            ((a - o) * (a - o).transpose() + (b - o) * (b - o).transpose() +
                             (c - o) * (c - o).transpose() + 9 * m * m.transpose());
    }
    if (!second && bond.area_m2 > 0) bond.centroid_R = moment / bond.area_m2;
  }
}

}  // namespace

BondGeometry bond_geometry(const Compound& compound, const Bond& bond) {
  const ConvexPolyhedron& a = compound.convexes[bond.a]->polyhedron;
  const ConvexPolyhedron& b = compound.convexes[bond.b]->polyhedron;
  BondGeometry result;
  result.normal_R = a.faces[bond.face_a].plane.normal;
  result.corners_R = corners_of(a, bond.face_a);
  const std::vector<Vec3> other = corners_of(b, bond.face_b);
  for (std::size_t i = 0; i < other.size() && !result.corners_R.empty(); ++i) {
    // Seen along a's normal, the other face runs clockwise.
    result.corners_R = cut_by_edge(result.corners_R, other[(i + 1) % other.size()], other[i],
                                   result.normal_R);
  }
  integrate(result);
  return result;
}

}  // namespace sunder::fracture
