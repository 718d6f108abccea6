// Every tuned number of debris and dust (decision 006), by the rule that uses it. Constants of
// mathematics, of rounding and of memory are defined where they are used. tests/check_tuning.py
// checks that tuned numbers are here and commented.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sunder::solver {

// Emission by crack faces.

/// Fraction of its particles that a crack emits without opening. With the same emission for all
/// faces, two thirds of the chips of `house` lay hidden in cracks.
inline constexpr double kClosedCrackEmission = 0.05;
/// Opening speed from which a crack emits all of its particles, m/s.
inline constexpr double kFullEmissionSpeed_m_s = 4;
/// Spall speed of a face that does not open, m/s.
inline constexpr double kSpallSpeed_m_s = 0.25;
inline constexpr double kSpallPerOpening = 0.04;  ///< Growth of the spall speed per opening speed.
/// Offset in the speed of a chip, spall speed / (u + offset) with u uniform in [0, 1): one chip in
/// ten is at least about six times as fast as the spall speed, none more than about 14 times. Of
/// chips of at most 0.6 m/s, nearly all lay hidden in the rubble of `house`.
inline constexpr double kSpallSpeedOffset = 0.07;
inline constexpr double kMaxChipSpin_s = 15;  ///< Maximum angular speed of a new chip, rad/s.
/// Velocity of new dust, as a fraction of that of its solid: air drag slows it down.
inline constexpr double kDustVelocity = 0.4;
/// Minimum radius of a new puff, m; the maximum is twice that.
inline constexpr double kMinPuffRadius_m = 0.09;

// Debris.

inline constexpr float kChipFriction = 0.6f;     ///< Coefficient of friction of a chip.
inline constexpr float kChipRestitution = 0.3f;  ///< Coefficient of restitution of a chip.
/// Minimum closing speed of a chip that rebounds, m/s.
inline constexpr float kMinReboundSpeed_m_s = 0.4f;
inline constexpr int kMaxChipBounces = 2;  ///< Maximum contacts per step, after the first one.
/// Gap between a chip and the surface that it touches, m.
inline constexpr double kChipContactGap_m = 2e-4;
/// Maximum speed at which a chip is pushed out of an obstacle, m/s.
inline constexpr double kMaxChipPushSpeed_m_s = 2;
/// Damping of a chip's spin in contact, 1/s; high, so that chips do not roll.
inline constexpr float kContactSpinDamping_1_s = 150;
inline constexpr float kFlightSpinDamping_1_s = 0.5f;  ///< Damping of a chip's spin in flight, 1/s.

inline constexpr float kMaxSleepSpeed_m_s = 0.1f;   ///< Maximum speed of a chip at rest, m/s.
inline constexpr float kMinChipRestTime_s = 0.25f;  ///< Minimum time at rest before sleep, s.
inline constexpr double kSupportShift_m = 1e-3;  ///< Motion of a support that wakes its chips, m.
/// Rotation of a support that wakes its chips, rad.
inline constexpr double kSupportTurn_rad = 1e-3;
/// Speed of an obstacle below which it is at rest for chips, m/s.
inline constexpr double kObstacleRestSpeed_m_s = 0.05;
inline constexpr float kChipFade_s = 0.75f;  ///< Time in which a fading chip shrinks to nothing, s.
/// One over the fraction of the limit of chips that is kept free for new ones.
inline constexpr std::uint32_t kChipReserve = 16;

// The grid of obstacles.

/// Size of a cell of level 0, m; the size doubles with each level.
inline constexpr float kFinestObstacleCell_m = 0.5f;
/// Distance within which a shape is entered into cells, m: a query box of up to twice this size
/// needs only one cell per level.
inline constexpr float kObstacleCellMargin_m = 0.0625f;
inline constexpr float kMaxCellsPerObstacle = 8;  ///< Maximum number of cells of a shape.
/// Margin of a query, m: bounces can use its result again.
inline constexpr float kObstacleQueryMargin_m = 0.005f;
inline constexpr float kMaxSharedQuery_m = 2;  ///< Maximum size of a query of several paths, m.
/// Maximum size of a query by cells, m; a larger one is tested against all shapes.
inline constexpr float kMaxHashedQuery_m = 8 * kFinestObstacleCell_m;
inline constexpr double kMaxPathPart_m = 2;  ///< Maximum length of a path in one query, m.
/// Maximum number of parts of a path; a longer path is one query.
inline constexpr double kMaxPathParts = 64;

