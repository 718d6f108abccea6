#include "engine/io/mesh/export_model.h"

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/geometry/triangulate_face.h"
#include "engine/geometry/walls/outer_surface.h"

namespace sunder {
namespace {

/// Returns a name with leading zeros, so that names sort by index.
std::string part_name(std::size_t index, std::size_t count) {
  const std::string digits = std::to_string(index), most = std::to_string(count - 1);
  return "piece_" + std::string(most.size() - digits.size(), '0') + digits;
}

/// Returns the index of a face's material: two per material of the scene, then those from files.
std::uint32_t material_of(const PolygonMesh::Face& face, MaterialIndex material,
                          std::uint32_t first_appearance) {
  if (face.kind == FaceKind::kInterior) return 2 * material.value + 1;
  return face.appearance > 0 ? first_appearance + face.appearance - 1 : 2 * material.value;
}

std::shared_ptr<const PolygonMesh> surface_of(const Convex& convex) {
  if (convex.visual) return convex.visual;
  return std::make_shared<const PolygonMesh>(polygon_mesh(convex.polyhedron));
}

/// Returns the shells of a piece. Sets `is_walled` to 1 if inner walls could not be removed.
std::vector<Model::Shell> shells_of(const Compound& piece, std::uint32_t first_appearance,
                                    Walls walls, std::uint8_t& is_walled) {
  std::vector<Model::Shell> shells;
  const auto add = [&](OuterSurface surface) {
    std::vector<std::uint32_t> materials;
    for (std::size_t f = 0; f < surface.mesh.faces.size(); ++f) {
      const MaterialIndex material = piece.convexes[surface.from[f]]->material;
      materials.push_back(material_of(surface.mesh.faces[f], material, first_appearance));
    }
    shells.push_back(
        {std::make_shared<const PolygonMesh>(std::move(surface.mesh)), std::move(materials)});
  };
  if (walls == Walls::kRemove) {
    bool has_walls = false;
    add(exported_surface(piece, has_walls));
    is_walled = has_walls ? 1 : 0;
    return shells;
  }
  for (std::uint32_t c = 0; c < piece.convexes.size(); ++c) {
    const std::shared_ptr<const PolygonMesh> mesh = surface_of(*piece.convexes[c]);
    OuterSurface surface{*mesh, std::vector<std::uint32_t>(mesh->faces.size(), c)};
    make_triangles_manifold(surface);
    add(std::move(surface));
  }
  return shells;
}

}  // namespace

OuterSurface exported_surface(const Compound& piece, bool& has_walls) {
  std::vector<std::shared_ptr<const PolygonMesh>> meshes;
  std::vector<const PolygonMesh*> pointers;
  for (const ConvexPtr& convex : piece.convexes) {
    meshes.push_back(surface_of(*convex));
    pointers.push_back(meshes.back().get());
  }
  std::optional<OuterSurface> outer = outer_surface(pointers);
  has_walls = !outer;
  if (has_walls) outer = concatenate_meshes(pointers);
  make_triangles_manifold(*outer);
  return std::move(*outer);
}

Model make_model(std::span<const Compound> pieces, std::span<const Material> materials,
                 double explode, std::span<const Appearance> appearances, Walls walls) {
  Model model;
  for (const Material& material : materials) {
    model.materials.push_back({material.name, {material.surface.color, nullptr}});
    model.materials.push_back({material.name + " inside", {material.interior.color, nullptr}});
  }
  const auto first_appearance = static_cast<std::uint32_t>(model.materials.size());
  for (std::size_t p = 0; p < appearances.size(); ++p) {
    model.materials.push_back({"appearance " + std::to_string(p + 1), appearances[p]});
  }
  const auto is_known = [&](const PolygonMesh::Face& face) {
    return face.appearance <= appearances.size();
  };
  Box all;
  for (const Compound& piece : pieces) all.extend(bounds(piece));
  for (std::size_t p = 0; p < pieces.size(); ++p) {
    Model::Part part;
    part.name = part_name(p, pieces.size());
    part.center = bounds(pieces[p]).center();
    part.offset = explode * (part.center - all.center());
    for (const ConvexPtr& convex : pieces[p].convexes) {
      SUNDER_CHECK(!convex->visual || std::ranges::all_of(convex->visual->faces, is_known));
    }
    model.parts.push_back(std::move(part));
  }
  std::vector<std::uint8_t> is_walled(pieces.size(), 0);
  for_chunks(pieces.size(), 1, [&](std::size_t p, std::size_t, std::size_t) {
    model.parts[p].shells = shells_of(pieces[p], first_appearance, walls, is_walled[p]);
  });
  model.parts_with_walls = static_cast<std::size_t>(std::ranges::count(is_walled, 1));
  return model;
}

ShellTriangles triangles_of(const Model::Shell& shell) {
  const PolygonMesh& mesh = *shell.mesh;
  using Key = std::array<float, 5>;
  ShellTriangles result;
  std::map<std::pair<std::uint32_t, Key>, std::uint32_t> known;
  const auto vertex = [&](const PolygonMesh::Face& face, std::uint32_t corner) {
    const std::uint32_t point = mesh.corners[corner];
    Vec3f normal = mesh.corner_normals[corner];
    if (!(std::abs(normal.squaredNorm() - 1) < 1e-3f)) normal = face.plane.normal.cast<float>();
    const Vec2f uv = mesh.corner_uvs.empty() ? planar_uv(mesh.vertices[point], face.plane.normal)
                                             : mesh.corner_uvs[corner];
    const Key key{normal.x(), normal.y(), normal.z(), uv.x(), uv.y()};
    const auto next = static_cast<std::uint32_t>(result.vertices.size());
    const auto [it, is_new] = known.emplace(std::pair{point, key}, next);
    if (is_new) result.vertices.push_back({point, normal, uv});
    return it->second;
  };
  for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
    const PolygonMesh::Face& face = mesh.faces[f];
    auto& indices = result.faces[shell.materials[f]];
    for (const Triangle& corners : triangulate(mesh, f)) {
      for (const std::uint32_t corner : corners) indices.push_back(vertex(face, corner));
    }
  }
  return result;
}

}  // namespace sunder
