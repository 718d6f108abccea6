// Contours that share a vertex belong to one shell. Shells are then joined if a contour of one is a
// hole in a contour of the other, or if one bounds a cavity in the other.
#include "engine/geometry/mesh_islands.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/disjoint_sets.h"
#include "engine/geometry/double_area.h"

namespace sunder {
namespace {

/// Returns ±1 if an edge crosses the ray from 0 along +u with growing or falling v; 0 if not.
int crossing_sign(double from_u, double from_v, double to_u, double to_v) {
  if ((from_v <= 0) == (to_v <= 0)) return 0;
  const double side = from_u * to_v - to_u * from_v;
  return from_v <= 0 ? (side > 0 ? 1 : 0) : (side < 0 ? -1 : 0);
}

/// Returns twice the signed area of a contour about its face's normal; negative for a hole.
double area_along(const PolygonMesh& mesh, std::uint32_t contour, const Vec3& normal) {
  return double_area(mesh.vertices, mesh.contour_corners(contour)).dot(normal);
}

/// A place where a line crosses an outline or a surface, and the change of the winding number
/// there.
struct Crossing {
  double along = 0;
  int sign = 0;
};

/// Returns the middle of the longest part of a line on which the winding number is not 0.
double middle_within(std::vector<Crossing> crossings) {
  std::ranges::stable_sort(crossings, {}, &Crossing::along);
  double longest = 0, middle = crossings.empty() ? 0 : crossings[0].along;
  int turns = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    turns += crossings[i].sign;
    const double length = crossings[i + 1].along - crossings[i].along;
    if (turns == 0 || length <= longest) continue;
    longest = length;
    middle = crossings[i].along + 0.5 * length;
  }
  return middle;
}

/// The contours of a face, projected along the largest component of its normal.
class ProjectedFace {
 public:
  ProjectedFace(const PolygonMesh& mesh, const PolygonMesh::Face& face) : mesh_(mesh) {
    int steepest = 0;
    face.plane.normal.cwiseAbs().maxCoeff(&steepest);
    u_ = (steepest + 1) % 3, v_ = (steepest + 2) % 3;
  }

  /// Returns true if a point, which is on no edge, lies within a contour.
  bool surrounds(std::uint32_t contour, const Vec2& point) const {
    int turns = 0;
    each_edge(contour, [&](const Vec2& from, const Vec2& to) {
      const Vec2 a = from - point, b = to - point;
      turns += crossing_sign(a.x(), a.y(), b.x(), b.y());
    });
    return turns != 0;
  }

  /// Returns a point within a contour, not on its edges, even if other contours touch these.
  Vec2 point_within(std::uint32_t contour) const {
    double steepest = 0, v = 0;
    each_edge(contour, [&](const Vec2& from, const Vec2& to) {
      if (std::abs(to.y() - from.y()) <= steepest) return;
      steepest = std::abs(to.y() - from.y());
      v = 0.5 * (from.y() + to.y());
    });
    std::vector<Crossing> crossings;
    each_edge(contour, [&](const Vec2& from, const Vec2& to) {
      if ((from.y() <= v) == (to.y() <= v)) return;
      const double share = (v - from.y()) / (to.y() - from.y());
      crossings.push_back({from.x() + share * (to.x() - from.x()), from.y() <= v ? 1 : -1});
    });
    return {middle_within(std::move(crossings)), v};
  }

 private:
  template <class Visit>
  void each_edge(std::uint32_t contour, const Visit& visit) const {
    const auto corners = mesh_.contour_corners(contour);
    const auto at = [&](std::size_t i) {
      const Vec3& vertex = mesh_.vertices[corners[i]];
      return Vec2(vertex[u_], vertex[v_]);
    };
    for (std::size_t i = 0, before = corners.size() - 1; i < corners.size(); before = i++)
      visit(at(before), at(i));
  }

