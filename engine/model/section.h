// Plane sections of what yields: what one bears when all of it flows, and how much of that a load
// takes.
#pragma once

#include "engine/base/types.h"

namespace sunder {

/// What one side of a section does to the other, about the section's centroid.
struct Wrench {
  Vec3 force_N = Vec3::Zero();
  Vec3 moment_Nm = Vec3::Zero();
};

/// What a plane section bears when all of it flows at its yield stress.
struct SectionStrength {
  /// Columns, unit and right-handed: the section's normal, and two directions in it.
  Mat3 axes_R = Mat3::Identity();
  double axial_N = 0;             ///< Pulled or pressed alone;
  double shear_N = 0;             ///< sheared alone, in any direction;
  Vec3 moment_Nm = Vec3::Zero();  ///< turned about one of the axes alone: twisted, and bent.
};

/// A section that flows, until it is drawn out too far and tears.
struct PlasticSection {
  Vec3 centroid_R = Vec3::Zero();
  SectionStrength strength;     ///< As it came: before it has hardened.
  Vec3 reach_m = Vec3::Zero();  ///< To what is farthest from each of its axes.
  double gauge_m = 0;           ///< The length that is drawn out.
  double yield_Pa = 0;          ///< Of the weakest in it, as it came.
  double hardening_Pa = 0, elongation = 0;
};

/// How far a load may grow before the section flows: 1 where it flows, 0.5 where it may double.
///
/// It flows where m + n² = 1, n the axial force and m the root of the squares of all others, each
/// over what the section bears of it alone. That is the plastic limit of a rectangle bent about an
/// axis under axial force (Drucker 1956), and von Mises' for shear and torsion with it.
double utilisation(const SectionStrength& strength, const Wrench& wrench_R);

/// Of a wrench, in the axes of the section and in parts of what it bears: axial force, two shears;
/// twist and two bendings.
struct SectionLoad {
  double axial = 0;
  double across = 0;  ///< The root of the squares of all but the axial force.
};
SectionLoad in_parts(const SectionStrength& strength, const Wrench& wrench_R);

}  // namespace sunder
