#include "scenes/file/make_compound.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "engine/geometry/polygon_mesh.h"
#include "fracture/adjacency/compound_builder.h"
#include "scenes/file/mesh_solid.h"

namespace sunder::scenes {
namespace {

/// The same convexes, of the materials that theirs are numbers of.
void set_materials(Compound& compound, const std::vector<MaterialIndex>& materials) {
  const auto change = [&](ConvexPtr& convex) {
    const auto changed = std::make_shared<Convex>(*convex);
    changed->material = materials[convex->material.value];
    convex = changed;
  };
  for (ConvexPtr& convex : compound.convexes) change(convex);
  for (Ghost& ghost : compound.ghosts) change(ghost.convex);
}

/// By group of a file, the number that its paint has among those of the scene, from 1; 0: none.
std::vector<std::uint32_t> add_paints(const std::vector<std::optional<Paint>>& of_groups,
                                      std::vector<Paint>& paints) {
  std::vector<std::uint32_t> numbers;
  for (const std::optional<Paint>& paint : of_groups) {
    numbers.push_back(0);
    if (!paint) continue;
    const auto known = std::find(paints.begin(), paints.end(), *paint);
    numbers.back() = static_cast<std::uint32_t>(known - paints.begin()) + 1;
    if (known == paints.end()) paints.push_back(*paint);
  }
  return numbers;
}

/// The same convexes, their faces marked by paints in place of groups.
void set_paints(Compound& compound, const std::vector<std::uint32_t>& paints) {
  for (ConvexPtr& convex : compound.convexes) {
    if (!convex->visual) continue;
    auto mesh = std::make_shared<PolygonMesh>(*convex->visual);
    for (PolygonMesh::Face& face : mesh->faces) {
      face.mark = face.mark > 0 && face.mark <= paints.size() ? paints[face.mark - 1] : 0;
    }
    const auto changed = std::make_shared<Convex>(*convex);
    changed->visual = std::move(mesh);
    convex = changed;
  }
}

}  // namespace

Compound make_compound(std::vector<Part> parts) {
  return fracture::make_compound(std::move(parts));
}

Compound make_compound(const std::string& mesh, MaterialIndex material,
                       const MeshOptions& options) {
  MeshSolid solid = make_mesh_solid(mesh, options);
  Compound compound = std::move(solid.compound);
  std::vector<MaterialIndex> materials = {material};
  for (const auto& [name, of] : options.materials) materials.push_back(of);
  set_materials(compound, materials);
  set_paints(compound, options.paints ? add_paints(solid.paints, *options.paints)
                                      : std::vector<std::uint32_t>());
  return compound;
}

std::vector<Compound> split_islands(const Compound& compound) {
  return fracture::split_islands(compound);
}

}  // namespace sunder::scenes
