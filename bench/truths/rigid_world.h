// A physics world for validation cases and tests, with short functions that make bodies.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "engine/base/hash.h"
#include "engine/base/random.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/hull.h"
#include "engine/geometry/inertia.h"
#include "solver/rigid/rigid_physics.h"

namespace sunder::solver {

/// A physics world that keeps mass and inertia of the bodies added to it.
class RigidWorld {
 public:
  explicit RigidWorld(const RigidOptions& options = {}) : physics_(make_rigid_physics(options)) {}
  explicit RigidWorld(std::unique_ptr<Physics> physics) : physics_(std::move(physics)) {}

  static BodyDesc box(const Vec3& size, const Vec3& center_W, double density = 1000) {
    BodyDesc desc;
    desc.X_WB.position = center_W;
    desc.mass_kg = density * size.prod();
    const Vec3 s = size.cwiseAbs2();
    desc.inertia_B =
        Vec3(s.y() + s.z(), s.x() + s.z(), s.x() + s.y()).asDiagonal() * (desc.mass_kg / 12);
    return with_hull(desc, make_box(-0.5 * size, 0.5 * size));
  }
  /// Returns a body with the shape `convex`, whose centre of mass is placed at `center_W`.
  static BodyDesc hull(const ConvexPolyhedron& convex, const Vec3& center_W,
                       double density = 1000) {
    BodyDesc desc;
    const MassProperties solid = mass_properties(convex);
    desc.com_R = solid.centroid;
    desc.X_WB.position = center_W;
    desc.mass_kg = density * solid.volume_m3;
    desc.inertia_B = density * solid.inertia();
    return with_hull(desc, convex);
  }
  static BodyDesc sphere(double radius_m, const Vec3& center_W, double density = 1000) {
    BodyDesc desc;
    desc.X_WB.position = center_W;
    desc.mass_kg = density * 4 / 3 * 3.14159265358979 * radius_m * radius_m * radius_m;
    desc.inertia_B = Mat3::Identity() * (0.4 * desc.mass_kg * radius_m * radius_m);
    ShapeDesc shape;
    shape.kind = ShapeDesc::Kind::kSphere;
    shape.radius_m = radius_m;
    desc.shapes = {shape};
    return desc;
  }
  static BodyDesc ground(const Vec3& normal_W = Vec3::UnitY()) {
    BodyDesc desc;
    desc.is_static = true;
    ShapeDesc shape;
    shape.kind = ShapeDesc::Kind::kHalfSpace;
    shape.normal_R = normal_W;
    desc.shapes = {shape};
    return desc;
  }
  /// Returns stone `i` of a semicircular arch of `count` stones about a circle of radius 1,
  /// `thickness` m thick. Its friction coefficient is 1.
  static BodyDesc voussoir(int i, int count, double thickness) {
    std::vector<Vec3> corners;
    for (int end = 0; end < 2; ++end) {
      const SinCos a = sin_cos(std::numbers::pi * (i + end) / count);
      for (const double radius : {1 - 0.5 * thickness, 1 + 0.5 * thickness})
        for (const double z : {-0.25, 0.25})
          corners.emplace_back(radius * a.cos, radius * a.sin, z);
    }
    const ConvexPolyhedron stone = make_hull(corners);
    return with_friction(hull(stone, mass_properties(stone).centroid, 2000), 1);
  }
  static BodyDesc fixed(BodyDesc desc) {
    desc.is_static = true;
    return desc;
  }
  static BodyDesc moving(BodyDesc desc, const Vec3& velocity_W,
                         const Vec3& angular_velocity_W = Vec3::Zero()) {
    desc.velocity_W = velocity_W, desc.angular_velocity_W = angular_velocity_W;
    return desc;
  }
  static BodyDesc with_friction(BodyDesc desc, double friction, double restitution = 0) {
    for (ShapeDesc& shape : desc.shapes) shape.friction = friction, shape.restitution = restitution;
    return desc;
  }

  /// Copies the hull and keeps the copy until the program ends; a description needs its hull.
  static const ConvexPolyhedron* keep(const ConvexPolyhedron& convex) {
    static std::vector<std::shared_ptr<ConvexPolyhedron>> kept;
    kept.push_back(std::make_shared<ConvexPolyhedron>(convex));
    return kept.back().get();
  }

