// Cross-sections of yielding material: fully plastic strength, and utilisation under a load.
#pragma once

#include "engine/base/types.h"

namespace sunder {

/// Force and moment of one side of a section on the other, about the section's centroid.
struct Wrench {
  Vec3 force_N = Vec3::Zero();
  Vec3 moment_Nm = Vec3::Zero();
};

/// Fully plastic strength of a plane section: the loads at which all of it yields.
struct SectionStrength {
  static constexpr bool kMayBeInfinite = true;  ///< Numbers may be infinite: archive.h.
  /// Unit columns, right-handed: the section's normal, and two directions in the section.
  Mat3 axes_R = Mat3::Identity();
  double axial_N = 0;             ///< Axial force alone, in tension or compression.
  double shear_N = 0;             ///< Shear force alone, in any direction.
  Vec3 moment_Nm = Vec3::Zero();  ///< Moment about each axis alone: torsion, and two of bending.
};

/// A yielding section, which tears when its elongation is exceeded.
struct PlasticSection {
  static constexpr bool kMayBeInfinite = true;  ///< Numbers may be infinite: archive.h.
  Vec3 centroid_R = Vec3::Zero();
  SectionStrength strength;     ///< Initial strength, before hardening.
  Vec3 reach_m = Vec3::Zero();  ///< Distance from each axis to the farthest point.
  double gauge_m = 0;           ///< Length of material that is strained.
  double yield_Pa = 0;          ///< Lowest initial yield stress in the section.
  double hardening_Pa = 0, elongation = 0;
};

/// Returns the load over the load at which the section yields: 1 where it yields, 0.5 where the
/// load may double.
///
/// The section yields where m + n² = 1, with n the axial force and m the root of the sum of squares
/// of all other components, each over the strength for that component alone. That is the plastic
/// limit of a rectangular section in bending about an axis with axial force (Drucker 1956),
/// combined with von Mises' for shear and torsion.
double utilisation(const SectionStrength& strength, const Wrench& wrench_R);

/// Load on a section, over its strength.
struct SectionLoad {
  double axial = 0;  ///< Axial force over axial strength.
  /// Root of the sum of squares of the other components: two shears, torsion, two bending moments.
  double across = 0;
};
/// Returns a wrench in the axes of the section, over the section's strength.
SectionLoad relative_load(const SectionStrength& strength, const Wrench& wrench_R);

}  // namespace sunder
