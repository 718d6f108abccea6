#include "engine/world/actors/landscape.h"

#include <algorithm>
#include <span>
#include <utility>

#include "engine/base/archive.h"
#include "engine/world/actors/world_state.h"

namespace sunder {
namespace {

constexpr CollisionFilter kGroundFilter{0xffffffff, 0xffffffff};
constexpr std::size_t kFacetsPerBody = 256;  // neighbours: lengths within a body are floats

void add_plane(const Ground& ground, Physics& physics) {
  ShapeDesc plane;
  plane.kind = ShapeDesc::Kind::kHalfSpace;
  plane.friction = ground.friction;
  plane.restitution = ground.restitution;
  plane.tag = kGroundPlaneTag;
  BodyDesc body;
  body.X_WB.position = Vec3(0, ground.height_m, 0);
  body.is_static = true;
  body.shapes = {plane};
  body.tag = kGroundKey;
  body.filter = kGroundFilter;
  physics.replace({}, std::span(&body, 1));
}

/// Returns a body of facets, whose tags begin with `tag`.
BodyDesc make_body_desc(std::span<const Facet> facets, const Material& material, std::size_t tag) {
  BodyDesc body;
  body.is_static = true;
  body.tag = kGroundKey;
  body.filter = kGroundFilter;
  Box box;
  for (const Facet& facet : facets) {
    box.extend(bounds(facet.prism));
    ShapeDesc shape;
    shape.hull = &facet.prism;
    shape.bends = facet.bends;
    shape.friction = material.friction;
    shape.restitution = material.restitution;
    shape.rolling = material.rolling;
    shape.tag = static_cast<std::uint32_t>(tag++);
    body.shapes.push_back(shape);
  }
  body.X_WB.position = body.com_R = box.center();
  return body;
}

/// Adds a mesh to the world, and its facets to `all`.
void add_mesh(const GroundMesh& mesh, WorldState& world, std::vector<Facet>& all) {
  std::vector<Facet> facets = make_facets(mesh);
  std::vector<BodyDesc> bodies;
  for (std::size_t first = 0; first < facets.size(); first += kFacetsPerBody) {
    const std::size_t count = std::min(kFacetsPerBody, facets.size() - first);
    bodies.push_back(make_body_desc(std::span(facets).subspan(first, count),
                                    world.material(mesh.material), all.size() + first));
  }
  world.physics->replace({}, bodies);
  for (const std::shared_ptr<const Mesh>& drawn : make_meshes(mesh))
    world.landscape.meshes.push_back(world.meshes.add(drawn));
  std::ranges::move(facets, std::back_inserter(all));
}

void find_obstacles(Landscape& landscape) {
  landscape.obstacles.clear();
  for (const Facet& facet : *landscape.facets) {
    ObstacleShape shape;
    shape.hull = &facet.prism;
    shape.box_R = bounds(facet.prism);
    shape.volume_m3 = mass_properties(facet.prism).volume_m3;
    shape.facet = true;
    landscape.obstacles.push_back(shape);
  }
}

}  // namespace

void add_ground(WorldState& world) {
  add_plane(world.scene.ground, *world.physics);
  std::vector<Facet> facets;
  for (const GroundMesh& mesh : world.scene.ground.meshes) add_mesh(mesh, world, facets);
  world.landscape.facets = std::make_shared<const std::vector<Facet>>(std::move(facets));
  find_obstacles(world.landscape);
}

void archive(Archive& bytes, Landscape& landscape) {
  bytes(landscape.facets, landscape.meshes);
  if (bytes.reads()) find_obstacles(landscape);
}

}  // namespace sunder