  const PolygonMesh& mesh_;
  int u_ = 0, v_ = 0;
};

/// Calls `visit(a, b, c)` for each triangle of the fans of contours, relative to a point.
template <class Visit>
void each_triangle(const PolygonMesh& mesh, std::span<const std::uint32_t> contours,
                   const Vec3& point, const Visit& visit) {
  for (const std::uint32_t contour : contours) {
    const auto corners = mesh.contour_corners(contour);
    const Vec3 a = mesh.vertices[corners[0]] - point;
    for (std::size_t i = 2; i < corners.size(); ++i) {
      visit(a, Vec3(mesh.vertices[corners[i - 1]] - point),
            Vec3(mesh.vertices[corners[i]] - point));
    }
  }
}

/// Returns how often a triangle is crossed by the line along x through the origin.
int crossings_of(const Vec3& a, const Vec3& b, const Vec3& c) {
  return crossing_sign(a.y(), a.z(), b.y(), b.z()) + crossing_sign(b.y(), b.z(), c.y(), c.z()) +
         crossing_sign(c.y(), c.z(), a.y(), a.z());
}

/// Returns the winding number of contours around a point: the number of surfaces by which a ray
/// along x leaves, less the number by which it enters.
int winding_number(const PolygonMesh& mesh, std::span<const std::uint32_t> contours,
                   const Vec3& point) {
  int sum = 0;
  each_triangle(mesh, contours, point, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const int turns = crossings_of(a, b, c);
    if (turns != 0 && turns * a.dot(b.cross(c)) > 0) sum += turns;
  });
  return sum;
}

/// Returns a point inside a shell, not on it, even if other shells touch it.
Vec3 point_within(const PolygonMesh& mesh, std::span<const std::uint32_t> contours) {
  double largest = 0;
  Vec3 on_line = mesh.vertices[mesh.contour_corners(contours[0])[0]];
  each_triangle(mesh, contours, Vec3::Zero(), [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const double area = std::abs((b - a).cross(c - a).x());
    if (area <= largest) return;
    largest = area;
    on_line = (a + b + c) / 3;
  });
  std::vector<Crossing> crossings;
  each_triangle(mesh, contours, on_line, [&](const Vec3& a, const Vec3& b, const Vec3& c) {
    const int turns = crossings_of(a, b, c);
    if (turns != 0) crossings.push_back({a.dot(b.cross(c)) / (b - a).cross(c - a).x(), -turns});
  });
  return on_line + Vec3(middle_within(std::move(crossings)), 0, 0);
}

double volume6(const PolygonMesh& mesh, std::span<const std::uint32_t> contours) {
  const Vec3 origin = mesh.vertices[mesh.contour_corners(contours[0])[0]];
  double sum = 0;
  for (const std::uint32_t contour : contours) {
    const auto corners = mesh.contour_corners(contour);
    const Vec3 a = mesh.vertices[corners[0]] - origin;
    for (std::size_t i = 2; i < corners.size(); ++i) {
      sum +=
          a.dot((mesh.vertices[corners[i - 1]] - origin).cross(mesh.vertices[corners[i]] - origin));
    }
  }
  return sum;
}

/// Returns the sets of contours that share vertices.
DisjointSets shells(const PolygonMesh& mesh) {
  DisjointSets sets(mesh.contours.size());
  constexpr std::uint32_t kNone = ~0u;
  std::vector<std::uint32_t> contour_at(mesh.vertices.size(), kNone);
  for (std::uint32_t k = 0; k < mesh.contours.size(); ++k) {
    for (const std::uint32_t v : mesh.contour_corners(k)) {
      if (contour_at[v] == kNone) contour_at[v] = k;
      sets.join(contour_at[v], k);
    }
  }
  return sets;
}

/// Joins each hole of a face with the smallest contour around it.
void join_holes(const PolygonMesh& mesh, const PolygonMesh::Face& face, DisjointSets& sets) {
  const std::uint32_t begin = face.first_contour, end = begin + face.contour_count;
  const ProjectedFace projected(mesh, face);
  std::vector<double> area;
  for (std::uint32_t k = begin; k < end; ++k) {
    area.push_back(area_along(mesh, k, face.plane.normal));
  }
  for (std::uint32_t hole = begin; hole < end; ++hole) {
    if (area[hole - begin] > 0) continue;
    const Vec2 point = projected.point_within(hole);
    std::uint32_t around = hole;
    for (std::uint32_t k = begin; k < end; ++k) {
      if (area[k - begin] <= -area[hole - begin] || !projected.surrounds(k, point)) continue;
      if (around == hole || area[k - begin] < area[around - begin]) around = k;
    }
    sets.join(hole, around);
  }
}

