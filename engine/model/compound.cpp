#include "engine/model/compound.h"

#include <algorithm>
#include <tuple>

#include "engine/base/check.h"
#include "engine/base/roots.h"
#include "engine/geometry/inertia.h"
#include "engine/geometry/polygon_mesh.h"

namespace sunder {
namespace {

// largest thickness of thin convexes over the cube root of their volume
constexpr double kMaxThinness = 0.25;

/// Calls visit(convex, sign) for every convex, and for every ghost that counts in sums.
template <class Visit>
void for_each_solid(const Compound& compound, const Visit& visit) {
  for (const ConvexPtr& convex : compound.convexes) visit(*convex, 1.0);
  for (const Ghost& ghost : compound.ghosts) {
    if (ghost.sign != 0) visit(*ghost.convex, static_cast<double>(ghost.sign));
  }
}

}  // namespace

ConvexPtr make_convex(ConvexPolyhedron polyhedron, MaterialIndex material,
                      std::shared_ptr<const PolygonMesh> visual, const Pose& X_RT) {
  auto convex = std::make_shared<Convex>();
  convex->X_RT = X_RT;
  convex->solid = visual ? mass_properties(*visual) : mass_properties(polyhedron);
  convex->visual = std::move(visual);
  convex->box = bounds(polyhedron);
  convex->material = material;
  convex->polyhedron = std::move(polyhedron);
  return convex;
}

double mean_thickness_m(const Convex& convex) {
  double area_m2 = 0;
  const auto add = [&](const auto& solid) {
    for (std::size_t f = 0; f < solid.faces.size(); ++f) area_m2 += face_area(solid, f);
  };
  convex.visual ? add(*convex.visual) : add(convex.polyhedron);
  return 2 * convex.solid.volume_m3 / area_m2;
}

bool is_thin(const Convex& convex) {
  return mean_thickness_m(convex) < kMaxThinness * cube_root(convex.solid.volume_m3);
}

bool Compound::is_anchored() const {
  return std::any_of(anchored.begin(), anchored.end(), [](std::uint8_t flag) { return flag != 0; });
}

std::uint8_t inherited_anchors(std::uint8_t anchored, const Box& parent, const Box& part) {
  if (anchored == 0) return 0;
  std::uint8_t kept = 0;
  const Vec3 near = 1e-9 * parent.extent();
  for (int axis = 0; axis < 3; ++axis) {
    const auto low = anchor_side(axis, false), high = anchor_side(axis, true);
    if (part.min[axis] <= parent.min[axis] + near[axis]) kept |= low;
    if (part.max[axis] >= parent.max[axis] - near[axis]) kept |= high;
  }
  return kept & anchored;
}

CompoundMass mass_of(const Compound& compound, std::span<const Material> materials) {
  CompoundMass weight;
  Vec3 moment = Vec3::Zero();
  for_each_solid(compound, [&](const Convex& convex, double sign) {
    SUNDER_CHECK(convex.material.value < materials.size());
    const double density = sign * materials[convex.material.value].density_kg_m3;
    weight.mass_kg += density * convex.solid.volume_m3;
    moment += density * convex.solid.volume_m3 * convex.solid.centroid;
  });
  if (weight.mass_kg <= 0) return weight;
  weight.com_R = moment / weight.mass_kg;
  for_each_solid(compound, [&](const Convex& convex, double sign) {
    const double density = sign * materials[convex.material.value].density_kg_m3;
    const double mass = density * convex.solid.volume_m3;
    const Vec3 arm = convex.solid.centroid - weight.com_R;
    weight.inertia_R += density * convex.solid.inertia() +
                        mass * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  });
  weight.inertia_R = bounded_inertia(weight.inertia_R);
  return weight;
}

double volume(const Compound& compound) {
  double sum = 0;
  for_each_solid(compound,
                 [&](const Convex& convex, double sign) { sum += sign * convex.solid.volume_m3; });
  return sum;
}

Box bounds(const Compound& compound) {
  Box box;
  for (const ConvexPtr& convex : compound.convexes) box.extend(convex->box);
  return box;
}

double distance_to(const Convex& convex, const Vec3& point_R) {
  double farthest = 0;
  for (const ConvexPolyhedron::Face& face : convex.polyhedron.faces)
    farthest = std::max(farthest, face.plane.distance(point_R));
  return farthest;
}

void sort_ghosts(std::vector<Ghost>& ghosts) {
  const auto key = [](const Ghost& ghost) {
    const Vec3& at = ghost.convex->solid.centroid;
    return std::tie(ghost.of, ghost.sign, at.x(), at.y(), at.z());
  };
  std::stable_sort(ghosts.begin(), ghosts.end(),
                   [&](const Ghost& a, const Ghost& b) { return key(a) < key(b); });
}

}  // namespace sunder
