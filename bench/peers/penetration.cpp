#include "bench/peers/penetration.h"

#include <algorithm>
#include <limits>

namespace sunder::bench {
namespace {

/// A hull at its pose in the world.
struct Placed {
  std::vector<Vec3> vertices, normals, edges;
  Box box;
};

Placed place(const BodyDesc& desc, const Pose& X_WB) {
  const ConvexPolyhedron& hull = *desc.shapes[0].hull;
  Placed placed;
  for (const Vec3& vertex : hull.vertices) {
    placed.vertices.push_back(X_WB * (vertex - desc.com_R));
    placed.box.extend(placed.vertices.back());
  }
  for (std::size_t f = 0; f < hull.faces.size(); ++f) {
    placed.normals.push_back(X_WB.rotation * hull.faces[f].plane.normal);
    const auto corners = hull.face_corners(f);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t from = corners[i], to = corners[(i + 1) % corners.size()];
      if (from < to) placed.edges.push_back(placed.vertices[to] - placed.vertices[from]);
    }
  }
  return placed;
}

std::pair<double, double> extent(const Placed& placed, const Vec3& axis) {
  double low = std::numeric_limits<double>::max(), high = -low;
  for (const Vec3& vertex : placed.vertices) {
    const double along = axis.dot(vertex);
    low = std::min(low, along), high = std::max(high, along);
  }
  return {low, high};
}

/// Returns the least separating translation, in m; not positive if the hulls do not overlap.
double depth_of(const Placed& a, const Placed& b) {
  double least = std::numeric_limits<double>::max();
  const auto overlaps = [&](const Vec3& axis) {
    const auto [a_low, a_high] = extent(a, axis);
    const auto [b_low, b_high] = extent(b, axis);
    least = std::min({least, a_high - b_low, b_high - a_low});
    return least > 0;
  };
  for (const Placed* placed : {&a, &b})
    for (const Vec3& normal : placed->normals)
      if (!overlaps(normal)) return 0;
  for (const Vec3& edge_a : a.edges) {
    for (const Vec3& edge_b : b.edges) {
      const Vec3 axis = edge_a.cross(edge_b);
      if (axis.squaredNorm() < 1e-12 * edge_a.squaredNorm() * edge_b.squaredNorm()) continue;
      if (!overlaps(axis.normalized())) return 0;
    }
  }
  return least;
}

}  // namespace

std::vector<double> penetrations(std::span<const BodyDesc> bodies, std::span<const Pose> X_WBs) {
  std::vector<Placed> placed;
  std::vector<double> depths;
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    if (bodies[i].shapes[0].kind == ShapeDesc::Kind::kHull && X_WBs[i].position.allFinite())
      placed.push_back(place(bodies[i], X_WBs[i]));
  }
  for (const BodyDesc& desc : bodies) {
    const ShapeDesc& plane = desc.shapes[0];
    if (plane.kind != ShapeDesc::Kind::kHalfSpace) continue;
    const double d = plane.normal_R.dot(desc.X_WB * (plane.center_R - desc.com_R));
    for (const Placed& piece : placed) {
      const double depth = d - extent(piece, plane.normal_R).first;
      if (depth > 0) depths.push_back(depth);
    }
  }
  std::sort(placed.begin(), placed.end(),
            [](const Placed& a, const Placed& b) { return a.box.min.x() < b.box.min.x(); });
  for (std::size_t i = 0; i < placed.size(); ++i) {
    for (std::size_t j = i + 1; j < placed.size(); ++j) {
      if (placed[j].box.min.x() > placed[i].box.max.x()) break;
      if (!placed[i].box.overlaps(placed[j].box)) continue;
      const double depth = depth_of(placed[i], placed[j]);
      if (depth > 0) depths.push_back(depth);
    }
  }
  return depths;
}

}  // namespace sunder::bench
