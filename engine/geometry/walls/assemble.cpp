// The last steps of outer_surface(): common edges are divided, and faces become a mesh.
#include <algorithm>
#include <numeric>

#include "engine/base/trigonometry.h"
#include "engine/geometry/walls/piece_surface.h"

namespace sunder {
namespace {

/// A half-edge, with the corners at its ends.
struct HalfEdge {
  std::uint32_t from = 0, to = 0;
  std::uint32_t corner = 0, next_corner = 0;  ///< Numbered over all faces.
  std::uint32_t face = 0;
};

/// A pair of faces with solid between them, at an edge that has several such pairs.
struct TouchingPair {
  std::uint32_t from = 0, to = 0;             ///< Ends of the edge.
  std::array<std::uint32_t, 2> corners = {};  ///< Start corners of the edge in the two faces.
  std::uint32_t number = 0, count = 0;  ///< Number of the pair, and of all pairs, at the edge.
};

/// Assigns different vertices to corners at one point whose faces are not connected by common
/// edges, so that every edge belongs to two faces by the numbers of its vertices.
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
    root_.resize(corner);
    std::iota(root_.begin(), root_.end(), 0u);
  }

  /// Returns false if an edge does not have equal numbers of faces in both directions.
  bool run() {
    std::sort(edges_.begin(), edges_.end(), [](const HalfEdge& a, const HalfEdge& b) {
      return std::pair(point_pair(a.from, a.to), a.corner) <
             std::pair(point_pair(b.from, b.to), b.corner);
    });
    for (std::size_t begin = 0, end = 0; begin < edges_.size(); begin = end) {
      const PointPair edge = point_pair(edges_[begin].from, edges_[begin].to);
      while (end < edges_.size() && point_pair(edges_[end].from, edges_[end].to) == edge) ++end;
      if (!pair_faces(std::span(edges_).subspan(begin, end - begin))) return false;
    }
    return true;
  }

  /// Returns the first of the corners that share the vertex of a corner.
  std::uint32_t root(std::uint32_t corner) {
    while (root_[corner] != corner) corner = root_[corner] = root_[root_[corner]];
    return corner;
  }

  /// Returns the pairs at edges of more than two faces.
  const std::vector<TouchingPair>& touching() const { return touching_; }

 private:
  void join(std::uint32_t a, std::uint32_t b) {
    a = root(a);
    b = root(b);
    root_[std::max(a, b)] = std::min(a, b);
  }

  void join(const HalfEdge& a, const HalfEdge& b) {
    join(a.corner, b.next_corner);
    join(a.next_corner, b.corner);
  }

  /// Pairs the faces at an edge that have solid between them.
  bool pair_faces(std::span<const HalfEdge> around) {
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
      order.emplace_back(arc_tangent(y.dot(inward), x.dot(inward)), &edge);
    }
    // Solid is at smaller angles than a forward face, and at larger angles than a backward face.
    std::stable_sort(order.begin(), order.end(),
                     [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<const HalfEdge*> unpaired;
    for (const auto& [angle, edge] : order) unpaired.push_back(edge);
    for (std::uint32_t number = 0; !unpaired.empty(); ++number) {
      std::size_t i = 0;
      while (is_forward(*unpaired[i]) || !is_forward(*unpaired[(i + 1) % unpaired.size()])) ++i;
      const std::size_t next = (i + 1) % unpaired.size();
      join(*unpaired[i], *unpaired[next]);
      touching_.push_back({first,
                           second,
                           {unpaired[i]->corner, unpaired[next]->corner},
                           number,
                           static_cast<std::uint32_t>(forward)});
      unpaired.erase(unpaired.begin() + static_cast<std::ptrdiff_t>(std::max(i, next)));
      unpaired.erase(unpaired.begin() + static_cast<std::ptrdiff_t>(std::min(i, next)));
    }
    return true;
  }

  const PieceSurface& surface_;
  std::vector<HalfEdge> edges_;
  std::vector<std::uint32_t> root_;
  std::vector<TouchingPair> touching_;
};

}  // namespace

std::optional<OuterSurface> assemble(const PieceSurface& surface) {
  VertexSeparator separator(surface);
  if (!separator.run()) return std::nullopt;
  OuterSurface result;
  PolygonMesh& mesh = result.mesh;
  std::vector<std::uint32_t> vertex_of;  // by corner; a root precedes the others of its set
  for (const PieceSurface::Face& face : surface.faces) {
    if (face.contours.empty()) continue;
    mesh.faces.push_back({face.plane, face.id, static_cast<std::uint32_t>(mesh.contours.size()),
                          static_cast<std::uint32_t>(face.contours.size()), face.kind,
                          face.appearance});
    result.from.push_back(face.mesh);
    for (const PieceSurface::Contour& contour : face.contours) {
      mesh.contours.push_back({static_cast<std::uint32_t>(mesh.corners.size()),
                               static_cast<std::uint32_t>(contour.size())});
      for (const PieceSurface::Corner& corner : contour) {
        const auto number = static_cast<std::uint32_t>(mesh.corners.size());
        const std::uint32_t root = separator.root(number);
        if (root == number) {
          vertex_of.push_back(static_cast<std::uint32_t>(mesh.vertices.size()));
          mesh.vertices.push_back(surface.points[corner.point]);
        } else {
          vertex_of.push_back(vertex_of[root]);
        }
        mesh.corners.push_back(vertex_of[number]);
        mesh.corner_normals.push_back(corner.normal);
        if (surface.has_uvs) mesh.corner_uvs.push_back(corner.uv);
      }
    }
  }
  return result;
}

bool divide_touching_edges(PieceSurface& surface) {
  constexpr std::uint32_t kNone = 0xffffffff;
  VertexSeparator separator(surface);
  if (!separator.run()) return false;
  if (separator.touching().empty()) return true;
  std::vector<std::uint32_t> divided_at;  // new point of the edge that starts at each corner
  for (const PieceSurface::Face& face : surface.faces) {
    for (const PieceSurface::Contour& contour : face.contours)
      divided_at.resize(divided_at.size() + contour.size(), kNone);
  }
  for (const TouchingPair& pair : separator.touching()) {
    const double part = (pair.number + 1.0) / (pair.count + 1.0);
    const Vec3 &from = surface.points[pair.from], &to = surface.points[pair.to];
    const auto point = static_cast<std::uint32_t>(surface.points.size());
    divided_at[pair.corners[0]] = divided_at[pair.corners[1]] = point;
    surface.points.emplace_back(Vec3(from + part * (to - from)));
  }
  std::uint32_t first = 0;
  for (PieceSurface::Face& face : surface.faces) {
    for (PieceSurface::Contour& contour : face.contours) {
      PieceSurface::Contour divided;
      for (std::size_t i = 0; i < contour.size(); ++i) {
        const PieceSurface::Corner& a = contour[i];
        const PieceSurface::Corner& b = contour[i + 1 < contour.size() ? i + 1 : 0];
        const std::uint32_t point = divided_at[first + i];
        divided.push_back(a);
        if (point != kNone) divided.push_back({point, a.normal, 0.5f * (a.uv + b.uv)});
      }
      first += static_cast<std::uint32_t>(contour.size());
      contour = std::move(divided);
    }
  }
  return true;
}

}  // namespace sunder
