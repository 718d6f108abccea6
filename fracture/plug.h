// Perforation: the plug of its cross-section that a striker drives out of a solid, and the cracks
// around that, from the impact and the material.
#pragma once

#include "engine/model/breaker.h"

namespace sunder::fracture {

/// Energy in J that a hard striker of width d and mass m needs to be driven through a thickness e:
/// ½ m V² with V² = 1.7 (r + 0.3) f_c ρ^(1/3) (d e² / m)^(4/3), where f_c is the compressive
/// strength (CEA-EDF: Berriaud et al. 1978, for reinforcement of r = 0.7 per cent each way in each
/// face; UKAEA: Barr 1990, for other r). 0 where e < d / 4.17, the end of the range in which the
/// formula was found: such plates bend and crack, and no plug is sheared out of them.
double perforation_energy_J(const Material& material, double width_m, double thickness_m,
                            double mass_kg);

/// Returns the prism that an impact drives out along `axis_R`, placed by `X_RP`, the pose of the
/// pattern's frame:
/// where the striker has the energy to perforate the solid, a plug through it; else a crater as
/// deep as a thickness that it could perforate. None if the striker is unknown or wider
/// than a break by pattern, or the solid so narrow that it breaks as a whole. A crater smaller than
/// the material's smallest break has no section: the striker dents the solid, and nothing comes
/// off.
std::optional<Plug> make_plug(const Material& material, const StructureImpact& hit,
                              const Vec3& axis_R, Pose& X_RP);

}  // namespace sunder::fracture