// Dust.

/// Relaxation time of emitted dust to the velocity of the air, s.
inline constexpr float kDustSlipDecay_s = 0.15f;
/// Turbulent speed of new dust, as a fraction of its emission speed.
inline constexpr float kDustTurbulence = 0.2f;
/// Growth of a puff's squared radius in still air, m²/s.
inline constexpr float kDustSpread_m2_s = 0.004f;
/// Growth of a puff's squared radius by turbulence, as a fraction of cell size times turbulent
/// speed.
inline constexpr float kTurbulentSpread = 0.1f;
inline constexpr float kMaxDustOpacity = 0.45f;   ///< Maximum opacity of a puff, 0 to 1.
inline constexpr float kMinDustOpacity = 0.008f;  ///< Opacity below which a puff is removed.
inline constexpr float kDustFadeIn_s = 0.1f;      ///< Time in which a new puff appears, s.
inline constexpr float kDustFadeOut_s = 2;        ///< Time in which a settled puff disappears, s.
/// Solid fraction of a cell from which dust in it is settled.
inline constexpr float kSettledSolidFraction = 0.9f;
/// Factor by which the oldest puffs fade faster near the limit of puffs.
inline constexpr float kEarlyFadeRate = 4;
/// One over the fraction of the limit of puffs that is kept free for new ones.
inline constexpr std::uint32_t kPuffReserve = 16;

// The grid of air.

/// Number of cells wanted per puff; more are not worth their cost.
inline constexpr std::size_t kAirCellsPerPuff = 8;
/// One over the fraction of puffs, on each side, that may be outside the grid.
inline constexpr std::size_t kPuffsPerOutlier = 32;
/// Number of puffs, about, from which the box of the cloud is found.
inline constexpr std::size_t kCloudSamples = 4096;
/// Extent of a cloud for which an axis has half of its cells, as a fraction of the halved extent.
inline constexpr double kAirHalvingMargin = 0.75;
inline constexpr double kMinAirCell_m = 0.125;  ///< Minimum size of a cell, m.
/// Factor by which the size of cells changes, √2.
inline constexpr double kAirCellStep = 1.4142135623730951;
/// Margin around the dust when the grid is placed, as a fraction of the grid.
inline constexpr double kAirPlacingMargin = 0.15;
/// Margin around the dust below which the grid moves, as a fraction of the grid.
inline constexpr double kAirKeepingMargin = 0.075;
/// Height above the ground below which dust gets a grid with the ground as its floor, in cells.
inline constexpr double kAirGroundCells = 6;

// Flow of the air.

inline constexpr float kAirDensity_kg_m3 = 1.2f;  ///< Density of the air, kg/m³.
/// Fraction of linear interpolation in the advection; at 1, advection is of first order. Without
/// it, noise at grid scale grew from 3 to 12 m/s in 7 s.
inline constexpr float kLinearAdvection = 0.25f;
/// One over the thickness from which a wall is airtight, in cells.
inline constexpr float kCoverGain = 1.5f;
/// Minimum open fraction of a face: above 0, the pressure in closed rooms has a solution.
inline constexpr float kMinOpenFraction = 0.02f;
/// Net outflow of a cell at which the pressure solve ends, as a fraction of the fastest flow.
inline constexpr float kOutflowTolerance = 8e-4f;
inline constexpr int kMaxPressureIterations = 16;  ///< Maximum iterations of the pressure solve.
/// Number of smoothing sweeps before and after the correction by a coarser level.
inline constexpr int kSmoothingSweeps = 2;
inline constexpr int kCoarsestSweeps = 8;  ///< Number of sweeps on the coarsest level.

// Swirl: the one-equation model of turbulent energy.

inline constexpr float kTurbulenceProduction = 0.1f;   ///< Coefficient of production, C_k.
inline constexpr float kTurbulenceDissipation = 1.0f;  ///< Coefficient of dissipation, C_ε.

}  // namespace sunder::solver
