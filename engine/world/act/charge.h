// Impulse of the blast wave of a TNT charge on a rigid surface. Internal to engine/world.
//
// Sources: C. N. Kingery and G. Bulmash, Airblast parameters from TNT spherical air burst and
// hemispherical surface burst, ARBRL-TR-02555, 1984: the fits, which UFC 3-340-02 and CONWEP use as
// well. G. Randers-Pehrson and K. A. Bannister, Airblast loading model for DYNA2D and DYNA3D,
// ARL-TR-1310, 1997: the dependence on the angle of incidence. M. M. Swisdak, Simplified Kingery
// airblast calculations, 26th DoD Explosives Safety Seminar, 1994, and IATG 01.80, 3rd ed., 2021,
// table 5: figures that tests hold the fits to.
#pragma once

#include "engine/model/scene.h"

namespace sunder {

/// Impulses of the positive phase per area of a surface at one distance.
struct WaveImpulse {
  double reflected_Pa_s = 0;  ///< On a surface that faces the charge.
  double incident_Pa_s = 0;   ///< On a surface parallel to the wave's direction.

  /// Impulse per area of a surface whose normal makes an angle of this cosine, 0 to 1, with the
  /// direction to the charge.
  double at_incidence(double cosine) const {
    return reflected_Pa_s * cosine * cosine + incident_Pa_s * (1 + cosine - 2 * cosine * cosine);
  }
  /// Impulse on a ball, per area of its cross-section: the integral of at_incidence() over the half
  /// that faces the charge.
  double on_ball() const { return reflected_Pa_s / 2 + incident_Pa_s * 2 / 3; }
};

/// Returns the impulses at a distance. The fits hold for scaled distances Z = R/W^(1/3) from 0.0674
/// to 40 m/kg^(1/3). Nearer surfaces get the impulse at 0.0674, just outside the charge; beyond 40
/// there is none.
WaveImpulse wave_impulse(double tnt_kg, BurstKind burst, double distance_m);
/// Returns the distance at which Z = 40.
double wave_reach_m(double tnt_kg, BurstKind burst);

/// Returns the distance from the centre up to which a blast acts.
double reach_m(const Blast& blast);

}  // namespace sunder
