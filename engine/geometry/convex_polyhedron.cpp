#include "engine/geometry/convex_polyhedron.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/state_checks.h"
#include "engine/geometry/double_area.h"
#include "engine/geometry/moments.h"

namespace sunder {
namespace {

/// Shades the n sides of a prism, faces 2 to n + 1, as one round surface.
void smooth_sides(ConvexPolyhedron& prism, std::uint32_t n) {
  for (std::uint32_t i = 0; i < n; ++i) {
    const ConvexPolyhedron::Face& here = prism.faces[2 + i];
    const ConvexPolyhedron::Face& next = prism.faces[2 + (i + 1) % n];
    const Vec3f normal = (here.plane.normal + next.plane.normal).normalized().cast<float>();
    for (const std::uint32_t corner :
         {here.first_corner + 1, here.first_corner + 2, next.first_corner, next.first_corner + 3}) {
      prism.corner_normals[corner] = normal;
    }
  }
}

}  // namespace

void add_face(ConvexPolyhedron& convex, std::span<const std::uint32_t> corners) {
  ConvexPolyhedron::Face& face = convex.faces.emplace_back();
  face.first_corner = static_cast<std::uint32_t>(convex.corners.size());
  face.corner_count = static_cast<std::uint32_t>(corners.size());
  convex.corners.insert(convex.corners.end(), corners.begin(), corners.end());
  const Vec3 normal = double_area(convex.vertices, corners).normalized();
  double offset = 0;
  for (const std::uint32_t v : corners) offset += normal.dot(convex.vertices[v]);
  face.plane = {normal, -offset / static_cast<double>(corners.size())};
  convex.corner_normals.resize(convex.corners.size(), normal.cast<float>());
}

Box bounds(const ConvexPolyhedron& convex) {
  Box box;
  for (const Vec3& v : convex.vertices) box.extend(v);
  return box;
}

double face_area(const ConvexPolyhedron& convex, std::size_t face) {
  return 0.5 * double_area(convex.vertices, convex.face_corners(face)).norm();
}

MassProperties mass_properties(const ConvexPolyhedron& convex) {
  if (convex.empty()) return {};
  // With a vertex as origin, all tetrahedra have non-negative volume.
  const Vec3 origin = convex.vertices[convex.corners[0]];
  Moments moments(origin);
  for (const ConvexPolyhedron::Face& face : convex.faces) {
    const std::uint32_t* corner = convex.corners.data() + face.first_corner;
    const Vec3 a = convex.vertices[corner[0]] - origin;
    Vec3 c = convex.vertices[corner[1]] - origin;
    for (std::uint32_t i = 2; i < face.corner_count; ++i) {
      const Vec3 b = c;
      c = convex.vertices[corner[i]] - origin;
      moments.add(a, b, c);
    }
  }
  return moments.sum();
}

ConvexPolyhedron make_box(const Vec3& min, const Vec3& max) {
  if (!(min.array() < max.array()).all() || !min.allFinite() || !max.allFinite())
    throw InputError("box: min must be less than max along each axis, and both must be finite");
  ConvexPolyhedron box;
  for (int i = 0; i < 8; ++i) {  // bit k of the index is set for max along axis k
    box.vertices.emplace_back(i & 1 ? max.x() : min.x(), i & 2 ? max.y() : min.y(),
                              i & 4 ? max.z() : min.z());
  }
  constexpr std::uint32_t kFaces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4},
                                          {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& corners : kFaces) add_face(box, corners);
  for (std::size_t axis = 0; axis < 3; ++axis) {  // exact planes: -x +x -y +y -z +z
    const Vec3 out = Vec3::Unit(static_cast<Eigen::Index>(axis));
    box.faces[2 * axis].plane = Plane::through(min, -out);
    box.faces[2 * axis + 1].plane = Plane::through(max, out);
  }
  return box;
}

ConvexPolyhedron make_prism(std::span<const Vec2> polygon_xz, double bottom, double top,
                            bool smooth) {
  if (polygon_xz.size() < 3 || !(bottom < top))
    throw InputError(
        "prism: the polygon must have at least three corners, and bottom must be less than top");
  const auto n = static_cast<std::uint32_t>(polygon_xz.size());
  ConvexPolyhedron prism;
  for (const double y : {bottom, top}) {
    for (const Vec2& p : polygon_xz) prism.vertices.emplace_back(p.x(), y, p.y());
  }
  std::vector<std::uint32_t> cap(n);
  std::iota(cap.begin(), cap.end(), n);
  add_face(prism, cap);
  if (!(prism.faces[0].plane.normal.y() > 0))
    throw InputError("prism: the polygon is clockwise as seen from +y; reverse its corners");
  for (std::uint32_t i = 0; i < n; ++i) cap[i] = n - 1 - i;
  add_face(prism, cap);
  for (std::uint32_t i = 0; i < n; ++i) {
    const std::uint32_t next = (i + 1) % n;
    add_face(prism, std::array{i, next, n + next, n + i});
  }
  if (smooth) smooth_sides(prism, n);
  return prism;
}

ConvexPolyhedron transformed(const ConvexPolyhedron& convex, const Pose& X_RQ) {
  ConvexPolyhedron moved = convex;
  const Mat3 rotation = X_RQ.rotation.toRotationMatrix();
  const Mat3f rotation_f = rotation.cast<float>();
  for (Vec3& v : moved.vertices) v = rotation * v + X_RQ.position;
  for (Vec3f& n : moved.corner_normals) n = rotation_f * n;
  for (ConvexPolyhedron::Face& face : moved.faces) {
    face.plane.normal = rotation * face.plane.normal;
    face.plane.d -= face.plane.normal.dot(X_RQ.position);
  }
  return moved;
}

const char* ConvexPolyhedron::wrong_field() const {
  if (!all_below(corners, vertices.size())) return "corners";
  if (corner_normals.size() != corners.size()) return "corner_normals";
  for (const Face& face : faces) {
    if (face.first_corner > corners.size() || face.corner_count < 3 ||
        face.corner_count > corners.size() - face.first_corner)
      return "faces";
    if (!(std::abs(face.plane.normal.squaredNorm() - 1) < 1e-6)) return "faces";
  }
  return empty() || is_closed(*this) ? nullptr : "faces";
}

bool is_closed(const ConvexPolyhedron& convex) {
  using Edge = std::pair<std::uint32_t, std::uint32_t>;
  std::vector<Edge> edges;
  std::vector<std::size_t> last_face(convex.vertices.size(), convex.faces.size());
  for (std::size_t f = 0; f < convex.faces.size(); ++f) {
    const auto corners = convex.face_corners(f);
    if (corners.size() < 3) return false;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t v = corners[i];
      if (v >= last_face.size() || last_face[v] == f) return false;
      last_face[v] = f;
      edges.emplace_back(v, corners[(i + 1) % corners.size()]);
    }
  }
  if (std::count(last_face.begin(), last_face.end(), convex.faces.size()) > 0) return false;
  std::sort(edges.begin(), edges.end());
  if (std::adjacent_find(edges.begin(), edges.end()) != edges.end()) return false;
  for (const auto& [from, to] : edges) {
    if (!std::binary_search(edges.begin(), edges.end(), Edge(to, from))) return false;
  }
  return convex.vertices.size() + convex.faces.size() == edges.size() / 2 + 2;
}

}  // namespace sunder
