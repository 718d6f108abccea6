#include "scenes/file/make_compound.h"

#include <algorithm>
#include <utility>

#include "fracture/adjacency/compound_builder.h"
#include "scenes/file/mesh_solid.h"

namespace sunder::scenes {
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
  std::vector<MaterialIndex> materials = {material};
  for (const auto& [name, of] : options.materials) materials.push_back(of);
  set_materials(compound, materials);
  return compound;
}

std::vector<Compound> split_islands(const Compound& compound) {
  return fracture::split_islands(compound);
}

}  // namespace sunder::scenes
