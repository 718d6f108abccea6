#include "engine/geometry/repair/solids.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

#include "engine/geometry/repair/clean.h"
#include "engine/geometry/repair/normals.h"
#include "engine/geometry/repair/winding.h"
#include "engine/geometry/triangulate.h"

namespace sunder {
namespace {

/// Greatest distance of a polygon's corners from its plane over the mesh's diagonal, and about the
/// relative error of volumes.
constexpr double kPlanarPolygonTolerance = 1e-13;
/// Greatest numbers of inward shells for which cavities are searched, and of outer shells tested.
constexpr std::size_t kMaxCavities = 256, kMaxHolders = 64;

Plane plane_of(const RawMesh& mesh, std::size_t polygon) {
  const Vec3 normal = double_area(mesh, polygon).normalized();
  double offset = 0;
  const auto corners = mesh.polygon_corners(polygon);
  for (const std::uint32_t v : corners) offset += normal.dot(mesh.vertices[v]);
  return {normal, -offset / static_cast<double>(corners.size())};
}

void append_corner(RawMesh& to, const RawMesh& from, std::uint32_t corner) {
  to.corners.push_back(from.corners[corner]);
  if (!from.corner_normals.empty()) to.corner_normals.push_back(from.corner_normals[corner]);
  if (!from.corner_uvs.empty()) to.corner_uvs.push_back(from.corner_uvs[corner]);
}

/// The shells of a surface, with their boxes and signed volumes.
struct Shells {
  std::vector<std::uint32_t> of_polygon;
  std::uint32_t count = 0;
  std::vector<double> volume;
  std::vector<Box> box;

  explicit Shells(const Surface& surface) {
    of_polygon = shells_of(surface, count);
    volume = volumes(surface.mesh, of_polygon, count);
    box.resize(count);
    for (std::size_t p = 0; p < of_polygon.size(); ++p) {
      for (const std::uint32_t v : surface.mesh.polygon_corners(p)) {
        box[of_polygon[p]].extend(surface.mesh.vertices[v]);
      }
    }
  }

  WindingField field(const Surface& surface, std::uint32_t shell) const {
    std::vector<std::array<Vec3, 3>> triangles;
    for (std::size_t p = 0; p < of_polygon.size(); ++p) {
      if (of_polygon[p] != shell) continue;
      const auto corners = surface.mesh.polygon_corners(p);
      for (std::size_t i = 2; i < corners.size(); ++i) {
        triangles.push_back({surface.mesh.vertices[corners[0]],
                             surface.mesh.vertices[corners[i - 1]],
                             surface.mesh.vertices[corners[i]]});
      }
    }
    return WindingField(std::move(triangles));
  }
};

/// Returns for each shell the smallest outward shell around it if it faces inward, else kNone.
std::vector<std::uint32_t> shells_around(const Surface& surface, const Shells& shells) {
  std::vector<std::uint32_t> around(shells.count, Surface::kNone);
  std::vector<std::uint32_t> inward;
  for (std::uint32_t s = 0; s < shells.count; ++s) {
    if (shells.volume[s] < 0) inward.push_back(s);
  }
  if (inward.size() > kMaxCavities) return around;
  std::vector<Vec3> point_on(shells.count);
  for (std::size_t p = 0; p < shells.of_polygon.size(); ++p) {
    point_on[shells.of_polygon[p]] = surface.mesh.vertices[surface.mesh.polygon_corners(p)[0]];
  }
  std::map<std::uint32_t, WindingField> fields;
  for (const std::uint32_t s : inward) {
    for (std::uint32_t t = 0; t < shells.count; ++t) {
      const bool smaller =
          around[s] == Surface::kNone || shells.volume[t] < shells.volume[around[s]];
      if (!(shells.volume[t] > -shells.volume[s]) || !smaller) continue;
      if ((shells.box[s].min.array() < shells.box[t].min.array()).any()) continue;
      if ((shells.box[s].max.array() > shells.box[t].max.array()).any()) continue;
      if (!fields.contains(t) && fields.size() == kMaxHolders) continue;
      if (!fields.contains(t)) fields.emplace(t, shells.field(surface, t));
      if (fields.at(t).at(point_on[s]) > 0.5) around[s] = t;
    }
  }
  return around;
}

void flip(Surface& surface, const std::vector<std::uint8_t>& polygons) {
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    if (polygons[p]) reverse_polygon(surface.mesh, p);
  }
  surface = pair_edges(std::move(surface.mesh));
}

}  // namespace

RawMesh extract(const RawMesh& mesh, const std::vector<std::uint8_t>& keep) {
  RawMesh part = mesh;
  rewrite_polygons(part, [&](std::size_t p, std::vector<std::uint32_t>& corners) {
    if (!keep[p]) corners.clear();
  });
  drop_unused_vertices(part);
  return part;
}

void append(RawMesh& mesh, const RawMesh& other) {
  const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
  mesh.vertices.insert(mesh.vertices.end(), other.vertices.begin(), other.vertices.end());
  std::vector<std::uint32_t> vertices;
  for (std::size_t p = 0; p < other.polygons.size(); ++p) {
    vertices.clear();
    for (const std::uint32_t v : other.polygon_corners(p)) vertices.push_back(first + v);
    append_polygon(mesh, vertices, RawMesh::kNoGroup);
  }
}

