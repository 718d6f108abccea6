// Moves: kinematic bodies that follow keyframes. Internal to engine/world.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "engine/world/actors/world_state.h"

namespace sunder {

/// Makes an actor kinematic (of infinite mass, and unbreakable) or free, with its current motion.
void set_kinematic(WorldState& world, Actor& actor, bool is_kinematic);

class Moves {
 public:
  /// Makes a body kinematic; the path of a move begins at the time of the current step, at the pose
  /// `start_X_WR` of the body's rest frame. Replaces an earlier move of the body.
  void add(WorldState& world, const Move& move, std::uint32_t key, const Pose& start_X_WR);
  /// Ends the move of a body, which stays kinematic where it is.
  void end(std::uint32_t key);
  /// Releases the bodies that are due, and gives the others the velocity to their pose at the end
  /// of the step.
  void update(WorldState& world);

  static auto fields(auto& self) { return std::tie(self.active_); }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  struct Active {
    static constexpr bool kMayBeInfinite = true;  ///< Numbers may be infinite: archive.h.
    std::uint32_t key = 0;
    Pose start_X_WR;
    double start_s = 0;
    Path path;
    Vec3 pivot_W;
    double release_s = 0;
  };
  void update(WorldState& world, const Active& move, Actor& actor) const;

  std::vector<Active> active_;
};

}  // namespace sunder
