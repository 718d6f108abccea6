// A solid in the running world. Internal to engine/world.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numbers>
#include <vector>

#include "engine/base/types.h"
#include "engine/model/breaker.h"
#include "engine/model/compound.h"
#include "engine/model/frame.h"
#include "engine/model/impact_probe.h"
#include "engine/model/physics.h"
#include "engine/model/structure.h"

namespace sunder {

/// What presses or pulls on a convex: force in the rest frame, torque about its centroid.
struct Press {
  ConvexSlot convex;
  Vec3 force_R = Vec3::Zero();
  Vec3 torque_R = Vec3::Zero();
};

/// What an actor bears, and how far it is known whether it can.
struct StressState {
  bool breakable = false;        ///< Load can break it.
  bool settled = false;          ///< Judged for `judged` and `judged_spin_R`, to the end.
  std::uint64_t since_step = 0;  ///< Waits to be judged since then, if not settled.
  std::vector<Press> pressing;   ///< Averaged over time; ascending by convex.
  std::vector<Press> judged;
  /// Where ω² is so much, ρ ω² r² is the weakest limit, r its radius about the centre of mass.
  double bursts_s2 = std::numeric_limits<double>::infinity();
  Vec3 spin_R = Vec3::Zero();  ///< Angular velocity, rad/s, if it matters; else 0.
  Vec3 judged_spin_R = Vec3::Zero();
  StressMemoryPtr memory;
  /// No impact with less energy can overload it, as far as is known,
  double least_J = std::numeric_limits<double>::infinity();
  double least_Ns = 0;  ///< nor one with less impulse.
};

/// Stands for a mesh that is not made yet: until the next snapshot, nobody looks.
inline constexpr MeshIndex kUndrawn = MeshIndex(0xfffffffe);

/// A solid in the world: a body, what it is made of, and what is drawn of it.
struct Actor {
  std::uint32_t key = 0;          ///< Unique in a run, ascending with age; the tag of its body.
  std::uint32_t root_key = 0;     ///< Of what it came off in the end: a solid or ball of the scene.
  std::uint32_t shown_key = 0;    ///< As what, or part of what, the last frame showed it.
  std::uint32_t name = kUnnamed;  ///< In World::names; of its root.
  BodyId body;
  bool is_static = false;     ///< Nothing pushes it: it stands, or
  bool is_kinematic = false;  ///< goes its path.
  Structure structure;        ///< Without convexes for a ball.
  std::uint32_t edits = 0;    ///< Of its structure, since it was made.
  /// Of what stands, the centre is where it was when its body was made: there B has its origin.
  Weight weight;
  double volume_m3 = 0;
  std::vector<MaterialIndex> materials;  ///< Of its convexes when it was made, each once.
  std::uint64_t born_step = 0;
  std::uint32_t rejoined = 0;  ///< How often parts of it have become one again.
  /// No impact with less energy can break it by a pattern: it is too tough, or its last fruitless
  /// plan asked for more. Infinite if nothing can.
  double least_J = std::numeric_limits<double>::infinity();
  double least_Ns = 0;      ///< No impact with less impulse can break it by a pattern,
  double least_m_s = 0;     ///< nor a slower one
  double least_slow_J = 0;  ///< that has less energy than this.
  StressState stress;
  /// No impact with less energy can break it by pattern or by stress.
  double least_of_all_J() const { return std::min(least_J, stress.least_J); }
  /// Returns its limits. An actor without a pattern can part by an impact of any impulse.
  ImpactLimits impact_limits() const {
    const bool has_pattern = least_J < std::numeric_limits<double>::infinity();
    return {least_J,      least_Ns,       least_m_s,
            least_slow_J, stress.least_J, has_pattern ? stress.least_Ns : 0};
  }
  std::vector<MeshIndex> meshes;  ///< Per slot; none() where nothing shows, or kUndrawn.
  std::vector<std::vector<std::uint8_t>> hidden;  ///< Per slot, a flag for each face.
};

/// In place of an actor where there is none; kGroundKey is the body tag of the ground.
inline constexpr std::uint32_t kNoActorKey = 0xfffffffe;

inline double ball_radius_m(double volume_m3) {
  return std::cbrt(volume_m3 * 3 / (4 * std::numbers::pi));
}

/// Where a rest frame is, and how what is in it moves.
struct Motion {
  Pose X_WR;
  VelocityField field;
};

/// Where an actor's rest frame is when its body is at `X_WB`.
inline Pose rest_pose(const Actor& actor, const Pose& X_WB) {
  return {X_WB * Vec3(-actor.weight.com_R), X_WB.rotation};
}
/// 0 of what is static or kinematic.
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
