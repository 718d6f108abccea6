// Bodies (a structure of arrays) and shapes (an array of structures), both by slot. Slots are
// reused; a generation in the id tells old ids from new ones.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <tuple>
#include <vector>

#include "engine/base/check.h"
#include "engine/model/physics.h"
#include "solver/rigid/body/hull.h"
#include "solver/rigid/body/key_map.h"
#include "solver/rigid/body/slots.h"

namespace sunder::solver {

/// Mode of motion of a body.
using Motion = BodyMode;

/// Mass, momentum and kinetic energy of several bodies.
struct Momentum {
  double mass_kg = 0;
  Vec3 momentum_Ns = Vec3::Zero();
  double kinetic_J = 0;
};

/// Arrays over body slots. Positions and velocities are double; `rotation_f` is the matrix of
/// `rotation`, in float.
struct Bodies {
  ByBody<Motion> motion;
  ByBody<std::uint32_t> generation;
  ByBody<Vec3> position;  ///< Position of the centre of mass, in W.
  ByBody<Vec3> com_R;     ///< Centre of mass in the rest frame R, in which solids are modelled.
  ByBody<Quat> rotation;
  ByBody<Mat3f> rotation_f;
  ByBody<Vec3> velocity;
  ByBody<Vec3> angular_velocity;
  ByBody<double> mass_kg;  ///< Mass; valid only for dynamic bodies.
  ByBody<Mat3> inertia_B;
  ByBody<float> inverse_mass;  ///< 0 unless dynamic.
  /// G with G·Gᵀ = inverse inertia in B: Gᵀ maps an angular impulse to root space, where every body
  /// has unit inertia, and G maps back to angular velocity. 0 unless dynamic.
  ByBody<Mat3f> root_B;
  /// 1: the principal moments differ, so free rotation has a gyroscopic term.
  ByBody<std::uint8_t> is_gyroscopic;
  ByBody<double> reach_m;  ///< Radius of a sphere about the centre of mass that has all shapes.
  ByBody<double> rotation_path_m;  ///< Upper bound on the path of any point by rotation since the
                                   ///< body was added.
  ByBody<float> slow_s;            ///< Time that the body has been slow.
  ByBody<float> resting_s;         ///< Time of it that the body has been near its rest pose.
  ByBody<float> lost_N;            ///< Sum of the forces of contacts that ended in that time.
  ByBody<Vec3> rest_position;      ///< Pose at the start of that time.
  ByBody<Quat> rest_rotation;
  ByBody<std::uint8_t> is_new;        ///< 1: not solved yet.
  ByBody<std::uint8_t> changed;       ///< 1: moved, pushed or new since the last collide().
  ByBody<std::uint8_t> displaced;     ///< 1: kinematic, and its pose was set since the last step.
  ByBody<std::uint8_t> reports_load;  ///< 1: in contact_impulses() and joint_impulses().
  ByBody<std::uint32_t> tag;          ///< Given by the caller; not read by the solver.
  ByBody<CollisionFilter> filter;
  ByBody<ShapeSlot> first_shape;
  std::vector<BodySlot> free_slots;

  std::uint32_t size() const { return static_cast<std::uint32_t>(motion.size()); }
  Slots<BodySlot> slots() const { return motion.slots(); }
  bool awake(BodySlot body) const { return motion[body] == Motion::kAwake; }
  /// True if the body has mass and can move, now or once woken.
  bool dynamic(BodySlot body) const {
    return motion[body] == Motion::kAwake || motion[body] == Motion::kAsleep;
  }
  /// True if the pose may change in a step.
  bool mobile(BodySlot body) const { return dynamic(body) || motion[body] == Motion::kKinematic; }
  /// True if the body is kinematic and moves.
  bool is_moving_kinematic(BodySlot body) const {
    return motion[body] == Motion::kKinematic &&
           !(velocity[body].isZero(0) && angular_velocity[body].isZero(0));
  }
  /// True if the body is kinematic and moves, or its pose was set since the last step.
  bool is_shifting_kinematic(BodySlot body) const {
    return displaced[body] || is_moving_kinematic(body);
  }
  bool contains(BodyId id) const {
    const BodySlot body(id.slot);
    return id.slot < size() && generation[body] == id.generation && motion[body] != Motion::kAbsent;
  }
  /// Upper bound on the speed of any point of the body.
  double fastest_m_s(BodySlot body) const {
    return velocity[body].norm() + angular_velocity[body].norm() * reach_m[body];
  }
  BodyId id(BodySlot body) const { return {body.value, generation[body]}; }
  /// Returns the slot of a body, which must exist.
  BodySlot slot(BodyId id) const {
    SUNDER_CHECK(contains(id));
    return BodySlot(id.slot);
  }
  BodyStates states() const {
    return {generation, motion, position, rotation, velocity, angular_velocity};
  }
  double kinetic_J(BodySlot body) const;
  /// Returns the sums over dynamic and frozen bodies, in order of slots; only awake ones have
  /// momentum.
  Momentum momentum() const;

