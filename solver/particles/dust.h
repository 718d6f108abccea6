// Dust: puffs that the air carries, oriented particles that stir it where the grid is too coarse.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "engine/model/particles.h"
#include "solver/particles/air.h"
#include "solver/particles/swirl.h"

namespace sunder::solver {

/// A puff as it comes into the world.
struct DustBirth {
  Vec3f position_W = Vec3f::Zero();
  Vec3f velocity_W = Vec3f::Zero();
  Quatf rotation_WD = Quatf::Identity();
  float mass_kg = 0;
  float settling_m_s = 0;
  float radius_m = 0.1f;
  MaterialIndex material;
};

/// All dust, and the air while there is any.
class Dust {
 public:
  Dust(std::uint32_t limit, const Vec3& gravity_W, const Vec3i& air_cells);

  /// Ignored, and counted so, at the limit.
  void add(const DustBirth& birth);
  void ignore() { ++ledger_.ignored; }
  /// How many more fit.
  std::uint32_t room() const { return limit_ - static_cast<std::uint32_t>(position_W_.size()); }
  void advance(double dt_s, const Obstacles& obstacles);
  DustView view() const;
  ParticleLedger ledger() const;
  /// Null without dust.
  const Air* air() const { return flow_ ? &flow_->air : nullptr; }

 private:
  static constexpr std::uint32_t kOutside = 0xffffffff;
  /// The air around the puffs of one cell.
  struct Around {
    std::uint32_t cell = kOutside;
    FlowGradient gradient;
    float solid = 0;
    Swirl::Near swirl;
  };
  /// What exists only while there is dust.
  struct Flow {
    explicit Flow(const Vec3i& cells) : air(cells), swirl(Lattice{cells}) {}
    Air air;
    Swirl swirl;
  };

  Box cloud();
  Vec3i cells_for(std::size_t puffs) const;
  Vec3i without_spare(Vec3i cells, const Vec3& extent) const;
  void place_air(double ground_m);
  void sort_into_cells();
  void load_air();
  void fetch(std::size_t puff) const;
  void look_around(std::size_t puff, Around& around) const;
  void move(std::size_t puff, const Around& around, float dt_s, float ground_m);
  void settle(std::size_t puff, float dt_s, float solid, float ground_m);
  void remove_settled();

  std::uint32_t limit_;
  Vec3 gravity_W_;
  Vec3f down_W_;
  Vec3i air_cells_;              ///< At most.
  Vec3i worth_ = Vec3i::Zero();  ///< As many as so many puffs are worth, whatever their cloud.
  ParticleLedger ledger_;
  std::optional<Flow> flow_;
  std::vector<float> sorted_m_;
  std::vector<std::uint32_t> cell_;   ///< Of the air that holds a puff, or kOutside.
  std::vector<std::uint32_t> order_;  ///< Puffs by cell; those outside come last.

  // In order of birth.
  std::vector<Vec3f> position_W_;
  std::vector<Vec3f> slip_W_;  ///< Velocity relative to the air, from being thrown.
  std::vector<Quatf> rotation_WD_;
  std::vector<float> mass_kg_, settling_m_s_;
  std::vector<float> turbulence_m_s_;  ///< Square root of turbulent energy per mass.
  std::vector<float> first_radius_m_, radius_m_, opacity_, age_s_;
  std::vector<float> settled_s_;  ///< How long it has lain somewhere.
  std::vector<MaterialIndex> material_;
};

}  // namespace sunder::solver
