#include "engine/model/piece_mesh.h"

#include <algorithm>
#include <map>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "engine/base/trigonometry.h"
#include "engine/geometry/triangulate_face.h"

namespace sunder {
namespace {

// Least covered fraction of a face that counts as covered; bond areas have rounding errors.
constexpr double kMinCovered = 1 - 1e-6;

/// Groups of convexes that overlap, directly or through others; computed on demand.
class OverlapGroups {
 public:
  explicit OverlapGroups(const Structure& structure) : structure_(structure) {}

  /// Returns the lowest slot of a convex's group; none() if it overlaps no other convex. Where
  /// several convexes of a group lie beyond a face, only the largest bond counts as cover, since
  /// the overlap of their areas is unknown.
  ConvexSlot of(ConvexSlot slot) {
    if (structure_.ghost_indices(slot).empty()) return {};
    if (const auto known = group_of_.find(slot.value); known != group_of_.end())
      return known->second;
    std::vector<ConvexSlot> group = {slot};
    ConvexSlot least = slot;
    group_of_[slot.value] = slot;
    for (std::size_t i = 0; i < group.size(); ++i) {
      least = std::min(least, group[i]);
      for (const std::uint32_t number : structure_.ghost_indices(group[i])) {
        for (const std::uint32_t other : structure_.ghost(number).of) {
          const ConvexSlot member(other);
          if (group_of_.emplace(other, member).second) group.push_back(member);
        }
      }
    }
    for (const ConvexSlot member : group) group_of_[member.value] = least;
    return least;
  }

 private:
  const Structure& structure_;
  std::unordered_map<std::uint32_t, ConvexSlot> group_of_;
};

std::vector<std::uint8_t> covered_faces(const ConvexPolyhedron& polyhedron,
                                        const std::vector<double>& covered_m2) {
  std::vector<std::uint8_t> covered(covered_m2.size(), 0);
  for (std::size_t f = 0; f < covered.size(); ++f) {
    covered[f] = covered_m2[f] > 0 && covered_m2[f] >= kMinCovered * face_area(polyhedron, f);
  }
  return covered;
}

/// Returns flags of the faces of a surface convex whose caps are covered.
std::vector<std::uint8_t> covered_caps(const Convex& convex,
                                       const std::vector<double>& covered_m2) {
  const auto& faces = convex.polyhedron.faces;
  std::vector<std::uint8_t> covered(covered_m2.size(), 0);
  for (std::size_t cap = first_cap(*convex.visual); cap < convex.visual->faces.size(); ++cap) {
    double sum_m2 = 0;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (faces[f].id == convex.visual->faces[cap].id) sum_m2 += covered_m2[f];
    }
    if (sum_m2 <= 0 || sum_m2 < kMinCovered * face_area(*convex.visual, cap)) continue;
    for (std::size_t f = 0; f < faces.size(); ++f) {
      if (faces[f].id == convex.visual->faces[cap].id) covered[f] = 1;
    }
  }
  return covered;
}

/// Returns a point relative to the origin of a mesh, in its texture frame.
Vec3f point_T(const Mesh& mesh, const Vec3& point_R) {
  return (mesh.X_RT.inverse() * point_R - mesh.origin_T).cast<float>();
}
Vec3f direction_T(const Mesh& mesh, const Vec3f& direction_R) {
  return mesh.X_RT.rotation.conjugate().cast<float>() * direction_R;
}

void add_polyhedron(const ConvexPolyhedron& polyhedron, const std::vector<std::uint8_t>& hidden,
                    Mesh& mesh) {
  std::size_t corners = 0, triangles = 0;
  for (std::size_t f = 0; f < polyhedron.faces.size(); ++f) {
    if (hidden[f]) continue;
    corners += polyhedron.faces[f].corner_count;
    triangles += polyhedron.faces[f].corner_count - 2;
  }
  mesh.vertices.reserve(corners);
  mesh.indices.reserve(3 * triangles);
  for (std::size_t f = 0; f < polyhedron.faces.size(); ++f) {
    if (hidden[f]) continue;
    const ConvexPolyhedron::Face& face = polyhedron.faces[f];
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (std::uint32_t k = 0; k < face.corner_count; ++k) {
      const std::uint32_t corner = face.first_corner + k;
      mesh.vertices.push_back(
          {point_T(mesh, polyhedron.vertices[polyhedron.corners[corner]]),
           direction_T(mesh, polyhedron.corner_normals[corner]),
           face.kind == FaceKind::kInterior ? Mesh::kInterior : Mesh::kSurface});
      if (k >= 2) {
        mesh.indices.insert(mesh.indices.end(), {first, first + k - 1, first + k});
      }
    }
  }
}

bool is_hidden(const Convex& convex, const std::vector<std::uint8_t>& hidden, PlaneId id) {
  for (std::size_t f = 0; f < hidden.size(); ++f) {
    if (convex.polyhedron.faces[f].id == id) return hidden[f] != 0;
  }
  return false;
}

/// Adds the triangles of a visual mesh; corners of equal appearance share a vertex.
void add_visual(const Convex& convex, const std::vector<std::uint8_t>& hidden, Mesh& mesh) {
  constexpr std::uint32_t kNone = 0xffffffff;
  const PolygonMesh& visual = *convex.visual;
  const bool textured =
      !visual.corner_uvs.empty() &&
      std::any_of(visual.faces.begin(), visual.faces.end(),
                  [](const PolygonMesh::Face& face) { return face.appearance > 0; });
  // latest drawn vertex of each visual vertex
  std::vector<std::uint32_t> latest(visual.vertices.size(), kNone);
  for (std::size_t f = 0; f < visual.faces.size(); ++f) {
    const PolygonMesh::Face& face = visual.faces[f];
    if (!face.id.none() && is_hidden(convex, hidden, face.id)) continue;
    const std::uint32_t look = face.kind == FaceKind::kInterior ? Mesh::kInterior
                               : face.appearance > 0 ? Mesh::kFirstAppearance + face.appearance - 1
                                                     : Mesh::kSurface;
    for (const Triangle& triangle : triangulate(visual, f)) {
      for (const std::uint32_t corner : triangle) {
        const std::uint32_t vertex = visual.corners[corner];
        const Vec3f normal = direction_T(mesh, visual.corner_normals[corner]);
        std::uint32_t& drawn = latest[vertex];
        const Vec2f uv = textured ? visual.corner_uvs[corner] : Vec2f(Vec2f::Zero());
        if (drawn == kNone || mesh.vertices[drawn].look != look ||
            mesh.vertices[drawn].normal != normal || (textured && mesh.uvs[drawn] != uv)) {
          drawn = static_cast<std::uint32_t>(mesh.vertices.size());
          mesh.vertices.push_back({point_T(mesh, visual.vertices[vertex]), normal, look});
          if (textured) mesh.uvs.push_back(uv);
        }
        mesh.indices.push_back(drawn);
      }
    }
  }
  mesh.vertices.shrink_to_fit();
  mesh.uvs.shrink_to_fit();
  mesh.indices.shrink_to_fit();
}

}  // namespace

