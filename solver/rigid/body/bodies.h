// Bodies and shapes: structure of arrays by slot. Slots are reused, generations tell old ids apart.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/physics.h"
#include "solver/rigid/body/hull.h"
#include "solver/rigid/body/key_map.h"

namespace sunder::solver {

inline constexpr std::uint32_t kNone = 0xffffffff;

/// What a body is to the solver.
using Motion = BodyMode;

/// Of several bodies.
struct Momentum {
  double mass_kg = 0;
  Vec3 momentum_Ns = Vec3::Zero();
};

/// Arrays over body slots. Positions and velocities are double; the float rotation is a copy.
struct Bodies {
  std::vector<Motion> motion;
  std::vector<std::uint32_t> generation;
  std::vector<Vec3> position;  ///< Of the centre of mass, in W.
  std::vector<Vec3> com_R;
  std::vector<Quat> rotation;
  std::vector<Mat3f> rotation_f;
  std::vector<Vec3> velocity;
  std::vector<Vec3> angular_velocity;
  std::vector<double> mass_kg;  ///< Meaningless for static ones.
  std::vector<Mat3> inertia_B;
  std::vector<float> inverse_mass;  ///< 0 unless dynamic.
  /// G with G·Gᵀ = inverse inertia in B: the columns turn angular impulses into root space, where
  /// every body has unit inertia. 0 unless dynamic.
  std::vector<Mat3f> root_B;
  std::vector<std::uint8_t> spins_freely;  ///< Inertia so uneven that free rotation wobbles.
  std::vector<double> reach_m;             ///< Radius about the centre of mass.
  std::vector<double> turned_m;            ///< Bound on how far turns moved any of its points.
  std::vector<float> slow_s;               ///< Time it has been slow and near its rest pose.
  std::vector<Vec3> rest_position;
  std::vector<Quat> rest_rotation;
  std::vector<std::uint8_t> is_new;   ///< Not solved yet.
  std::vector<std::uint8_t> changed;  ///< Moved, pushed or new since the last collide.
  std::vector<std::uint8_t> reports_load;
  std::vector<std::uint32_t> tag;
  std::vector<std::uint32_t> first_shape;
  std::vector<std::uint32_t> free_slots;

  std::uint32_t size() const { return static_cast<std::uint32_t>(motion.size()); }
  bool awake(std::uint32_t body) const { return motion[body] == Motion::kAwake; }
  /// Takes part in contacts as something that can move, now or once woken.
  bool dynamic(std::uint32_t body) const {
    return motion[body] == Motion::kAwake || motion[body] == Motion::kAsleep;
  }
  bool contains(BodyId id) const {
    return id.slot < size() && generation[id.slot] == id.generation &&
           motion[id.slot] != Motion::kAbsent;
  }
  BodyId id(std::uint32_t body) const { return {body, generation[body]}; }
  BodyStates states() const {
    return {generation, motion, position, rotation, velocity, angular_velocity};
  }
  /// Of all that are not static, in order of slots.
  Momentum momentum() const;

  std::uint32_t add(const BodyDesc& desc);
  void remove(std::uint32_t body);
  /// Sets the pose and what is derived from it.
  void place(std::uint32_t body, const Vec3& position_W, const Quat& rotation_WB);
  bool finite(std::uint32_t body) const;
  /// Stops a body for good; the answer is the momentum that went with it.
  Vec3 freeze(std::uint32_t body);
  /// Wakes a sleeper; others are left as they are.
  void wake(std::uint32_t body);

 private:
  void resize(std::uint32_t count);
};

/// One convex of a body. Spheres: `center` and `radius_m`; half-spaces: `center`, `normal`.
struct Shape {
  ShapeDesc::Kind kind = ShapeDesc::Kind::kHull;
  bool present = false;
  std::uint32_t body = kNone;
  std::uint32_t next = kNone, previous = kNone;  ///< Of the same body.
  std::uint32_t tag = 0;
  float friction = 0;
  float rolling = 0;
  float restitution = 0;
  float radius_m = 0;
  float inner_radius_m = 0;
  float reach_m = 0;  ///< About the body's centre of mass.
  Vec3f center = Vec3f::Zero();
  Vec3f normal = Vec3f::UnitY();
  Hull hull;
};

/// A shape to add to a body that is there.
struct NewShape {
  const ShapeDesc* desc;
  std::uint32_t body;
};

struct Shapes {
  std::vector<Shape> items;
  std::vector<std::uint32_t> free_slots;

  std::uint32_t size() const { return static_cast<std::uint32_t>(items.size()); }
  const Shape& operator[](std::uint32_t i) const { return items[i]; }

  /// Adds shapes (hulls are made in parallel); the answer lists them.
  std::vector<std::uint32_t> add(std::span<const NewShape> added, Bodies& bodies);
  /// Takes shapes out of their bodies.
  void remove(std::span<const std::uint32_t> removed, Bodies& bodies);
  std::vector<std::uint32_t> of_body(std::uint32_t body, const Bodies& bodies) const;
  /// The shape of a static body that has this tag. The body's tags must be unique.
  std::uint32_t with_tag(std::uint32_t body, std::uint32_t tag) const;

 private:
  KeyMap static_with_tag_;  ///< Static shapes by body and tag, the first of each.
};

}  // namespace sunder::solver
