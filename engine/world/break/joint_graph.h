// Which actors joints hold together, for the reach of break probes. Internal to engine/world.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/body_states.h"
#include "engine/model/physics.h"
#include "engine/world/actors/world.h"

namespace sunder {

/// Good until a joint or an actor comes or goes.
class JointGraph {
 public:
  /// Where a joint holds an actor.
  struct End {
    std::uint32_t key = 0;
    std::uint32_t joint = 0;  ///< By place in Joints::live().
  };

  explicit JointGraph(const World& world);

  /// The joints that hold an actor.
  std::span<const End> of(std::uint32_t key) const;
  /// What closes at a contact, by the time that it does, at most. What is joined hits with no more
  /// than the energy of all that hangs together; nor, if nothing holds that, with more than its
  /// mass (Thomson's theorem: of all motions that the joints allow, the true one has the least).
  double closing_energy_J(const Approach& approach) const;
  /// The speed of that.
  double closing_speed_m_s(const Approach& approach) const;

 private:
  /// Energy that a fall to the contact adds, for each kilogram.
  double falls_J_kg(const Approach& approach) const;

  /// All that hangs together, at one.
  struct Whole {
    double mass_kg = 0, kinetic_J = 0;
    bool held = false;  ///< By the world.
  };

  Whole alone(std::uint32_t key) const;
  Whole whole(std::uint32_t key) const;

  const World& world_;
  const BodyStates states_;
  std::vector<End> ends_;                ///< By key.
  std::vector<std::uint32_t> whole_of_;  ///< Per joint.
  std::vector<Whole> wholes_;            ///< By the first joint of each.
};

}  // namespace sunder