std::vector<std::vector<std::uint8_t>> hidden_faces(const Structure& structure,
                                                    std::span<const ConvexSlot> slots) {
  OverlapGroups groups(structure);
  std::vector<std::vector<std::uint8_t>> hidden;
  hidden.reserve(slots.size());
  std::vector<double> covered_m2;
  std::map<std::pair<std::uint32_t, ConvexSlot>, double> most_m2;  // key: face, and group beyond it
  for (const ConvexSlot slot : slots) {
    const Convex& convex = *structure.convex(slot);
    covered_m2.assign(convex.polyhedron.faces.size(), 0.0);
    most_m2.clear();
    for (const Link& link : structure.links(slot)) {
      const ConvexSlot group = groups.of(link.other);
      if (group.none()) {
        covered_m2[link.face] += link.area_m2;
      } else {
        double& most = most_m2[{link.face, group}];
        most = std::max(most, link.area_m2);
      }
    }
    for (const auto& [at, area] : most_m2) covered_m2[at.first] += area;
    hidden.push_back(convex.is_internal() ? covered_faces(convex.polyhedron, covered_m2)
                                          : covered_caps(convex, covered_m2));
  }
  return hidden;
}

std::vector<std::vector<std::uint8_t>> hidden_faces(const Compound& compound) {
  const Structure structure(compound);
  return hidden_faces(structure, structure.slots());
}

std::shared_ptr<const Mesh> make_mesh(const Convex& convex,
                                      const std::vector<std::uint8_t>& hidden) {
  auto mesh = std::make_shared<Mesh>();
  mesh->X_RT = convex.X_RT;
  mesh->origin_T = convex.X_RT.inverse() * convex.box.center();
  mesh->material = convex.material;
  if (convex.is_internal()) {
    add_polyhedron(convex.polyhedron, hidden, *mesh);
  } else {
    add_visual(convex, hidden, *mesh);
  }
  return mesh->indices.empty() ? nullptr : mesh;
}

std::shared_ptr<const Mesh> make_ball_mesh(double radius_m, MaterialIndex material) {
  constexpr std::uint32_t kRings = 24, kSectors = 48;
  auto mesh = std::make_shared<Mesh>();
  mesh->material = material;
  for (std::uint32_t ring = 0; ring <= kRings; ++ring) {
    const SinCos polar = sin_cos(std::numbers::pi * ring / kRings);
    for (std::uint32_t sector = 0; sector <= kSectors; ++sector) {
      const SinCos around = sin_cos(2 * std::numbers::pi * (sector % kSectors) / kSectors);
      const Vec3 normal(polar.sin * around.sin, polar.cos, polar.sin * around.cos);
      mesh->vertices.push_back(
          {(radius_m * normal).cast<float>(), normal.cast<float>(), Mesh::kSurface});
    }
  }
  constexpr std::uint32_t kRow = kSectors + 1;
  for (std::uint32_t ring = 0; ring < kRings; ++ring) {
    for (std::uint32_t sector = 0; sector < kSectors; ++sector) {
      const std::uint32_t top = ring * kRow + sector, bottom = top + kRow;
      if (ring > 0) mesh->indices.insert(mesh->indices.end(), {top, bottom, top + 1});
      if (ring + 1 < kRings) {
        mesh->indices.insert(mesh->indices.end(), {top + 1, bottom, bottom + 1});
      }
    }
  }
  return mesh;
}

}  // namespace sunder
