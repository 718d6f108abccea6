#include "scenes/file/make_compound.h"

#include <algorithm>
#include <memory>
#include <utility>

#include "engine/geometry/polygon_mesh.h"
#include "fracture/adjacency/compound_builder.h"
#include "scenes/file/mesh_solid.h"

namespace sunder::scenes {
namespace {

template <class Solid>
Solid moved_solid(Solid solid, const Vec3& by) {
  for (Vec3& vertex : solid.vertices) vertex += by;
  for (auto& face : solid.faces) face.plane.d -= face.plane.normal.dot(by);
  return solid;
}

}  // namespace

Compound make_compound(std::vector<Part> parts) {
  return fracture::make_compound(std::move(parts));
}

Compound make_compound(const std::string& mesh, MaterialIndex material,
                       const MeshOptions& options) {
  MeshSolid solid = make_mesh_solid(mesh, options);
  for (const std::string& warning : solid.warnings) {
    if (!options.appearances || !options.warnings) break;
    if (std::ranges::count(*options.warnings, warning) == 0) options.warnings->push_back(warning);
  }
  Compound compound = std::move(solid.compound);
  if (!options.centered) compound = moved(compound, solid.origin);
  std::vector<MaterialIndex> materials = {material};
  for (const auto& [name, of] : options.materials) materials.push_back(of);
  set_materials(compound, materials);
  return compound;
}

Compound moved(const Compound& compound, const Vec3& by) {
  Compound all = compound;
  if (by.isZero(0)) return all;
  const auto move = [&](ConvexPtr& convex) {
    const auto there = std::make_shared<Convex>(*convex);
    there->polyhedron = moved_solid(convex->polyhedron, by);
    if (convex->visual)
      there->visual = std::make_shared<const PolygonMesh>(moved_solid(*convex->visual, by));
    there->solid.centroid += by;
    there->box = bounds(there->polyhedron);
    there->X_RT.position += by;
    convex = there;
  };
  for (ConvexPtr& convex : all.convexes) move(convex);
  for (Ghost& ghost : all.ghosts) move(ghost.convex);
  return all;
}

std::vector<Compound> split_islands(const Compound& compound) {
  return fracture::split_islands(compound);
}

}  // namespace sunder::scenes
