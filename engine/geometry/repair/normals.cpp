#include "engine/geometry/repair/normals.h"

#include "engine/base/trigonometry.h"
#include "engine/geometry/repair/clean.h"

namespace sunder {
namespace {

double angle_at(const Surface& surface, std::uint32_t corner) {
  const Vec3 a = surface.point(surface.next(corner)) - surface.point(corner);
  const Vec3 b = surface.point(surface.previous(corner)) - surface.point(corner);
  return arc_tangent(a.cross(b).norm(), a.dot(b));
}

/// Enumerates the fans of corners around vertices that are connected without a crease.
class Fans {
 public:
  Fans(const Surface& surface, double crease_cosine) : surface_(surface), crease_(crease_cosine) {
    for (std::size_t p = 0; p < surface.mesh.polygons.size(); ++p) {
      face_normals_.push_back(double_area(surface.mesh, p).normalized());
    }
  }

  const Vec3& face_normal(std::uint32_t corner) const {
    return face_normals_[surface_.polygon[corner]];
  }

  std::vector<Vec3f> normals() const {
    std::vector<Vec3f> result(surface_.twin.size(), Vec3f::Zero());
    std::vector<char> done(surface_.twin.size(), 0);
    std::vector<std::uint32_t> fan;
    for (std::uint32_t c = 0; c < surface_.twin.size(); ++c) {
      if (done[c]) continue;
      std::uint32_t first = c;
      for (std::uint32_t back = before(first); back != Surface::kNone && back != c;
           back = before(first)) {
        first = back;
      }
      fan.clear();
      Vec3 sum = Vec3::Zero();
      for (std::uint32_t at = first; at != Surface::kNone;) {
        fan.push_back(at);
        sum += angle_at(surface_, at) * face_normal(at);
        at = after(at);
        if (at == first) break;
      }
      for (const std::uint32_t at : fan) {
        done[at] = 1;
        const Vec3& normal = sum.norm() > 1e-9 ? sum : face_normal(at);
        result[at] = normal.normalized().cast<float>();
      }
    }
    return result;
  }

 private:
  /// Returns the corner at this vertex across the corner's half-edge; kNone if open or a crease.
  std::uint32_t before(std::uint32_t corner) const {
    const std::uint32_t back = surface_.twin[corner];
    return back == Surface::kNone ? back : unless_creased(corner, surface_.next(back));
  }
  /// Returns the corner at this vertex across the half-edge before it; kNone if open or a crease.
  std::uint32_t after(std::uint32_t corner) const {
    const std::uint32_t back = surface_.twin[surface_.previous(corner)];
    return back == Surface::kNone ? back : unless_creased(corner, back);
  }
  std::uint32_t unless_creased(std::uint32_t from, std::uint32_t to) const {
    return face_normal(from).dot(face_normal(to)) >= crease_ ? to : Surface::kNone;
  }

  const Surface& surface_;
  double crease_;
  std::vector<Vec3> face_normals_;
};

}  // namespace

std::vector<Vec3f> shading_normals(const Surface& surface, double crease_cosine) {
  const Fans fans(surface, crease_cosine);
  std::vector<Vec3f> normals = fans.normals();
  if (surface.mesh.corner_normals.empty()) return normals;
  for (const RawMesh::Polygon& polygon : surface.mesh.polygons) {
    const Vec3f face = fans.face_normal(polygon.first_corner).cast<float>();
    float agreement = 0;
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
      agreement += face.dot(surface.mesh.corner_normals[polygon.first_corner + i]);
    }
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
      const std::uint32_t c = polygon.first_corner + i;
      const Vec3f& given = surface.mesh.corner_normals[c];
      if (!(given.squaredNorm() > 1e-12f)) continue;
      normals[c] = (agreement < 0 ? Vec3f(-given) : given).normalized();
    }
  }
  return normals;
}

}  // namespace sunder
