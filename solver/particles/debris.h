// Debris: chips that fall, bounce, come to rest and fade, simulated as spheres; for the eye only.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/particles.h"
#include "solver/particles/obstacle_grid.h"

namespace sunder::solver {

/// A chip as it comes into the world.
struct DebrisBirth {
  Vec3f position_W = Vec3f::Zero();
  Vec3f velocity_W = Vec3f::Zero();
  Vec3f angular_velocity_W = Vec3f::Zero();
  Quatf rotation_WD = Quatf::Identity();
  float radius_m = 0;
  std::uint8_t variant = 0;
  MaterialIndex material;
};

/// All debris. Resting chips sleep and cost nothing until their support goes, moves, or something
/// else runs into them. Where many lie, small ones that have lain long fade.
class Debris {
 public:
  Debris(std::uint32_t limit, const Vec3& gravity_W);

  /// Ignored, and counted so, at the limit.
  void add(const DebrisBirth& birth);
  void ignore() { ++ledger_.ignored; }
  /// How many more fit.
  std::uint32_t room() const { return limit_ - static_cast<std::uint32_t>(position_W_.size()); }
  void advance(double dt_s, const Obstacles& obstacles);
  DebrisView view() const;
  ParticleLedger ledger() const;

 private:
  enum class State : std::uint8_t { kAwake, kAsleep, kFading };
  /// What a step made of one chip.
  struct Moved {
    bool touched = false;
    bool lies = false;          ///< On what does not move, for all a chip can tell.
    std::uint32_t support = 0;  ///< Index of a body, or kGround.
  };
  /// A body that sleepers rest on.
  struct Support {
    std::uint32_t key = 0;
    std::uint32_t edits = 0;  ///< When the first of them fell asleep,
    Pose X_WB;                ///< and where it was.
  };

  void sort();
  void wake_unsupported(const Obstacles& obstacles);
  void wake_touched(double dt_s, const Obstacles& obstacles);
  void wake(std::uint32_t chip);
  Box reach_of_awake(double dt_s);
  void move_awake(double dt_s, const Obstacles& obstacles);
  void fetch(std::uint32_t chip) const;
  void move(std::span<const std::uint32_t> chips, std::span<Moved> moved, double dt_s,
            double ground_m, ObstacleGrid::Near& near);
  bool goes_on(std::uint32_t chip, SphereWay& way, std::optional<ObstacleTouch> touch, double dt_s,
               double ground_m, Moved& moved);
  void spin(std::span<const std::uint32_t> chips, std::span<const Moved> moved, float dt_s);
  void put_to_sleep(double dt_s, const Obstacles& obstacles);
  void fade(float dt_s);
  void remove(std::uint32_t chip);
  void list();
  void add_support(const ObstacleBody& body);

  std::uint32_t limit_;
  Vec3 gravity_W_;
  ParticleLedger ledger_;
  std::uint64_t next_rest_ = 0;

  std::vector<Vec3f> position_W_, velocity_W_, angular_velocity_W_;
  std::vector<Quatf> rotation_WD_;
  std::vector<float> radius_m_, drawn_radius_m_;
  std::vector<float> still_s_;  ///< How long it has hardly moved.
  std::vector<std::uint8_t> variant_;
  std::vector<MaterialIndex> material_;
  std::vector<State> state_;
  std::vector<std::uint32_t> support_;  ///< Key of what a sleeper rests on.
  std::vector<std::uint64_t> rest_;     ///< A sleeper's place in the order of falling asleep.

  /// All chips, near each other if near in the world, as far as was so when they were sorted.
  std::vector<std::uint32_t> order_;
  std::uint32_t moves_ = 0;                             ///< Since they were sorted.
  std::vector<std::uint32_t> awake_, asleep_, fading_;  ///< In that order; remade when stale.
  bool listed_ = true;
  Box asleep_box_;
  std::vector<Support> supports_;  ///< Ascending by key.
  ObstacleGrid grid_, movers_;
  std::vector<Moved> moved_;  ///< Of awake_.
  std::vector<Box> reaches_;  ///< A chunk's.
};

}  // namespace sunder::solver
