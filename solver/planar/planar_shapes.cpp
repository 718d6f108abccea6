#include "solver/planar/planar_shapes.h"

#include <algorithm>
#include <cmath>

#include "engine/base/check.h"
#include "engine/geometry/prism.h"

namespace sunder::solver {
namespace {

// Tolerance for centres and normals off the plane, as a fraction of the radius or of unit length.
constexpr double kPlanarTolerance = 1e-6;
// Half the length of the edge of a half-space, in units; floats are not precise enough beyond.
constexpr float kHalfEdgeLength = 5000.f;

b2Vec2 centroid_of(const b2Vec2* points, int count) {
  b2Vec2 sum(0, 0);
  float area = 0;
  for (int i = 1; i + 1 < count; ++i) {
    const b2Vec2 a = points[i] - points[0], b = points[i + 1] - points[0];
    const float twice = b2Cross(a, b);
    area += twice;
    sum += (twice / 3) * (a + b);
  }
  return points[0] + (1 / area) * sum;
}

/// Makes a polygon without b2PolygonShape::Set(), which welds corners that are close in units.
std::unique_ptr<b2Shape> make_polygon(const std::vector<b2Vec2>& corners) {
  auto polygon = std::make_unique<b2PolygonShape>();
  polygon->m_count = static_cast<int32>(corners.size());
  for (std::size_t i = 0; i < corners.size(); ++i) {
    polygon->m_vertices[i] = corners[i];
    polygon->m_normals[i] = b2Cross(corners[(i + 1) % corners.size()] - corners[i], 1.f);
    polygon->m_normals[i].Normalize();
  }
  polygon->m_centroid = centroid_of(polygon->m_vertices, polygon->m_count);
  polygon->m_radius = kSkin;
  return polygon;
}

using ShapeList = std::vector<std::unique_ptr<b2Shape>>;

ShapeList make_polygons(const ConvexPolyhedron& hull, const Vec3& com_R, const Pose& X_WB,
                        const Plane2& plane) {
  const std::optional<ZPrism> prism =
      prism_along_z(hull, {X_WB.rotation * Vec3(-com_R), X_WB.rotation});
  if (!prism) throw InputError("is no prism along z");
  if (prism->low + X_WB.position.z() >= 0 || prism->high + X_WB.position.z() <= 0) {
    throw InputError("does not reach through the plane z = 0");
  }
  std::vector<b2Vec2> corners;
  for (const Vec2& corner : prism->outline) {
    corners.push_back(plane.units(Vec3(corner.x(), corner.y(), 0)));
  }
  ShapeList made;
  constexpr std::size_t kMost = b2_maxPolygonVertices;
  for (std::size_t first = 1; first + 1 < corners.size(); first += kMost - 2) {
    const std::size_t last = std::min(first + kMost - 2, corners.size() - 1);
    std::vector<b2Vec2> fan = {corners[0]};
    for (std::size_t i = first; i <= last; ++i) fan.push_back(corners[i]);
    made.push_back(make_polygon(fan));
  }
  return made;
}

ShapeList make_circle(const ShapeDesc& shape, const Vec3& com_R, const Pose& X_WB,
                      const Plane2& plane) {
  const Vec3 center = X_WB.rotation * (shape.center_R - com_R);
  if (std::abs(center.z() + X_WB.position.z()) > kPlanarTolerance * shape.radius_m) {
    throw InputError("is a sphere whose centre is off the plane z = 0");
  }
  auto circle = std::make_unique<b2CircleShape>();
  circle->m_p = plane.units(center);
  circle->m_radius = static_cast<float>(plane.units_per_m * shape.radius_m) + kSkin;
  ShapeList made;
  made.push_back(std::move(circle));
  return made;
}

ShapeList make_edge(const ShapeDesc& shape, const Vec3& com_R, const Pose& X_WB,
                    const Plane2& plane) {
  const Vec3 normal = X_WB.rotation * shape.normal_R.normalized();
  if (std::abs(normal.z()) > kPlanarTolerance)
    throw InputError("is a half-space that leans out of the plane");
  const b2Vec2 out(static_cast<float>(normal.x()), static_cast<float>(normal.y()));
  const Vec3 center = X_WB.rotation * (shape.center_R - com_R);
  const b2Vec2 foot = plane.units(normal.dot(center) * normal);
  const b2Vec2 along = kHalfEdgeLength * b2Vec2(-out.y, out.x);
  auto edge = std::make_unique<b2EdgeShape>();
  edge->SetOneSided(foot - 2 * along, foot - along, foot + along, foot + 2 * along);
  edge->m_radius = kSkin;
  ShapeList made;
  made.push_back(std::move(edge));
  return made;
}

}  // namespace

std::vector<std::unique_ptr<b2Shape>> planar_shapes(const ShapeDesc& shape, const Vec3& com_R,
                                                    const Pose& X_WB, const Plane2& plane) {
  switch (shape.kind) {
    case ShapeDesc::Kind::kHull:
      return make_polygons(*shape.hull, com_R, X_WB, plane);
    case ShapeDesc::Kind::kSphere:
      return make_circle(shape, com_R, X_WB, plane);
    default:
      return make_edge(shape, com_R, X_WB, plane);
  }
}

float width_of(const b2Shape& shape) {
  if (shape.m_type == b2Shape::e_circle) return 2 * shape.m_radius;
  float least = b2_maxFloat;
  if (shape.m_type != b2Shape::e_polygon) return least;
  const auto& polygon = static_cast<const b2PolygonShape&>(shape);
  for (int side = 0; side < polygon.m_count; ++side) {
    float width = 0;
    for (int i = 0; i < polygon.m_count; ++i) {
      const b2Vec2 off = polygon.m_vertices[side] - polygon.m_vertices[i];
      width = std::max(width, b2Dot(polygon.m_normals[side], off));
    }
    least = std::min(least, width);
  }
  return least;
}

}  // namespace sunder::solver
