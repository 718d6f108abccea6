// Dust: puffs carried by the air, oriented particles that add turbulence finer than its grid.
#pragma once

#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "engine/model/particles.h"
#include "solver/particles/air.h"
#include "solver/particles/swirl.h"

namespace sunder::solver {

/// Initial state of a puff. W: world; D: frame of the puff.
struct DustBirth {
  Vec3f position_W = Vec3f::Zero();
  Vec3f velocity_W = Vec3f::Zero();
  Quatf rotation_WD = Quatf::Identity();
  float mass_kg = 0;
  float settling_m_s = 0;
  float radius_m = 0.1f;
  MaterialIndex material;
};

/// Simulates all dust, and the air while there is dust.
class Dust {
 public:
  Dust(std::uint32_t limit, const Vec3& gravity_W, const Vec3i& air_cells);

  /// Adds a puff; at the limit the puff is ignored and counted in counts().ignored.
  void add(const DustBirth& birth);
  void ignore() { ++counts_.ignored; }
  /// Returns the number of puffs that can still be added.
  std::uint32_t room() const { return limit_ - static_cast<std::uint32_t>(position_W_.size()); }
  void advance(double dt_s, const Obstacles& obstacles);
  DustView view() const;
  ParticleCounts counts() const;
  /// Returns the air, or null while there is no dust.
  const Air* air() const { return flow_ ? &flow_->air : nullptr; }

  static auto fields(auto& self) {
    return std::tie(self.limit_, self.gravity_W_, self.down_W_, self.air_cells_, self.wanted_cells_,
                    self.counts_, self.flow_, self.sorted_m_, self.cell_, self.order_,
                    self.position_W_, self.slip_W_, self.rotation_WD_, self.mass_kg_,
                    self.settling_m_s_, self.turbulence_m_s_, self.first_radius_m_, self.radius_m_,
                    self.opacity_, self.age_s_, self.settled_s_, self.material_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  static constexpr std::uint32_t kOutside = 0xffffffff;
  /// The air around the puffs of one cell.
  struct Surroundings {
    std::uint32_t cell = kOutside;
    FlowGradient gradient;
    float solid = 0;
    Swirl::Near swirl;
  };
  /// The air and the swirl, which exist only while there is dust.
  struct Flow {
    /// Without an argument: a small one, to be read from an archive.
    Flow() : Flow(Vec3i::Constant(8)) {}
    explicit Flow(const Vec3i& cells) : air(cells), swirl(Lattice{cells}) {}
    static auto fields(auto& self) { return std::tie(self.air, self.swirl); }
    /// Returns the name of a field that is wrong, for saved states; null if none is.
    const char* wrong_field() const {
      return swirl.lattice().counts == air.grid().lattice.counts ? nullptr : "swirl";
    }
    Air air;
    Swirl swirl;
  };

  Box cloud_box();
  Vec3i cells_for(std::size_t puffs) const;
  Vec3i halve_where_possible(Vec3i cells, const Vec3& extent) const;
  void place_air(double ground_m);
  void sort_into_cells();
  void load_air();
  void prefetch_puff(std::size_t puff) const;
  void sample_surroundings(std::size_t puff, Surroundings& around) const;
  void move(std::size_t puff, const Surroundings& around, float dt_s, float ground_m);
  void settle(std::size_t puff, float dt_s, float solid, float ground_m);
  void remove_settled();

  std::uint32_t limit_;
  Vec3 gravity_W_;
  Vec3f down_W_;
  Vec3i air_cells_;                     ///< Greatest number of air cells per axis.
  Vec3i wanted_cells_ = Vec3i::Zero();  ///< Result of cells_for() in the last step.
  ParticleCounts counts_;
  std::optional<Flow> flow_;
  std::vector<float> sorted_m_;
  std::vector<std::uint32_t> cell_;   ///< Index of the air cell that holds each puff, or kOutside.
  std::vector<std::uint32_t> order_;  ///< Puffs sorted by cell; those outside the air come last.

  // Arrays over all puffs, oldest first.
  std::vector<Vec3f> position_W_;
  std::vector<Vec3f> slip_W_;  ///< Velocity relative to the air, left from the emission.
  std::vector<Quatf> rotation_WD_;
  std::vector<float> mass_kg_, settling_m_s_;
  std::vector<float> turbulence_m_s_;  ///< Square root of the turbulent energy per mass.
  std::vector<float> first_radius_m_, radius_m_, opacity_, age_s_;
  std::vector<float> settled_s_;  ///< Fading time so far; at kFadeOut_s the puff is invisible.
  std::vector<MaterialIndex> material_;
};

}  // namespace sunder::solver
