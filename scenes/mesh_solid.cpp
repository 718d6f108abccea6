#include "scenes/mesh_solid.h"

#include "engine/base/trace.h"
#include "fracture/solids.h"

namespace sunder::scenes {

MeshSolid as_mesh_solid(const std::string& name, Compound compound) {
  MeshSolid solid;
  solid.name = name;
  solid.compound = std::move(compound);
  for (const ConvexPtr& convex : solid.compound.convexes) {
    solid.vertices += convex->polyhedron.vertices.size();
    solid.faces += convex->polyhedron.faces.size();
  }
  return solid;
}

MeshSolid make_mesh_solid(const std::string& mesh) {
  const Stopwatch watch;
  MeshSolid solid = as_mesh_solid(mesh, fracture::make_solid(mesh));
  solid.prepare_ms = watch.ms();
  return solid;
}

}  // namespace sunder::scenes
