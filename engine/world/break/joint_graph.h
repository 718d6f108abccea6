// Actors connected by joints, and bounds on the energy of their impacts, for impact probes.
// Internal to engine/world.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/model/body_states.h"
#include "engine/model/physics.h"
#include "engine/world/actors/world_state.h"

namespace sunder {

/// Valid until a joint or an actor is added or removed.
class JointGraph {
 public:
  /// End of a joint at an actor.
  struct End {
    std::uint32_t key = 0;
    std::uint32_t joint = 0;  ///< Index in Joints::live().
  };

  explicit JointGraph(const WorldState& world);

  /// Returns the joint ends at an actor.
  std::span<const End> ends_at(std::uint32_t key) const;
  /// Upper bound of the energy of a speculative contact at the time of its closing. Jointed bodies
  /// strike with at most the kinetic energy of their assembly, and, if the assembly is free, with
  /// at most its mass (Thomson's theorem: of all motions that the joints allow, the true one has
  /// the least energy).
  double closing_energy_J(const SpeculativeContact& approach) const;
  /// Closing speed of a speculative contact at the time of its closing, a fall to the contact
  /// included.
  double closing_speed_m_s(const SpeculativeContact& approach) const;

 private:
  /// Energy per kilogram that a fall over the contact's separation adds.
  double fall_energy_J_kg(const SpeculativeContact& approach) const;

  /// Bodies connected by joints.
  struct Assembly {
    double mass_kg = 0, kinetic_J = 0;
    bool held = false;  ///< Jointed to the world or to a static or kinematic body.
  };

  Assembly single_body(std::uint32_t key) const;
  Assembly assembly(std::uint32_t key) const;

  const WorldState& world_;
  const BodyStates states_;
  std::vector<End> ends_;                   ///< In order of key, then joint.
  std::vector<std::uint32_t> assembly_of_;  ///< Per joint: index in assemblies_.
  std::vector<Assembly> assemblies_;        ///< At the index of the first joint of each.
};

}  // namespace sunder
