#include "scenes/file/make_compound.h"

#include <memory>
#include <utility>

#include "fracture/adjacency/compound_builder.h"
#include "scenes/file/mesh_solid.h"

namespace sunder::scenes {
namespace {

/// The same convexes, of another material.
void set_material(Compound& compound, MaterialIndex material) {
  for (ConvexPtr& convex : compound.convexes) {
    const auto changed = std::make_shared<Convex>(*convex);
    changed->material = material;
    convex = changed;
  }
  for (Ghost& ghost : compound.ghosts) {
    const auto changed = std::make_shared<Convex>(*ghost.convex);
    changed->material = material;
    ghost.convex = changed;
  }
}

}  // namespace

Compound make_compound(std::vector<Part> parts) {
  return fracture::make_compound(std::move(parts));
}

Compound make_compound(const std::string& mesh, MaterialIndex material,
                       const MeshOptions& options) {
  Compound compound = make_mesh_solid(mesh, options).compound;
  set_material(compound, material);
  return compound;
}

std::vector<Compound> split_islands(const Compound& compound) {
  return fracture::split_islands(compound);
}

}  // namespace sunder::scenes
