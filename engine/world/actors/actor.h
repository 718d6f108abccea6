// A solid in the running world: read Actor. Internal to engine/world.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/base/roots.h"
#include "engine/base/types.h"
#include "engine/model/breaker.h"
#include "engine/model/compound.h"
#include "engine/model/frame.h"
#include "engine/model/impact_probe.h"
#include "engine/model/physics.h"
#include "engine/model/structure.h"

namespace sunder {

/// Loads on an actor, and the state of the stress solution for them.
struct StressState {
  static constexpr bool kMayBeInfinite = true;  ///< Numbers may be infinite: archive.h.
  bool breakable = false;                       ///< Load can break the actor.
  bool settled = false;          ///< The stress solve for the evaluated loads is complete.
  std::uint64_t since_step = 0;  ///< First step with unevaluated loads, if not settled.
  /// Averaged over time; ascending by convex. Torques are about the centroid of the convex, and
  /// `point_R` is unused, here and in `evaluated_forces`.
  std::vector<AppliedForce> mean_forces;
  std::vector<AppliedForce> evaluated_forces;
  /// Value of ω² at which ρ ω² r² equals the weakest limit, with r the radius about the centre of
  /// mass.
  double burst_omega2_s2 = std::numeric_limits<double>::infinity();
  Vec3 spin_R = Vec3::Zero();  ///< Angular velocity, rad/s; 0 if negligible.
  Vec3 evaluated_spin_R = Vec3::Zero();
  StressCachePtr memory;
  /// An impact with less energy cannot overload any bond, as far as is known.
  double least_J = std::numeric_limits<double>::infinity();
  double least_Ns = 0;  ///< Nor can an impact with less impulse.
};

/// Placeholder for a mesh that is made at the next snapshot.
inline constexpr MeshIndex kMeshPending = MeshIndex(0xfffffffe);

/// A solid in the world: its structure, its body in the physics and its meshes.
struct Actor {
  static constexpr bool kMayBeInfinite = true;  ///< Numbers may be infinite: archive.h.
  std::uint32_t key = 0;             ///< Unique in a run, ascending with age; the tag of its body.
  std::uint32_t root_key = 0;        ///< Key of the solid or ball of the scene that it came from.
  std::uint32_t last_frame_key = 0;  ///< Key under which the last frame showed it or its parent.
  std::uint32_t name = kNoName;      ///< Index in WorldState::names; that of its root.
  CollisionFilter filter;
  std::uint64_t user_data = 0;
  BodyId body;
  bool is_static = false;     ///< No impulse moves it: it stands still, or is kinematic.
  bool is_kinematic = false;  ///< It follows a path of keyframes.
  Structure structure;        ///< Empty for a ball.
  std::uint32_t edits = 0;    ///< Number of edits of the structure.
  /// Mass properties. The centre of mass of a static actor stays where it was when its body was
  /// made, at the origin of B.
  CompoundMass weight;
  double volume_m3 = 0;
  std::vector<MaterialIndex> materials;  ///< Materials of its convexes when it was made, each once.
  std::uint64_t born_step = 0;
  std::uint32_t rejoined = 0;  ///< Number of times that parts of it have been rejoined.
  /// An impact with less energy cannot break it by a pattern: it is too tough, or its last plan
  /// without a break needed more. Infinite if no energy can.
  double least_J = std::numeric_limits<double>::infinity();
  double least_Ns = 0;      ///< An impact with less impulse cannot break it by a pattern.
  double least_m_s = 0;     ///< An impact slower than this, and with
  double least_slow_J = 0;  ///< less energy than this, cannot break it by a pattern.
  StressState stress;
  /// Least energy of an impact that can break it, by pattern or by stress.
  double least_of_all_J() const { return std::min(least_J, stress.least_J); }
  /// Returns the limits of impacts. An actor without a pattern can break by any impulse.
  ImpactLimits impact_limits() const {
    const bool has_pattern = least_J < std::numeric_limits<double>::infinity();
    return {least_J,      least_Ns,       least_m_s,
            least_slow_J, stress.least_J, has_pattern ? stress.least_Ns : 0};
  }
  /// Takes over what pieces inherit.
  void inherit(const Actor& parent) {
    root_key = parent.root_key;
    last_frame_key = parent.last_frame_key;
    name = parent.name;
    filter = parent.filter;
    user_data = parent.user_data;
    rejoined = parent.rejoined;
  }
  std::vector<MeshIndex> meshes;  ///< Per slot; none() if invisible, or kMeshPending.
  std::vector<std::vector<std::uint8_t>> hidden;  ///< Per slot: a flag for each face.
};

/// Key that stands for no actor; kGroundKey is the body tag of the ground.
inline constexpr std::uint32_t kNoActorKey = 0xfffffffe;

inline double ball_radius_m(double volume_m3) {
  return cube_root(volume_m3 * 3 / (4 * std::numbers::pi));
}

/// Pose of a rest frame, and the velocity field of what is fixed to it.
struct Motion {
  Pose X_WR;
  VelocityField field;
};

/// Returns the pose of an actor's rest frame when its body is at `X_WB`.
inline Pose rest_pose(const Actor& actor, const Pose& X_WB) {
  return {X_WB * Vec3(-actor.weight.com_R), X_WB.rotation};
}
/// Returns the kinetic energy of an actor; 0 if static or kinematic.
inline double kinetic_J(const Actor& actor, const BodyState& state) {
  if (actor.is_static) return 0;
  const Vec3 spin_B = state.X_WB.rotation.conjugate() * state.angular_velocity_W;
  return 0.5 * (actor.weight.mass_kg * state.velocity_W.squaredNorm() +
                spin_B.dot(actor.weight.inertia_R * spin_B));
}
inline Motion motion_of(const Actor& actor, const BodyState& state) {
  return {rest_pose(actor, state.X_WB), state.field()};
}

}  // namespace sunder