  BodyId add(const BodyDesc& desc) {
    ids_.push_back(physics_->replace({}, std::span(&desc, 1)).front());
    masses_.push_back(desc.is_static ? 0 : desc.mass_kg);
    inertias_.push_back(bounded_inertia(desc.inertia_B));
    return ids_.back();
  }
  void remove(BodyId id) {
    physics_->replace(std::span(&id, 1), {});
    for (std::size_t i = 0; i < ids_.size(); ++i)
      if (ids_[i] == id) masses_[i] = -1;
  }
  /// Removes and adds bodies in one call, as when a solid breaks.
  std::vector<BodyId> replace(const std::vector<BodyId>& remove, const std::vector<BodyDesc>& add) {
    for (std::size_t i = 0; i < ids_.size(); ++i)
      if (std::find(remove.begin(), remove.end(), ids_[i]) != remove.end()) masses_[i] = -1;
    const std::vector<BodyId> ids = physics_->replace(remove, add);
    for (std::size_t i = 0; i < add.size(); ++i) {
      ids_.push_back(ids[i]);
      masses_.push_back(add[i].is_static ? 0 : add[i].mass_kg);
      inertias_.push_back(bounded_inertia(add[i].inertia_B));
    }
    return ids;
  }
  SolveReport step(double dt_s, int substeps) {
    physics_->collide(dt_s);
    return physics_->solve(dt_s, substeps);
  }
  SolveReport run(double time_s, double dt_s, int substeps) {
    SolveReport report;
    const auto steps = static_cast<int>(std::lround(time_s / dt_s));
    for (int i = 0; i < steps; ++i) report = step(dt_s, substeps);
    return report;
  }

  Physics& physics() { return *physics_; }
  BodyState state(BodyId id) const { return physics_->state(id); }
  std::size_t size() const { return ids_.size(); }
  BodyId id(std::size_t i) const { return ids_[i]; }

  Vec3 momentum() const {
    Vec3 sum = Vec3::Zero();
    for_dynamic([&](const BodyState& s, double m, const Mat3&) { sum += m * s.velocity_W; });
    return sum;
  }
  Vec3 angular_momentum() const {
    Vec3 sum = Vec3::Zero();
    for_dynamic([&](const BodyState& s, double m, const Mat3& inertia_B) {
      const Mat3 R = s.X_WB.rotation.toRotationMatrix();
      sum += m * s.X_WB.position.cross(s.velocity_W) +
             R * inertia_B * R.transpose() * s.angular_velocity_W;
    });
    return sum;
  }
  double kinetic_energy() const {
    double sum = 0;
    for_dynamic([&](const BodyState& s, double m, const Mat3& inertia_B) {
      const Vec3 w_B = s.X_WB.rotation.conjugate() * s.angular_velocity_W;
      sum += 0.5 * m * s.velocity_W.squaredNorm() + 0.5 * w_B.dot(inertia_B * w_B);
    });
    return sum;
  }
  double potential_energy(double g) const {
    double sum = 0;
    for_dynamic(
        [&](const BodyState& s, double m, const Mat3&) { sum += m * g * s.X_WB.position.y(); });
    return sum;
  }
  /// Returns a hash of all bits of poses and velocities of dynamic bodies.
  std::uint64_t hash() const {
    std::uint64_t h = 0;
    for_dynamic([&](const BodyState& s, double, const Mat3&) {
      const double values[] = {
          s.X_WB.position.x(),     s.X_WB.position.y(),      s.X_WB.position.z(),
          s.X_WB.rotation.x(),     s.X_WB.rotation.y(),      s.X_WB.rotation.z(),
          s.X_WB.rotation.w(),     s.velocity_W.x(),         s.velocity_W.y(),
          s.velocity_W.z(),        s.angular_velocity_W.x(), s.angular_velocity_W.y(),
          s.angular_velocity_W.z()};
      for (const double value : values) {
        std::uint64_t word;
        std::memcpy(&word, &value, sizeof word);
        h = combine(h, word);
      }
    });
    return h;
  }

 private:
  static BodyDesc with_hull(BodyDesc desc, const ConvexPolyhedron& convex) {
    ShapeDesc shape;
    shape.hull = keep(convex);
    desc.shapes = {shape};
    return desc;
  }
  template <class Visit>
  void for_dynamic(const Visit& visit) const {
    for (std::size_t i = 0; i < ids_.size(); ++i)
      if (masses_[i] > 0) visit(state(ids_[i]), masses_[i], inertias_[i]);
  }

  std::unique_ptr<Physics> physics_;
  std::vector<BodyId> ids_;
  std::vector<double> masses_;
  std::vector<Mat3> inertias_;
};

/// Returns a joint at `at_W` between two bodies at their present poses; a missing body is the
/// world.
inline JointDesc joint_at(const RigidWorld& world, JointKind kind, BodyId a, BodyId b,
                          const Vec3& at_W, const Vec3& axis_W = Vec3::UnitZ()) {
  JointDesc joint;
  joint.kind = kind;
  joint.a = a, joint.b = b;
  const Pose X_WA = a.none() ? Pose{} : world.state(a).X_WB;
  const Pose X_WB = b.none() ? Pose{} : world.state(b).X_WB;
  joint.anchor_a_R = X_WA.inverse() * at_W, joint.anchor_b_R = X_WB.inverse() * at_W;
  joint.axis_a_R = X_WA.rotation.conjugate() * axis_W;
  joint.axis_b_R = X_WB.rotation.conjugate() * axis_W;
  joint.rotation_RaRb = X_WA.rotation.conjugate() * X_WB.rotation;
  return joint;
}

}  // namespace sunder::solver
