// Debris: visual chips that fall, bounce, come to rest and fade, as spheres that act on no body.
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "engine/model/particles.h"
#include "solver/particles/obstacle_grid.h"

namespace sunder::solver {

/// Initial state of a chip. W: world; D: frame of the chip.
struct DebrisBirth {
  Vec3f position_W = Vec3f::Zero();
  Vec3f velocity_W = Vec3f::Zero();
  Vec3f angular_velocity_W = Vec3f::Zero();
  Quatf rotation_WD = Quatf::Identity();
  float radius_m = 0;
  std::uint8_t variant = 0;
  MaterialIndex material;
};

/// Simulates all debris. Resting chips sleep at no cost until their support is removed or moves, or
/// a moving obstacle hits them. Near the limit, small chips that have slept long fade out.
class Debris {
 public:
  Debris(std::uint32_t limit, const Vec3& gravity_W);

  /// Adds a chip; at the limit the chip is ignored and counted in counts().ignored.
  void add(const DebrisBirth& birth);
  void ignore() { ++counts_.ignored; }
  /// Returns the number of chips that can still be added.
  std::uint32_t room() const { return limit_ - static_cast<std::uint32_t>(position_W_.size()); }
  void advance(double dt_s, const Obstacles& obstacles);
  DebrisView view() const;
  ParticleCounts counts() const;

  static auto fields(auto& self) {
    return std::tie(self.limit_, self.gravity_W_, self.counts_, self.next_sleep_order_,
                    self.position_W_, self.velocity_W_, self.angular_velocity_W_, self.rotation_WD_,
                    self.radius_m_, self.drawn_radius_m_, self.slow_s_, self.variant_,
                    self.material_, self.state_, self.support_, self.sleep_order_, self.order_,
                    self.steps_, self.awake_, self.asleep_, self.fading_, self.lists_valid_,
                    self.asleep_box_, self.supports_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  enum class State : std::uint8_t { kAwake, kAsleep, kFading };
  /// Result of a step for one chip.
  struct StepResult {
    bool touched = false;
    bool on_still_surface = false;  ///< Touches a surface slower than kObstacleRestSpeed_m_s.
    std::uint32_t support = 0;      ///< Index of the body that was touched, or kGround.
  };
  /// A body that sleeping chips rest on.
  struct Support {
    std::uint32_t key = 0;
    std::uint32_t edits = 0;  ///< ObstacleBody::edits when the first chip fell asleep on the body.
    Pose X_WB;                ///< Pose of the body when the first chip fell asleep on it.
  };

  void sort();
  void wake_unsupported(const Obstacles& obstacles);
  void wake_hit(double dt_s, const Obstacles& obstacles);
  void wake(std::uint32_t chip);
  Box reach_of_awake(double dt_s);
  void move_awake(double dt_s, const Obstacles& obstacles);
  void prefetch_chip(std::uint32_t chip) const;
  void move(std::span<const std::uint32_t> chips, std::span<StepResult> results, double dt_s,
            double ground_m, ObstacleGrid::Near& near);
  bool advance_to_contact(std::uint32_t chip, SpherePath& path, std::optional<SphereContact> touch,
                          double dt_s, double ground_m, StepResult& result);
  void integrate_rotations(std::span<const std::uint32_t> chips,
                           std::span<const StepResult> results, float dt_s);
  void put_to_sleep(double dt_s, const Obstacles& obstacles);
  void fade(float dt_s);
  void remove(std::uint32_t chip);
  void rebuild_lists();
  void add_support(const ObstacleBody& body);

  std::uint32_t limit_;
  Vec3 gravity_W_;
  ParticleCounts counts_;
  std::uint64_t next_sleep_order_ = 0;

  std::vector<Vec3f> position_W_, velocity_W_, angular_velocity_W_;
  std::vector<Quatf> rotation_WD_;
  std::vector<float> radius_m_, drawn_radius_m_;
  std::vector<float> slow_s_;  ///< Time below the sleep speed.
  std::vector<std::uint8_t> variant_;
  std::vector<MaterialIndex> material_;
  std::vector<State> state_;
  std::vector<std::uint32_t> support_;  ///< Key of the body that a sleeping chip rests on.
  /// Position of a sleeping chip in the order of sleeping.
  std::vector<std::uint64_t> sleep_order_;

  /// All chips in the order of the last sort(): neighbours in space are close in memory.
  std::vector<std::uint32_t> order_;
  std::uint32_t steps_ = 0;                             ///< Steps with awake chips.
  std::vector<std::uint32_t> awake_, asleep_, fading_;  ///< Chips by state, in the order of order_.
  bool lists_valid_ = true;  ///< False if the lists by state must be rebuilt.
  Box asleep_box_;
  std::vector<Support> supports_;    ///< In ascending order of keys.
  ObstacleGrid grid_;                ///< Obstacles near the chips of one loop; built anew for each.
  std::vector<StepResult> results_;  ///< Results for the chips of awake_.
  std::vector<Box> chunk_boxes_;     ///< Box of each chunk of awake chips.
};

}  // namespace sunder::solver