/// Returns the contours of each set, in the order of their first contours.
std::vector<std::vector<std::uint32_t>> members(DisjointSets& sets, std::size_t count) {
  std::vector<std::vector<std::uint32_t>> result;
  std::vector<std::size_t> index(count);
  for (std::uint32_t k = 0; k < count; ++k) {
    const std::uint32_t set = sets.root(k);
    if (set == k) {
      index[k] = result.size();
      result.emplace_back();
    }
    result[index[set]].push_back(k);
  }
  return result;
}

/// Joins each shell that bounds a cavity with the shell of the smallest solid around it.
void join_cavities(const PolygonMesh& mesh, DisjointSets& sets) {
  const auto parts = members(sets, mesh.contours.size());
  std::vector<double> volume;
  for (const auto& part : parts) volume.push_back(volume6(mesh, part));
  for (std::size_t cavity = 0; cavity < parts.size(); ++cavity) {
    if (volume[cavity] >= 0) continue;
    const Vec3 point = point_within(mesh, parts[cavity]);
    std::size_t around = cavity;
    for (std::size_t p = 0; p < parts.size(); ++p) {
      if (volume[p] <= -volume[cavity] || winding_number(mesh, parts[p], point) <= 0) continue;
      if (around == cavity || volume[p] < volume[around]) around = p;
    }
    sets.join(parts[cavity][0], parts[around][0]);
  }
}

/// Returns a mesh for each set. Contours keep their order; sets may share a face.
std::vector<PolygonMesh> extract_islands(const PolygonMesh& mesh, DisjointSets& sets) {
  constexpr std::uint32_t kNone = ~0u;
  std::vector<PolygonMesh> result;
  std::vector<std::size_t> island(mesh.contours.size());
  std::vector<std::uint32_t> new_of_old(mesh.vertices.size(), kNone);
  for (std::uint32_t k = 0; k < mesh.contours.size(); ++k) {
    const std::uint32_t set = sets.root(k);
    if (set == k) result.emplace_back();
    island[k] = set == k ? result.size() - 1 : island[set];
  }
  std::vector<std::size_t> last_face(result.size(), mesh.faces.size());
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const PolygonMesh::Face& face = mesh.faces[f];
    for (std::uint32_t k = face.first_contour; k < face.first_contour + face.contour_count; ++k) {
      PolygonMesh& part = result[island[k]];
      if (std::exchange(last_face[island[k]], f) != f) {
        part.faces.push_back(face);
        part.faces.back().first_contour = static_cast<std::uint32_t>(part.contours.size());
        part.faces.back().contour_count = 0;
      }
      ++part.faces.back().contour_count;
      const PolygonMesh::Contour& old = mesh.contours[k];
      part.contours.push_back({static_cast<std::uint32_t>(part.corners.size()), old.corner_count});
      for (std::uint32_t c = old.first_corner; c < old.first_corner + old.corner_count; ++c) {
        std::uint32_t& vertex = new_of_old[mesh.corners[c]];
        if (vertex == kNone) {
          vertex = static_cast<std::uint32_t>(part.vertices.size());
          part.vertices.push_back(mesh.vertices[mesh.corners[c]]);
        }
        part.corners.push_back(vertex);
        part.corner_normals.push_back(mesh.corner_normals[c]);
        if (!mesh.corner_uvs.empty()) part.corner_uvs.push_back(mesh.corner_uvs[c]);
      }
    }
  }
  return result;
}

}  // namespace

std::vector<PolygonMesh> islands(PolygonMesh mesh) {
  std::vector<PolygonMesh> result;
  if (mesh.empty()) return result;
  DisjointSets sets = shells(mesh);
  const auto has_several_sets = [&] { return members(sets, mesh.contours.size()).size() > 1; };
  if (has_several_sets()) {
    for (const PolygonMesh::Face& face : mesh.faces) {
      if (face.contour_count > 1) join_holes(mesh, face, sets);
    }
    join_cavities(mesh, sets);
  }
  if (has_several_sets()) return extract_islands(mesh, sets);
  result.push_back(std::move(mesh));
  return result;
}

}  // namespace sunder
