// Bodies and shapes: structure of arrays by slot. Slots are reused, generations tell old ids apart.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/check.h"
#include "engine/model/physics.h"
#include "solver/rigid/body/hull.h"
#include "solver/rigid/body/key_map.h"
#include "solver/rigid/body/slots.h"

namespace sunder::solver {

/// What a body is to the solver.
using Motion = BodyMode;

/// Of several bodies.
struct Momentum {
  double mass_kg = 0;
  Vec3 momentum_Ns = Vec3::Zero();
  double kinetic_J = 0;
};

/// Arrays over body slots. Positions and velocities are double; the float rotation is a copy.
struct Bodies {
  ByBody<Motion> motion;
  ByBody<std::uint32_t> generation;
  ByBody<Vec3> position;  ///< Of the centre of mass, in W.
  ByBody<Vec3> com_R;
  ByBody<Quat> rotation;
  ByBody<Mat3f> rotation_f;
  ByBody<Vec3> velocity;
  ByBody<Vec3> angular_velocity;
  ByBody<double> mass_kg;  ///< Meaningless unless dynamic.
  ByBody<Mat3> inertia_B;
  ByBody<float> inverse_mass;  ///< 0 unless dynamic.
  /// G with G·Gᵀ = inverse inertia in B: the columns turn angular impulses into root space, where
  /// every body has unit inertia. 0 unless dynamic.
  ByBody<Mat3f> root_B;
  ByBody<std::uint8_t> spins_freely;  ///< Inertia so uneven that free rotation wobbles.
  ByBody<double> reach_m;             ///< Radius about the centre of mass.
  ByBody<double> turned_m;            ///< Bound on how far turns moved any of its points.
  ByBody<float> slow_s;               ///< Time it has been slow and near its rest pose.
  ByBody<float> lost_N;               ///< Sum of the forces of contacts it lost in that time.
  ByBody<Vec3> rest_position;
  ByBody<Quat> rest_rotation;
  ByBody<std::uint8_t> is_new;     ///< Not solved yet.
  ByBody<std::uint8_t> changed;    ///< Moved, pushed or new since the last collide.
  ByBody<std::uint8_t> displaced;  ///< Kinematic, and put elsewhere since the last step.
  ByBody<std::uint8_t> reports_load;
  ByBody<std::uint32_t> tag;
  ByBody<ShapeSlot> first_shape;
  std::vector<BodySlot> free_slots;

  std::uint32_t size() const { return static_cast<std::uint32_t>(motion.size()); }
  Slots<BodySlot> slots() const { return motion.slots(); }
  bool awake(BodySlot body) const { return motion[body] == Motion::kAwake; }
  /// Takes part in contacts as something that can move, now or once woken.
  bool dynamic(BodySlot body) const {
    return motion[body] == Motion::kAwake || motion[body] == Motion::kAsleep;
  }
  /// May be elsewhere after a step.
  bool mobile(BodySlot body) const { return dynamic(body) || motion[body] == Motion::kKinematic; }
  /// Is kinematic, and on its way.
  bool carries(BodySlot body) const {
    return motion[body] == Motion::kKinematic &&
           !(velocity[body].isZero(0) && angular_velocity[body].isZero(0));
  }
  /// Is kinematic, and carries or was put elsewhere.
  bool shifts(BodySlot body) const { return displaced[body] || carries(body); }
  bool contains(BodyId id) const {
    const BodySlot body(id.slot);
    return id.slot < size() && generation[body] == id.generation && motion[body] != Motion::kAbsent;
  }
  /// No point of it is faster.
  double fastest_m_s(BodySlot body) const {
    return velocity[body].norm() + angular_velocity[body].norm() * reach_m[body];
  }
  BodyId id(BodySlot body) const { return {body.value, generation[body]}; }
  /// Of a body that is there.
  BodySlot slot(BodyId id) const {
    SUNDER_CHECK(contains(id));
    return BodySlot(id.slot);
  }
  BodyStates states() const {
    return {generation, motion, position, rotation, velocity, angular_velocity};
  }
  double kinetic_J(BodySlot body) const;
  /// Of all that are neither static nor kinematic, in order of slots.
  Momentum momentum() const;

  BodySlot add(const BodyDesc& desc);
  void remove(BodySlot body);
  /// Sets the pose and what is derived from it.
  void place(BodySlot body, const Vec3& position_W, const Quat& rotation_WB);
  bool finite(BodySlot body) const;
  /// Stops a body for good; the answer is the momentum that went with it.
  Vec3 freeze(BodySlot body);
  /// Puts a mobile body into a state of motion and wakes it; others stay as they are.
  void set_state(BodySlot body, const BodyState& state);
  /// Changes the momentum of a dynamic one by an impulse at a point, and wakes it.
  void apply_impulse(BodySlot body, const Vec3& impulse_W, const Vec3& point_W);
  /// Wakes a sleeper; others are left as they are.
  void wake(BodySlot body);
  /// The time at rest counts from now on.
  void restart_rest(BodySlot body);
  /// No body is new or displaced from now on.
  void end_news();

 private:
  void resize(std::uint32_t count);
};

/// One convex of a body. Spheres: `center` and `radius_m`; half-spaces: `center`, `normal`.
struct Shape {
  ShapeDesc::Kind kind = ShapeDesc::Kind::kHull;
  bool present = false;
  BodySlot body;
  ShapeSlot next, previous;  ///< Of the same body.
  std::uint32_t tag = 0;
  float friction = 0;
  float rolling = 0;
  float restitution = 0;
  float radius_m = 0;
  float inner_radius_m = 0;
  float reach_m = 0;  ///< About the body's centre of mass.
  Vec3f center = Vec3f::Zero();
  Vec3f normal = Vec3f::UnitY();
  bool facet = false;  ///< The hull is one, with these bends.
  std::array<Eigen::Vector2f, 3> bends = {};
  Hull hull;
};

/// A shape to add to a body that is there.
struct NewShape {
  const ShapeDesc* desc;
  BodySlot body;
};

struct Shapes {
  ByShape<Shape> items;
  std::vector<ShapeSlot> free_slots;

  std::uint32_t size() const { return static_cast<std::uint32_t>(items.size()); }
  const Shape& operator[](ShapeSlot i) const { return items[i]; }

  /// Adds shapes (hulls are made in parallel); the answer lists them.
  std::vector<ShapeSlot> add(std::span<const NewShape> added, Bodies& bodies);
  /// Takes shapes out of their bodies.
  void remove(std::span<const ShapeSlot> removed, Bodies& bodies);
  std::vector<ShapeSlot> of_body(BodySlot body, const Bodies& bodies) const;
  /// The shape of a static body that has this tag. The body's tags must be unique.
  ShapeSlot with_tag(BodySlot body, std::uint32_t tag) const;

 private:
  KeyMap static_with_tag_;  ///< Static shapes by body and tag, the first of each.
};

}  // namespace sunder::solver
