// The C interface: assets.
#include <algorithm>
#include <span>
#include <string>
#include <utility>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/hull.h"
#include "engine/geometry/raw_mesh.h"
#include "engine/geometry/repair/repair.h"
#include "fracture/vacd/vacd.h"
#include "scenes/api/c_base.h"
#include "scenes/file/make_compound.h"
#include "scenes/file/mesh_solid.h"

namespace sunder::scenes {
namespace {

/// Largest coordinate of a shape.
constexpr double kMaxCoordinate_m = 1e5;

std::vector<Vec3> points_of(const SunderVec3* points, std::uint32_t count,
                            const std::string& name) {
  std::vector<Vec3> found;
  found.reserve(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    need_vector(points[i], kMaxCoordinate_m, name + "[" + std::to_string(i) + "]");
    found.push_back(vec(points[i]));
  }
  return found;
}

Part part_of(const SunderPartDef& def, const std::string& name, Array<SunderMaterial>& own) {
  need_cookie(def.cookie, kPartCookie, name, "sunder_default_part_def");
  Part part;
  if (def.points) {
    part.polyhedron = make_hull(points_of(def.points, def.point_count, name + ".points"));
    if (part.polyhedron.empty() || !(mass_properties(part.polyhedron).volume_m3 > 0))
      refuse(name + ".points span no volume; expected four or more points that are not in a plane");
  } else {
    need_vector(def.box_min, kMaxCoordinate_m, name + ".box_min");
    need_vector(def.box_max, kMaxCoordinate_m, name + ".box_max");
    part.polyhedron = make_box(vec(def.box_min), vec(def.box_max));
  }
  part.material = index_of(def.material, name + ".material", own);
  part.anchored = def.anchored ? 1 : 0;
  return part;
}

/// Returns the decomposition of the triangles of a definition.
Compound triangle_compound(const SunderMeshDef& def, const MeshOptions& options,
                           MaterialIndex material) {
  need_pointer(def.vertices, "mesh.vertices");
  need_pointer(def.indices, "mesh.indices");
  if (def.index_count == 0 || def.index_count % 3 != 0)
    refuse("mesh.index_count is " + std::to_string(def.index_count) +
           "; expected three for each triangle");
  RawMesh raw;
  raw.vertices = points_of(def.vertices, def.vertex_count, "mesh.vertices");
  raw.corners.assign(def.indices, def.indices + def.index_count);
  for (std::uint32_t i = 0; i < def.index_count; ++i) {
    if (raw.corners[i] >= def.vertex_count)
      refuse("mesh.indices[" + std::to_string(i) + "] is " + std::to_string(raw.corners[i]) +
             "; expected an index below " + std::to_string(def.vertex_count));
    if (i % 3 == 0) raw.polygons.push_back({i, 3});
  }
  MeshSolid solid = make_mesh_solid(std::move(raw), "mesh", options);
  set_materials(solid.compound, {material});
  return moved(solid.compound, solid.origin);
}

SunderAsset store(Compound compound, Array<SunderMaterial> own) {
  return add_asset(std::allocate_shared<AssetEntry>(
      HookAllocator<AssetEntry>(), AssetEntry{Asset(std::move(compound)), std::move(own)}));
}

}  // namespace
}  // namespace sunder::scenes

using namespace sunder;
using namespace sunder::scenes;

SunderPartDef sunder_default_part_def() {
  SunderPartDef def{};
  def.cookie = kPartCookie;
  def.box_min = {-0.5, -0.5, -0.5};
  def.box_max = {0.5, 0.5, 0.5};
  def.material = default_material("concrete");
  return def;
}

SunderMeshDef sunder_default_mesh_def() {
  SunderMeshDef def{};
  def.cookie = kMeshCookie;
  def.material = default_material("concrete");
  def.repair = true;
  def.scale = 1;
  return def;
}

SunderResult sunder_asset_create_parts(const SunderPartDef* parts, uint32_t count,
                                       SunderAsset* asset) {
  return guard("sunder_asset_create_parts", SUNDER_ERROR_ARGUMENT, [&] {
    need_pointer(parts, "parts");
    need_pointer(asset, "asset");
    if (count == 0) refuse("count is 0; expected one part or more");
    std::vector<Part> made;
    Array<SunderMaterial> own;
    for (std::uint32_t i = 0; i < count; ++i)
      made.push_back(part_of(parts[i], "parts[" + std::to_string(i) + "]", own));
    *asset = store(make_compound(std::move(made)), std::move(own));
  });
}

SunderResult sunder_asset_create_mesh(const SunderMeshDef* mesh, SunderAsset* asset) {
  return guard("sunder_asset_create_mesh", SUNDER_ERROR_INPUT, [&] {
    need_def(mesh, kMeshCookie, "mesh", "sunder_default_mesh_def");
    need_pointer(asset, "asset");
    Array<SunderMaterial> own;
    const MaterialIndex material = index_of(mesh->material, "mesh.material", own);
    MeshOptions options;
    options.nodes = text_of(mesh->nodes);
    options.convexes = mesh->convexes;
    if (mesh->fit) options.fit = mesh->fit;
    options.repair = mesh->repair ? "auto" : "off";
    if (!mesh->mesh) {
      *asset = store(triangle_compound(*mesh, options, material), std::move(own));
      return;
    }
    need_number(mesh->scale, 1e-9, 1e9, "mesh.scale");
    need_number(mesh->size_m, 0, kMaxCoordinate_m, "mesh.size_m");
    options.scale = mesh->scale;
    if (mesh->size_m > 0) options.size_m = mesh->size_m;
    *asset = store(make_compound(mesh->mesh, material, options), std::move(own));
  });
}

SunderResult sunder_asset_destroy(SunderAsset asset) {
  return guard("sunder_asset_destroy", SUNDER_ERROR_ARGUMENT, [&] { take_asset(asset); });
}

bool sunder_asset_is_valid(SunderAsset asset) { return has_asset(asset); }

SunderResult sunder_asset_info(SunderAsset asset, SunderAssetInfo* info) {
  return guard("sunder_asset_info", SUNDER_ERROR_ARGUMENT, [&] {
    const AssetPtr entry = find_asset(asset);
    need_pointer(info, "info");
    const Compound& compound = entry->asset.compound();
    const Box box = bounds(compound);
    *info = {count_of(compound.convexes.size()),
             count_of(compound.bonds.size()),
             volume(compound),
             vec(box.min),
             vec(box.max),
             compound.is_anchored()};
  });
}
