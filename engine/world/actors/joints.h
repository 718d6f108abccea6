// Joints of the running world: who they hold, and where they go when that breaks. Internal to
// engine/world.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/physics.h"
#include "engine/model/scene.h"
#include "engine/world/actors/actors.h"

namespace sunder {

class Joints {
 public:
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
  /// Keys of what a joint that does not give fixes to the world, or to what the world holds;
  /// ascending.
  std::vector<std::uint32_t> fixed_to_world(const Actors& actors) const;

 private:
  /// An actor, or the world.
  struct End {
    std::uint32_t key = 0;  ///< kGroundKey: the world.
    Vec3 anchor_R = Vec3::Zero();
  };
  struct Live {
    JointId id;
    End a, b;
    bool rigid = false;  ///< kFixed.
  };

  std::uint32_t forget(const std::vector<JointId>& gone);

  std::vector<Live> live_;
};

}  // namespace sunder
