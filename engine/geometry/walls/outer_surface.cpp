#include "engine/geometry/walls/outer_surface.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "engine/geometry/walls/piece_surface.h"

namespace sunder {
namespace {

/// Distances between points of two meshes that are meant to be one point, over the largest
/// coordinate; a larger one is tried where a smaller one does not lead to a closed surface.
constexpr double kTolerances[] = {4e-12, 4e-13, 4e-14, 4e-11, 4e-10};
constexpr double kVolumeError = 1e-12;

/// A corner and the edge that starts there.
struct HalfEdge {
  std::uint32_t from = 0, to = 0;
  std::uint32_t corner = 0, next_corner = 0;  ///< Counted over all faces.
  std::uint32_t face = 0;
};

/// Gives corners at one point that no chain of faces connects different vertices, so that every
/// edge lies in two faces by the numbers of its vertices.
class VertexSeparator {
 public:
  explicit VertexSeparator(const PieceSurface& surface) : surface_(surface) {
    std::uint32_t corner = 0;
    for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
      for (const PieceSurface::Contour& contour : surface.faces[f].contours) {
        const auto count = static_cast<std::uint32_t>(contour.size());
        for (std::uint32_t i = 0; i < count; ++i) {
          const std::uint32_t next = i + 1 < count ? i + 1 : 0;
          edges_.push_back({contour[i].point, contour[next].point, corner + i, corner + next, f});
        }
        corner += count;
      }
    }
    leader_.resize(corner);
    std::iota(leader_.begin(), leader_.end(), 0u);
  }

  /// Returns false if an edge is not passed as often one way as the other.
  bool run() {
    std::sort(edges_.begin(), edges_.end(), [](const HalfEdge& a, const HalfEdge& b) {
      return std::pair(point_pair(a.from, a.to), a.corner) <
             std::pair(point_pair(b.from, b.to), b.corner);
    });
    for (std::size_t begin = 0, end = 0; begin < edges_.size(); begin = end) {
      const PointPair edge = point_pair(edges_[begin].from, edges_[begin].to);
      while (end < edges_.size() && point_pair(edges_[end].from, edges_[end].to) == edge) ++end;
      if (!pair_up(std::span(edges_).subspan(begin, end - begin))) return false;
    }
    return true;
  }

  /// The first corner of those that have their vertex in common with a corner.
  std::uint32_t leader(std::uint32_t corner) {
    while (leader_[corner] != corner) corner = leader_[corner] = leader_[leader_[corner]];
    return corner;
  }

 private:
  void join(std::uint32_t a, std::uint32_t b) {
    a = leader(a);
    b = leader(b);
    leader_[std::max(a, b)] = std::min(a, b);
  }

  void join(const HalfEdge& a, const HalfEdge& b) {
    join(a.corner, b.next_corner);
    join(a.next_corner, b.corner);
  }

  /// Pairs the faces at an edge that have solid between them.
  bool pair_up(std::span<const HalfEdge> around) {
    const auto is_forward = [](const HalfEdge& edge) { return edge.from < edge.to; };
    const auto forward =
        static_cast<std::size_t>(std::count_if(around.begin(), around.end(), is_forward));
    if (2 * forward != around.size()) return false;
    if (forward == 1) {
      join(around[0], around[1]);
      return true;
    }
    const std::uint32_t first = std::min(around[0].from, around[0].to);
    const std::uint32_t second = std::max(around[0].from, around[0].to);
    const Vec3 along = (surface_.points[second] - surface_.points[first]).normalized();
    const Vec3 x = along.unitOrthogonal(), y = along.cross(x);
    std::vector<std::pair<double, const HalfEdge*>> order;
    for (const HalfEdge& edge : around) {
      const Vec3 normal = surface_.faces[edge.face].plane.normal;
      const Vec3 inward = is_forward(edge) ? normal.cross(along) : along.cross(normal);
      order.emplace_back(std::atan2(y.dot(inward), x.dot(inward)), &edge);
    }
    // Solid is behind a forward face, and ahead of a face the other way.
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<const HalfEdge*> left;
    for (const auto& [angle, edge] : order) left.push_back(edge);
    while (!left.empty()) {
      std::size_t i = 0;
      while (is_forward(*left[i]) || !is_forward(*left[(i + 1) % left.size()])) ++i;
      const std::size_t next = (i + 1) % left.size();
      join(*left[i], *left[next]);
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(std::max(i, next)));
      left.erase(left.begin() + static_cast<std::ptrdiff_t>(std::min(i, next)));
    }
    return true;
  }

  const PieceSurface& surface_;
  std::vector<HalfEdge> edges_;
  std::vector<std::uint32_t> leader_;
};

