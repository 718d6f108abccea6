#include "scenes/file/moved_part.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <utility>

#include "engine/geometry/polygon_mesh.h"

namespace sunder::scenes {
namespace {

void mirror(Plane& plane) { plane.normal.x() = -plane.normal.x(); }

void mirror(std::vector<Vec3>& vertices, std::vector<Vec3f>& normals) {
  for (Vec3& v : vertices) v.x() = -v.x();
  for (Vec3f& n : normals) n.x() = -n.x();
}

/// Reverses the corners of a contour, so that the mirrored face still faces outward.
template <class Values>
void reverse_corners(Values& values, std::uint32_t first, std::uint32_t count) {
  if (!values.empty()) std::reverse(values.begin() + first, values.begin() + first + count);
}

std::shared_ptr<const PolygonMesh> mirrored_visual(const PolygonMesh& visual) {
  auto mesh = std::make_shared<PolygonMesh>(visual);
  mirror(mesh->vertices, mesh->corner_normals);
  for (PolygonMesh::Face& face : mesh->faces) mirror(face.plane);
  for (const PolygonMesh::Contour& contour : mesh->contours) {
    reverse_corners(mesh->corners, contour.first_corner, contour.corner_count);
    reverse_corners(mesh->corner_normals, contour.first_corner, contour.corner_count);
    reverse_corners(mesh->corner_uvs, contour.first_corner, contour.corner_count);
  }
  return mesh;
}

std::shared_ptr<const PolygonMesh> moved_visual(const PolygonMesh& visual, const Pose& X_FM) {
  auto mesh = std::make_shared<PolygonMesh>(visual);
  const Mat3 rotation = X_FM.rotation.toRotationMatrix();
  const Mat3f rotation_f = rotation.cast<float>();
  for (Vec3& v : mesh->vertices) v = rotation * v + X_FM.position;
  for (Vec3f& n : mesh->corner_normals) n = rotation_f * n;
  for (PolygonMesh::Face& face : mesh->faces) {
    face.plane.normal = rotation * face.plane.normal;
    face.plane.d -= face.plane.normal.dot(X_FM.position);
  }
  return mesh;
}

}  // namespace

std::vector<Part> parts_of(const Compound& compound) {
  std::vector<Part> parts;
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    const Convex& convex = *compound.convexes[c];
    parts.push_back({convex.polyhedron, convex.material, compound.anchored[c], convex.visual});
  }
  return parts;
}

Part mirrored(Part part) {
  ConvexPolyhedron& convex = part.polyhedron;
  mirror(convex.vertices, convex.corner_normals);
  for (ConvexPolyhedron::Face& face : convex.faces) {
    mirror(face.plane);
    reverse_corners(convex.corners, face.first_corner, face.corner_count);
    reverse_corners(convex.corner_normals, face.first_corner, face.corner_count);
  }
  if (part.visual) part.visual = mirrored_visual(*part.visual);
  const std::uint8_t low = anchor_side(0, false), high = anchor_side(0, true);
  const bool was_low = (part.anchored & low) != 0, was_high = (part.anchored & high) != 0;
  part.anchored = static_cast<std::uint8_t>((part.anchored & ~(low | high)) | (was_low ? high : 0) |
                                            (was_high ? low : 0));
  return part;
}

Part moved(Part part, const Pose& X_FM) {
  part.polyhedron = transformed(part.polyhedron, X_FM);
  if (part.visual) part.visual = moved_visual(*part.visual, X_FM);
  return part;
}

Part placed(Part part, const Copy& copy) {
  return moved(copy.mirrored ? mirrored(std::move(part)) : std::move(part), copy.X_FM);
}

}  // namespace sunder::scenes
