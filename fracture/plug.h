// Perforation: computes the plug that a striker drives out of a solid, and the cracks around it,
// from the impact and the material.
#pragma once

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Returns the energy in J that a hard striker of width d and mass m needs to perforate a thickness
/// e: ½ m V² with V² = 1.7 (r + 0.3) f_c ρ^(1/3) (d e² / m)^(4/3), where f_c is the compressive
/// strength (CEA-EDF: Berriaud et al. 1978, for reinforcement of r = 0.7 per cent each way in each
/// face; UKAEA: Barr 1990, for other r). Returns 0 where e < d / 4.17, outside the range of the
/// formula: such plates bend and crack without shearing out a plug.
double perforation_energy_J(const Material& material, double width_m, double thickness_m,
                            double mass_kg);

/// Returns true if the cracks of a pattern run outwards from the point of impact, as in panes.
inline bool cracks_run_out(const PatternSpec& pattern) {
  return pattern.kind == PatternSpec::Kind::kWeb || pattern.kind == PatternSpec::Kind::kRadial;
}

/// Returns the prism that an impact drives out along its direction, and sets `X_RP` to the pose of
/// the pattern's frame. It is a plug through the solid if the energy suffices to perforate it;
/// otherwise a crater as deep as the thickness that the energy can perforate. Returns nullopt if
/// the cross-section of the striker is unknown or wider than a break by pattern, or if the solid is
/// so narrow that it breaks as a whole. A crater below the material's smallest break has an empty
/// section: the striker dents the solid, and nothing comes off.
std::optional<Plug> make_plug(const Material& material, const StructureImpact& hit, Pose& X_RP);

}  // namespace sunder::fracture
