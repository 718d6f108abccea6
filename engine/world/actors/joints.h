// Joints of the running world: who they hold, and where they go when that breaks. Internal to
// engine/world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/joint.h"
#include "engine/model/physics.h"
#include "engine/model/scene.h"
#include "engine/world/actors/actors.h"

namespace sunder {

class Joints {
 public:
  /// An actor, or the world.
  struct End {
    std::uint32_t key = 0;         ///< kGroundKey: the world.
    Vec3 anchor_R = Vec3::Zero();  ///< In W at the world's end.
  };
  struct Live {
    JointId id;
    JointKind kind = JointKind::kBall;
    End a, b;
    Vec3 axis_a_R = Vec3::UnitZ();  ///< kHinge.
    double length_m = 0;            ///< kDistance, kRope.
  };

  /// Joins two things as they stand; `joint.a` and `joint.b` are keys here.
  void add(Physics& physics, const Actors& actors, const Joint& joint);
  /// After `parent` gave way to pieces, or lost them and stays: its ends go to what has the anchor
  /// now, and joints without one are cut. How many were.
  std::uint32_t follow(Physics& physics, const Actor& parent, bool stays,
                       std::span<const Actor> pieces);
  /// Before an actor goes: cuts its joints. How many there were.
  std::uint32_t cut(Physics& physics, std::uint32_t key);
  /// After a solve: how many broke under their load.
  std::uint32_t take_broken(Physics& physics);
  /// As they were made, but for who has their ends now.
  const std::vector<Live>& live() const { return live_; }

 private:
  std::uint32_t forget(const std::vector<JointId>& gone);

  std::vector<Live> live_;
};

}  // namespace sunder
