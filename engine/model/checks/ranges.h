// The table of allowed numbers of a scene and of actions on a world: for scene files, C++, C and
// Python.
#pragma once

#include <limits>

namespace sunder {

/// Allowed values of a number, or of every component of a vector; both ends are included.
struct Range {
  double low = -std::numeric_limits<double>::max();
  double high = std::numeric_limits<double>::max();
};

/// Largest length, coefficient or other number, and largest time, that an input may have.
inline constexpr double kMaxNumber = 1e9, kMaxTime_s = 1e7;

namespace ranges {

inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

inline constexpr Range kGravity_m_s2{-100, 100};
inline constexpr Range kPlace_m{-kMaxNumber, kMaxNumber};
/// Speeds of bodies, by component. A run slows down what is faster (Limit::kSpeeds). A body at 1e5
/// m/s, beyond any meteor, goes 1.7 km in a frame, over which the single precision of boxes and
/// contacts resolves 0.1 mm; the edge of a chip of 1 mm at 1e6 rad/s moves at 1,000 m/s.
inline constexpr Range kSpeed_m_s{-1e5, 1e5}, kSpin_rad_s{-1e6, 1e6};
inline constexpr Range kLength_m{1e-9, kMaxNumber};
/// A world has no last second; a scene file is a run, of at most 600 s.
inline constexpr Range kTime_s{-kMaxTime_s, kMaxTime_s}, kFileTime_s{0, 600};
inline constexpr Range kFraction{0, 1};
inline constexpr Range kAtLeastZero{0, kInfinity};

// Materials and the ground.
inline constexpr Range kDensity_kg_m3{1e-6, 1e9};
inline constexpr Range kFriction{0, 10};
inline constexpr Range kRolling{0, 1};
inline constexpr Range kYoungs_Pa{1, 1e15};
inline constexpr Range kHardening_Pa{0, 1e12};
inline constexpr Range kElongation{1e-3, 10};
inline constexpr Range kReinforcement_percent{0, 10};
inline constexpr Range kImpactRadius_m{0.001, kInfinity};  ///< A sphere of radius 0 has no cells.

// Fracture patterns.
inline constexpr Range kCells{2, 5000}, kRings{1, 100}, kSpokes{3, 200}, kColors{0, 5000};
inline constexpr double kMostGridCells = 30;  ///< Along each side.
inline constexpr Range kFalloff{1, 10};
inline constexpr Range kBrick_m{1e-3, 1000};

// Debris and dust of new crack faces.
inline constexpr Range kParticles_per_m2{0, 1e5};
inline constexpr Range kDebrisRadius_m{0.0005, 1};
inline constexpr Range kDust_kg_m2{0, 100};
inline constexpr Range kDustSettling_m_s{0, 10};

// The step, and the solver.
/// Steps of a world have no frames to fit in; those of a scene file do.
inline constexpr Range kStep_s{1e-6, 1}, kFileStep_s{1e-6, 1.0 / 60 + 1e-9};
inline constexpr Range kSubsteps{1, 1000}, kSweeps{1, 1000}, kMaxColors{0, 64}, kLanes{0, 16};
inline constexpr Range kErrorTarget_m{0, 1};

// Limits of counts and work.
inline constexpr Range kBodies{1, 200000}, kAgeing{0, 200000}, kFullDetail{0, 200000};
inline constexpr Range kPartsAFrame{1, 1e6}, kWork{1, 4e9}, kImpactBonds{0, 4e9};
inline constexpr Range kDebris{0, 200000}, kDust{0, 100000};
inline constexpr Range kLoadedConvexes{2, 1e6}, kClusterBodies{2, 10000}, kProbeEvents{2, 10000};
inline constexpr Range kBreakRounds{1, 1000};
inline constexpr Range kPieceSizeFactor{0, 100}, kChipSizeFactor{1, 100};

// Actions.
inline constexpr Range kBlastRadius_m{0.01, 1000};
inline constexpr Range kBlastImpulse_Ns_m2{0.001, 1e9};
inline constexpr Range kTnt_kg{0.001, 1e6};
inline constexpr Range kForce{0, kInfinity};  ///< In N, or N m.

}  // namespace ranges
}  // namespace sunder
