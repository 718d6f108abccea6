#include "engine/world/compound.h"

#include <algorithm>

#include "engine/base/check.h"
#include "engine/geometry/polygon_mesh.h"

namespace sunder {

ConvexPtr make_convex(ConvexPolyhedron polyhedron, MaterialIndex material,
                      std::shared_ptr<const PolygonMesh> visual) {
  auto convex = std::make_shared<Convex>();
  convex->solid = visual ? mass_properties(*visual) : mass_properties(polyhedron);
  convex->visual = std::move(visual);
  convex->box = bounds(polyhedron);
  convex->material = material;
  convex->polyhedron = std::move(polyhedron);
  return convex;
}

bool Compound::is_anchored() const {
  return std::any_of(anchored.begin(), anchored.end(), [](std::uint8_t flag) { return flag != 0; });
}

Weight weigh(const Compound& compound, std::span<const Material> materials) {
  Weight weight;
  Vec3 moment = Vec3::Zero();
  for (const ConvexPtr& convex : compound.convexes) {
    SUNDER_CHECK(convex->material.value < materials.size());
    const double mass = convex->solid.volume_m3 * materials[convex->material.value].density_kg_m3;
    weight.mass_kg += mass;
    moment += mass * convex->solid.centroid;
  }
  if (weight.mass_kg <= 0) return weight;
  weight.com_R = moment / weight.mass_kg;
  for (const ConvexPtr& convex : compound.convexes) {
    const double density = materials[convex->material.value].density_kg_m3;
    const double mass = convex->solid.volume_m3 * density;
    const Vec3 arm = convex->solid.centroid - weight.com_R;
    weight.inertia_R += density * convex->solid.inertia() +
                        mass * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  return weight;
}

double volume(const Compound& compound) {
  double sum = 0;
  for (const ConvexPtr& convex : compound.convexes) sum += convex->solid.volume_m3;
  return sum;
}

Box bounds(const Compound& compound) {
  Box box;
  for (const ConvexPtr& convex : compound.convexes) box.extend(convex->box);
  return box;
}

}  // namespace sunder