/// Returns none if an edge is not passed as often one way as the other.
std::optional<OuterSurface> assemble(const PieceSurface& surface) {
  VertexSeparator separator(surface);
  if (!separator.run()) return std::nullopt;
  OuterSurface result;
  PolygonMesh& mesh = result.mesh;
  std::vector<std::uint32_t> vertex_of;  // by corner; a leader comes before those that it leads
  for (const PieceSurface::Face& face : surface.faces) {
    if (face.contours.empty()) continue;
    mesh.faces.push_back({face.plane, face.id, static_cast<std::uint32_t>(mesh.contours.size()),
                          static_cast<std::uint32_t>(face.contours.size()), face.kind, face.mark});
    result.from.push_back(face.mesh);
    for (const PieceSurface::Contour& contour : face.contours) {
      mesh.contours.push_back({static_cast<std::uint32_t>(mesh.corners.size()),
                               static_cast<std::uint32_t>(contour.size())});
      for (const PieceSurface::Corner& corner : contour) {
        const auto number = static_cast<std::uint32_t>(mesh.corners.size());
        const std::uint32_t leader = separator.leader(number);
        if (leader == number) {
          vertex_of.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
          mesh.vertices.push_back(surface.points[corner.point]);
        } else {
          vertex_of.push_back(vertex_of[leader]);
        }
        mesh.corners.push_back(vertex_of[number]);
        mesh.corner_normals.push_back(corner.normal);
        if (surface.has_uvs) mesh.corner_uvs.push_back(corner.uv);
      }
    }
  }
  return result;
}

/// Halves edges that more than two faces share: each pair of faces gets a middle of its own, so
/// that no two pairs have an edge in common even where both ends are.
void halve_touching_edges(PieceSurface& surface) {
  std::map<PointPair, std::pair<std::uint32_t, std::uint32_t>> uses;  // with the middle
  const auto next_of = [](const PieceSurface::Contour& contour, std::size_t i) {
    return contour[i + 1 < contour.size() ? i + 1 : 0];
  };
  for (const PieceSurface::Face& face : surface.faces) {
    for (const PieceSurface::Contour& contour : face.contours) {
      for (std::size_t i = 0; i < contour.size(); ++i) {
        ++uses[point_pair(contour[i].point, next_of(contour, i).point)].first;
      }
    }
  }
  std::erase_if(uses, [](const auto& edge) { return edge.second.first <= 2; });
  for (auto& [edge, use] : uses) {
    use.second = static_cast<std::uint32_t>(surface.points.size());
    surface.points.push_back(0.5 * (surface.points[edge[0]] + surface.points[edge[1]]));
  }
  if (uses.empty()) return;
  for (PieceSurface::Face& face : surface.faces) {
    for (PieceSurface::Contour& contour : face.contours) {
      PieceSurface::Contour halved;
      for (std::size_t i = 0; i < contour.size(); ++i) {
        const PieceSurface::Corner& a = contour[i];
        const PieceSurface::Corner b = next_of(contour, i);
        halved.push_back(a);
        const auto found = uses.find(point_pair(a.point, b.point));
        if (found == uses.end()) continue;
        halved.push_back({found->second.second, a.normal, 0.5f * (a.uv + b.uv)});
      }
      contour = std::move(halved);
    }
  }
}

std::optional<OuterSurface> without_walls(std::span<const PolygonMesh* const> meshes,
                                          double tolerance_m) {
  PieceSurface surface = join_meshes(meshes, tolerance_m);
  const std::vector<WallPlane> planes = find_wall_planes(surface, tolerance_m);
  if (!split_edges(surface, planes, tolerance_m)) return std::nullopt;
  for (const WallPlane& plane : planes) {
    if (!remove_common(surface, plane)) return std::nullopt;
  }
  halve_touching_edges(surface);
  return assemble(surface);
}

}  // namespace

std::optional<OuterSurface> outer_surface(std::span<const PolygonMesh* const> meshes) {
  if (meshes.size() == 1) {
    if (open_edges(*meshes[0]) > 0) return std::nullopt;
    return OuterSurface{*meshes[0], std::vector<std::uint32_t>(meshes[0]->faces.size(), 0)};
  }
  double volume_m3 = 0, reach = 0;
  for (const PolygonMesh* mesh : meshes) {
    volume_m3 += mass_properties(*mesh).volume_m3;
    for (const Vec3& v : mesh->vertices) reach = std::max(reach, v.cwiseAbs().maxCoeff());
  }
  for (const double tolerance : kTolerances) {
    std::optional<OuterSurface> result = without_walls(meshes, tolerance * reach);
    if (!result || open_edges(result->mesh) > 0) continue;
    const double error = mass_properties(result->mesh).volume_m3 - volume_m3;
    if (std::abs(error) <= kVolumeError * std::abs(volume_m3)) return result;
  }
  return std::nullopt;
}

std::size_t touching_edges(const PolygonMesh& mesh) {
  std::vector<std::uint32_t> order(mesh.vertices.size()), place(mesh.vertices.size());
  std::iota(order.begin(), order.end(), 0u);
  const auto less = [&](std::uint32_t a, std::uint32_t b) {
    const Vec3 &p = mesh.vertices[a], &q = mesh.vertices[b];
    return std::lexicographical_compare(p.data(), p.data() + 3, q.data(), q.data() + 3);
  };
  std::sort(order.begin(), order.end(), less);
  for (std::size_t i = 0; i < order.size(); ++i) {
    const bool is_new = i == 0 || less(order[i - 1], order[i]);
    place[order[i]] = is_new ? order[i] : place[order[i - 1]];
  }
  std::map<PointPair, std::size_t> count;
  for (std::size_t k = 0; k < mesh.contours.size(); ++k) {
    const auto corners = mesh.contour_corners(k);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t next = corners[i + 1 < corners.size() ? i + 1 : 0];
      ++count[point_pair(place[corners[i]], place[next])];
    }
  }
  return static_cast<std::size_t>(
      std::count_if(count.begin(), count.end(), [](const auto& one) { return one.second > 2; }));
}

}  // namespace sunder