  BodySlot add(const BodyDesc& desc);
  void remove(BodySlot body);
  /// Sets the pose and what is derived from it.
  void place(BodySlot body, const Vec3& position_W, const Quat& rotation_WB);
  bool has_finite_pose(BodySlot body) const;
  /// True if the pose is finite, and the speeds are within the ranges of scenes.
  bool is_within_limits(BodySlot body) const;
  /// Slows a body down to the ranges of scenes, if it is finite; returns the momentum and energy
  /// that this takes.
  std::optional<Momentum> slow_down(BodySlot body);
  /// Freezes a body for good and returns the momentum that it had.
  Vec3 freeze(BodySlot body);
  /// Sets the state of motion of a mobile body and wakes it; has no effect on other bodies.
  void set_state(BodySlot body, const BodyState& state);
  /// Applies an impulse at a point to a dynamic body, and wakes it.
  void apply_impulse(BodySlot body, const Vec3& impulse_W, const Vec3& point_W);
  /// Wakes a sleeping body; has no effect on other bodies.
  void wake(BodySlot body);
  /// Restarts the time of rest.
  void restart_rest(BodySlot body);
  /// Restarts it, and the time that the body has been slow.
  void disturb(BodySlot body);
  /// Clears the flags `is_new` and `displaced` of all bodies.
  void clear_step_flags();

  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  void resize(std::uint32_t count);
};

/// One convex of a body. Spheres use `center` and `radius_m`; half-spaces `center` and `normal`.
struct Shape {
  ShapeDesc::Kind kind = ShapeDesc::Kind::kHull;
  BodySlot body;
  ShapeSlot next, previous;  ///< Other shapes of the body, a linked list.
  std::uint32_t tag = 0;
  float friction = 0;
  float rolling = 0;
  float restitution = 0;
  float radius_m = 0;
  /// From `center` to the nearest face, at least a fraction of the reach: the unit of tolerances.
  /// 1e30 for half-spaces.
  float inner_radius_m = 0;
  float reach_m = 0;  ///< From the body's centre of mass to the farthest point.
  Vec3f center = Vec3f::Zero();
  Vec3f normal = Vec3f::UnitY();
  bool facet = false;  ///< The hull is a triangle of a surface that collides with its front only.
  std::array<Eigen::Vector2f, 3> bends = {
      Eigen::Vector2f::Zero(), Eigen::Vector2f::Zero(),
      Eigen::Vector2f::Zero()};  ///< (cos, sin) of the angle at each edge.
  Hull hull;

  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
};

/// A shape to add to an existing body.
struct NewShape {
  const ShapeDesc* desc;
  BodySlot body;
};

struct Shapes {
  ByShape<Shape> items;
  std::vector<ShapeSlot> free_slots;

  std::uint32_t size() const { return static_cast<std::uint32_t>(items.size()); }
  const Shape& operator[](ShapeSlot i) const { return items[i]; }

  /// Adds shapes, whose hulls are made in parallel, and returns their slots.
  std::vector<ShapeSlot> add(std::span<const NewShape> added, Bodies& bodies);
  /// Removes shapes from their bodies.
  void remove(std::span<const ShapeSlot> removed, Bodies& bodies);
  std::vector<ShapeSlot> of_body(BodySlot body, const Bodies& bodies) const;
  /// Returns the shape of a static body that has a tag. The tags of the body must be unique.
  ShapeSlot with_tag(BodySlot body, std::uint32_t tag) const;

  static auto fields(auto& self) {
    return std::tie(self.items, self.free_slots, self.static_with_tag_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
  /// As wrong_field(), of the bodies whose shapes they are.
  const char* wrong_field(const Bodies& bodies) const;

 private:
  KeyMap static_with_tag_;  ///< Static shapes by body and tag; the first of each tag.
};

}  // namespace sunder::solver
