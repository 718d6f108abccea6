// State of all bodies, as arrays that the physics shows to other modules.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/check.h"
#include "engine/base/types.h"

namespace sunder {

struct BodyTag;
using BodyId = Id<BodyTag>;

/// Velocity field of a rigid body: velocity_W + angular_velocity_W × (p − at_W) at point p.
struct VelocityField {
  Vec3 at_W = Vec3::Zero();
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();

  Vec3 operator()(const Vec3& point_W) const {
    return velocity_W + angular_velocity_W.cross(point_W - at_W);
  }
};

/// Pose and velocities of one body.
struct BodyState {
  Pose X_WB;
  Vec3 velocity_W = Vec3::Zero();
  Vec3 angular_velocity_W = Vec3::Zero();
  bool asleep = false;

  VelocityField field() const { return {X_WB.position, velocity_W, angular_velocity_W}; }
};

/// Kind and activity of a body.
enum class BodyMode : std::uint8_t {
  kAbsent,     ///< A free slot.
  kStatic,     ///< Never moves; infinite mass.
  kKinematic,  ///< Moves at prescribed velocities; infinite mass.
  kAwake,
  kAsleep,
  kFrozen,  ///< Its state was not finite; stays at its last finite pose, as if static.
};

/// State of all bodies: read-only arrays indexed by BodyId::slot, owned by the physics.
struct BodyStates {
  std::span<const std::uint32_t> generation;
  std::span<const BodyMode> mode;
  std::span<const Vec3> position_W;
  std::span<const Quat> rotation_WB;
  std::span<const Vec3> velocity_W;
  std::span<const Vec3> angular_velocity_W;

  bool holds(BodyId id) const {
    return id.slot < mode.size() && generation[id.slot] == id.generation &&
           mode[id.slot] != BodyMode::kAbsent;
  }
  /// Returns the state of an existing body.
  BodyState operator[](BodyId id) const {
    SUNDER_CHECK(holds(id));
    return {{position_W[id.slot], rotation_WB[id.slot]},
            velocity_W[id.slot],
            angular_velocity_W[id.slot],
            mode[id.slot] == BodyMode::kAsleep};
  }
};

/// Storage of BodyStates, for a physics that keeps its bodies in another form.
class BodyTable {
 public:
  void set(BodyId id, BodyMode mode, const BodyState& state) {
    if (id.slot >= mode_.size()) resize(id.slot + 1);
    generation_[id.slot] = id.generation;
    mode_[id.slot] = mode;
    position_W_[id.slot] = state.X_WB.position;
    rotation_WB_[id.slot] = state.X_WB.rotation;
    velocity_W_[id.slot] = state.velocity_W;
    angular_velocity_W_[id.slot] = state.angular_velocity_W;
  }
  void remove(BodyId id) { mode_[id.slot] = BodyMode::kAbsent; }
  BodyStates states() const {
    return {generation_, mode_, position_W_, rotation_WB_, velocity_W_, angular_velocity_W_};
  }

 private:
  void resize(std::size_t slots) {
    generation_.resize(slots);
    mode_.resize(slots, BodyMode::kAbsent);
    position_W_.resize(slots);
    rotation_WB_.resize(slots);
    velocity_W_.resize(slots);
    angular_velocity_W_.resize(slots);
  }

  std::vector<std::uint32_t> generation_;
  std::vector<BodyMode> mode_;
  std::vector<Vec3> position_W_;
  std::vector<Quat> rotation_WB_;
  std::vector<Vec3> velocity_W_, angular_velocity_W_;
};

}  // namespace sunder
