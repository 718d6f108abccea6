#include "engine/world/actors/landscape.h"

#include <algorithm>
#include <span>

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

void add_mesh(const GroundMesh& mesh, WorldState& world) {
  std::vector<Facet> facets = make_facets(mesh);
  std::vector<BodyDesc> bodies;
  for (std::size_t first = 0; first < facets.size(); first += kFacetsPerBody) {
    const std::size_t count = std::min(kFacetsPerBody, facets.size() - first);
    bodies.push_back(make_body_desc(std::span(facets).subspan(first, count),
                                    world.material(mesh.material),
                                    world.landscape.facets.size() + first));
  }
  world.physics->replace({}, bodies);
  for (const std::shared_ptr<const Mesh>& drawn : make_meshes(mesh))
    world.landscape.meshes.push_back(world.meshes.add(drawn));
  std::ranges::move(facets, std::back_inserter(world.landscape.facets));
}

}  // namespace

void add_ground(WorldState& world) {
  add_plane(world.scene.ground, *world.physics);
  for (const GroundMesh& mesh : world.scene.ground.meshes) add_mesh(mesh, world);
  for (const Facet& facet : world.landscape.facets) {
    ObstacleShape shape;
    shape.hull = &facet.prism;
    shape.box_R = bounds(facet.prism);
    shape.volume_m3 = mass_properties(facet.prism).volume_m3;
    shape.facet = true;
    world.landscape.obstacles.push_back(shape);
  }
}

}  // namespace sunder