std::size_t triangulate_curved(RawMesh& mesh) {
  Box box;
  for (const std::uint32_t v : mesh.corners) box.extend(mesh.vertices[v]);
  const double tolerance = kPlanarPolygonTolerance * box.extent().norm();
  std::size_t count = 0;
  RawMesh result;
  std::vector<Vec3> contour;
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    const RawMesh::Polygon& polygon = mesh.polygons[p];
    const auto corners = mesh.polygon_corners(p);
    const Plane plane = plane_of(mesh, p);
    const bool planar =
        corners.size() == 3 || std::all_of(corners.begin(), corners.end(), [&](std::uint32_t v) {
          return std::abs(plane.distance(mesh.vertices[v])) <= tolerance;
        });
    const auto begin = [&](std::uint32_t corner_count) {
      const auto first = static_cast<std::uint32_t>(result.corners.size());
      result.polygons.push_back({first, corner_count, polygon.group});
    };
    if (planar) {
      begin(polygon.corner_count);
      for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
        append_corner(result, mesh, polygon.first_corner + i);
      }
      continue;
    }
    ++count;
    contour.clear();
    for (const std::uint32_t v : corners) contour.push_back(mesh.vertices[v]);
    for (const Triangle& t : triangulate(contour)) {
      begin(3);
      for (const std::uint32_t i : t) append_corner(result, mesh, polygon.first_corner + i);
    }
  }
  mesh.polygons = std::move(result.polygons);
  mesh.corners = std::move(result.corners);
  mesh.corner_normals = std::move(result.corner_normals);
  mesh.corner_uvs = std::move(result.corner_uvs);
  return count;
}

std::size_t orient_outward(Surface& surface, std::vector<std::uint32_t>& solid,
                           std::uint32_t& count) {
  std::size_t flipped = 0;
  Shells shells(surface);
  if (std::accumulate(shells.volume.begin(), shells.volume.end(), 0.0) < 0) {
    flipped += shells.count;  // the mesh as a whole is inside out
    flip(surface, std::vector<std::uint8_t>(surface.mesh.polygons.size(), 1));
    shells = Shells(surface);
  }
  const std::vector<std::uint32_t> around = shells_around(surface, shells);
  std::vector<std::uint8_t> to_flip(surface.mesh.polygons.size(), 0);
  for (std::size_t p = 0; p < to_flip.size(); ++p) {
    const std::uint32_t s = shells.of_polygon[p];
    to_flip[p] = shells.volume[s] < 0 && around[s] == Surface::kNone ? 1 : 0;
  }
  for (std::uint32_t s = 0; s < shells.count; ++s) {
    flipped += shells.volume[s] < 0 && around[s] == Surface::kNone ? 1 : 0;
  }
  if (std::find(to_flip.begin(), to_flip.end(), 1) != to_flip.end()) flip(surface, to_flip);

  std::vector<std::uint32_t> solid_of_shell(shells.count, 0);
  count = 0;
  for (std::uint32_t s = 0; s < shells.count; ++s) {
    if (around[s] == Surface::kNone) solid_of_shell[s] = count++;
  }
  for (std::uint32_t s = 0; s < shells.count; ++s) {
    if (around[s] != Surface::kNone) solid_of_shell[s] = solid_of_shell[around[s]];
  }
  solid.clear();
  for (const std::uint32_t s : shells.of_polygon) solid.push_back(solid_of_shell[s]);
  return flipped;
}

std::vector<PolygonMesh> polygon_meshes(const Surface& surface,
                                        const std::vector<std::uint32_t>& solid,
                                        std::uint32_t count, double crease_cosine) {
  const RawMesh& mesh = surface.mesh;
  const std::vector<Vec3f> normals = shading_normals(surface, crease_cosine);
  std::vector<PolygonMesh> meshes(count);
  // No vertex is in two solids, since every fan has its own vertices.
  std::vector<std::uint32_t> new_of_old(mesh.vertices.size(), Surface::kNone);
  for (std::size_t p = 0; p < mesh.polygons.size(); ++p) {
    PolygonMesh& part = meshes[solid[p]];
    const RawMesh::Polygon& polygon = mesh.polygons[p];
    part.faces.push_back({plane_of(mesh, p),
                          {},
                          static_cast<std::uint32_t>(part.contours.size()),
                          1,
                          FaceKind::kSurface,
                          polygon.group < mesh.groups.size() ? polygon.group + 1 : 0});
    part.contours.push_back(
        {static_cast<std::uint32_t>(part.corners.size()), polygon.corner_count});
    for (std::uint32_t i = 0; i < polygon.corner_count; ++i) {
      const std::uint32_t c = polygon.first_corner + i;
      std::uint32_t& v = new_of_old[mesh.corners[c]];
      if (v == Surface::kNone) {
        v = static_cast<std::uint32_t>(part.vertices.size());
        part.vertices.push_back(mesh.vertices[mesh.corners[c]]);
      }
      part.corners.push_back(v);
      part.corner_normals.push_back(normals[c]);
      if (!mesh.corner_uvs.empty()) part.corner_uvs.push_back(mesh.corner_uvs[c]);
    }
  }
  return meshes;
}

}  // namespace sunder
