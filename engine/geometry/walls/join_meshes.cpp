// The first steps of outer_surface(): puts all faces on common points and finds walls.
#include <algorithm>
#include <cmath>
#include <map>
#include <unordered_map>

#include "engine/geometry/walls/piece_surface.h"

namespace sunder {
namespace {

/// Assigns numbers to points; a point within the tolerance of a known point gets its number.
class PointJoiner {
 public:
  explicit PointJoiner(double tolerance_m) : tolerance_m_(tolerance_m) {}

  std::uint32_t number_of(const Vec3& point) {
    const Cell cell = cell_of(point);
    for (int dx = -1; dx <= 1; ++dx) {
      for (int dy = -1; dy <= 1; ++dy) {
        for (int dz = -1; dz <= 1; ++dz) {
          const auto found = points_in_.find(hash({cell[0] + dx, cell[1] + dy, cell[2] + dz}));
          if (found == points_in_.end()) continue;
          for (const std::uint32_t known : found->second) {
            if ((points[known] - point).norm() <= tolerance_m_) return known;
          }
        }
      }
    }
    const auto number = static_cast<std::uint32_t>(points.size());
    points.push_back(point);
    points_in_[hash(cell)].push_back(number);
    return number;
  }

  std::vector<Vec3> points;

 private:
  using Cell = std::array<std::int64_t, 3>;

  /// Returns a cell larger than the tolerance: points to join lie in the same or in adjacent cells.
  Cell cell_of(const Vec3& point) const {
    const Vec3 cell = (point / (2 * tolerance_m_)).array().floor();
    return {std::int64_t(cell.x()), std::int64_t(cell.y()), std::int64_t(cell.z())};
  }
  static std::uint64_t hash(const Cell& cell) {
    std::uint64_t sum = 0;
    for (const std::int64_t c : cell) {
      sum = (sum ^ static_cast<std::uint64_t>(c)) * 0x9e3779b97f4a7c15u;
      sum ^= sum >> 29;
    }
    return sum;
  }

  double tolerance_m_;
  std::unordered_map<std::uint64_t, std::vector<std::uint32_t>> points_in_;
};

PieceSurface::Contour contour_of(const PolygonMesh& mesh, const PolygonMesh::Face& face,
                                 const PolygonMesh::Contour& contour,
                                 const std::vector<std::uint32_t>& number_of) {
  PieceSurface::Contour result;
  for (std::uint32_t c = contour.first_corner; c < contour.first_corner + contour.corner_count;
       ++c) {
    const Vec3& at = mesh.vertices[mesh.corners[c]];
    const Vec2f uv =
        mesh.corner_uvs.empty() ? planar_uv(at, face.plane.normal) : mesh.corner_uvs[c];
    result.push_back({number_of[mesh.corners[c]], mesh.corner_normals[c], uv});
  }
  clean_contour(result);
  return result;
}

Box bounds_of(const PieceSurface& surface, const PieceSurface::Face& face) {
  Box box;
  for (const PieceSurface::Contour& contour : face.contours) {
    for (const PieceSurface::Corner& corner : contour) box.extend(surface.points[corner.point]);
  }
  return box;
}

bool overlap(const Box& a, const Box& b, double tolerance_m) {
  return ((a.min.array() <= b.max.array() + tolerance_m) &&
          (b.min.array() <= a.max.array() + tolerance_m))
      .all();
}

}  // namespace

void clean_contour(PieceSurface::Contour& contour) {
  std::size_t kept = 0;  // number of corners kept so far
  for (std::size_t i = 0; i < contour.size(); ++i) {
    contour[kept++] = contour[i];
    for (;;) {
      if (kept >= 2 && contour[kept - 1].point == contour[kept - 2].point) {
        --kept;
      } else if (kept >= 3 && contour[kept - 1].point == contour[kept - 3].point) {
        kept -= 2;
      } else {
        break;
      }
    }
  }
  // Removes repeated corners and spikes across the end of the contour.
  std::size_t first = 0;
  while (kept - first >= 2) {
    const std::uint32_t last = contour[kept - 1].point;
    if (last == contour[first].point) {
      --kept;
    } else if (kept - first >= 3 && last == contour[first + 1].point) {
      ++first;
      --kept;
    } else if (kept - first >= 3 && contour[kept - 2].point == contour[first].point) {
      kept -= 2;
    } else {
      break;
    }
  }
  contour.resize(kept);
  contour.erase(contour.begin(), contour.begin() + static_cast<std::ptrdiff_t>(first));
  if (contour.size() < 3) contour.clear();
}

PieceSurface join_meshes(std::span<const PolygonMesh* const> meshes, double tolerance_m) {
  PieceSurface surface;
  PointJoiner joiner(tolerance_m);
  for (const PolygonMesh* mesh : meshes) surface.has_uvs |= !mesh->corner_uvs.empty();
  for (std::uint32_t m = 0; m < meshes.size(); ++m) {
    const PolygonMesh& mesh = *meshes[m];
    std::vector<std::uint32_t> number_of;
    number_of.reserve(mesh.vertices.size());
    for (const Vec3& vertex : mesh.vertices) number_of.push_back(joiner.number_of(vertex));
    for (const PolygonMesh::Face& face : mesh.faces) {
      PieceSurface::Face joined{face.plane, face.id, face.kind, face.appearance, m, {}};
      for (std::uint32_t k = face.first_contour; k < face.first_contour + face.contour_count; ++k) {
        auto contour = contour_of(mesh, face, mesh.contours[k], number_of);
        if (!contour.empty()) joined.contours.push_back(std::move(contour));
      }
      if (!joined.contours.empty()) surface.faces.push_back(std::move(joined));
    }
  }
  surface.points = std::move(joiner.points);
  return surface;
}

std::vector<WallPlane> find_wall_planes(const PieceSurface& surface, double tolerance_m) {
  std::map<std::uint64_t, std::array<std::vector<std::uint32_t>, 2>> sides_of;  // by plane
  for (std::uint32_t f = 0; f < surface.faces.size(); ++f) {
    const PlaneId id = surface.faces[f].id;
    if (!id.none()) sides_of[id.value & ~std::uint64_t{1}][id.value & 1].push_back(f);
  }
  std::vector<WallPlane> planes;
  for (const auto& [name, sides] : sides_of) {
    if (sides[0].empty() || sides[1].empty()) continue;
    std::array<std::vector<Box>, 2> boxes;
    std::array<std::vector<std::uint8_t>, 2> is_covered;
    for (std::size_t s = 0; s < 2; ++s) {
      for (const std::uint32_t f : sides[s]) {
        boxes[s].push_back(bounds_of(surface, surface.faces[f]));
      }
      is_covered[s].assign(sides[s].size(), 0);
    }
    for (std::size_t i = 0; i < sides[0].size(); ++i) {
      for (std::size_t j = 0; j < sides[1].size(); ++j) {
        if (!overlap(boxes[0][i], boxes[1][j], tolerance_m)) continue;
        is_covered[0][i] = is_covered[1][j] = 1;
      }
    }
    WallPlane plane;
    plane.normal = surface.faces[sides[0][0]].plane.normal;
    for (std::size_t s = 0; s < 2; ++s) {
      for (std::size_t i = 0; i < sides[s].size(); ++i) {
        if (is_covered[s][i]) plane.faces.push_back(sides[s][i]);
      }
    }
    if (plane.faces.empty()) continue;
    std::sort(plane.faces.begin(), plane.faces.end());
    planes.push_back(std::move(plane));
  }
  return planes;
}

}  // namespace sunder
