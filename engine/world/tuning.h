// Every tuned number of the stages of a step, by the rule that uses it. Constants of mathematics,
// of rounding, of published fits and of memory are defined where they are used.
// tests/check_tuning.py checks that tuned numbers are here and commented.
#pragma once

#include <cstddef>
#include <cstdint>
#include <numbers>

namespace sunder {

// Arguments of World.

/// Bounds of the time of World::step(): gravity moves a body by 5 cm in the longest.
inline constexpr double kShortestStep_s = 1e-6, kLongestStep_s = 0.1;

// Impacts that may break a solid (decisions 017, 049).

/// Minimum area of a crack through a solid, as a fraction of V^(2/3) of the volume V in reach.
inline constexpr double kMinCrackArea = 0.1;
/// Maximum number of convexes that are checked for a plate; a structure with more is taken to have
/// one.
inline constexpr std::size_t kMaxThinChecks = 8;
/// Bound on the growth of a contact's impulse and speed by the solve of other contacts, a factor.
inline constexpr double kMaxImpulseGain = 2;
/// Number of touching pairs of convexes of two bodies from which each pair counts as one contact.
inline constexpr std::size_t kMinMergedPairs = 4;
/// Largest share of an impact's energy that goes into the cracks of a solid that just breaks (Grady
/// 1988, with a crack across of the area of a side).
inline constexpr double kGradyShare = 0.24;
/// Speed at which a plate breaks that lands flat, over that whose wave has its strength: the stress
/// of bending is added to that of the wave.
inline constexpr double kFlatLanding = 0.78;
/// Impedance of the ground, Pa·s/m: that of concrete.
inline constexpr double kGroundImpedance_Pa_s_m = 8.5e6;

// Plans that are not made again (decisions 038, 047).

/// Fraction of the energy that the last plan needed, below which an impact is not planned again.
inline constexpr double kReplanEnergyShare = 0.7;
/// Energy below which an impact is not planned again after a plan in which the pattern cut nothing,
/// as a multiple of the energy of that plan's impact.
inline constexpr double kReplanEnergyGrowth = 1.4;
/// Fraction of the energy that would have bent the solid to its limit at the last impact, perhaps
/// at another point, below which an impact is not planned by stress.
inline constexpr double kRetryEnergyShare = 0.1;
/// Fraction of the impulse that would have bent the solid to its limit at the last impact, below
/// which an impact is not planned by stress.
inline constexpr double kRetryImpulseShare = 0.3;

// Breaks by stress (decision 038).

/// Maximum evaluations of each bond in a plan by stress of a solid that may also break by a
/// pattern. An impact that is undecided after them is planned again only with more energy.
inline constexpr std::uint64_t kPatternEvaluationsPerBond = 100;
/// Maximum evaluations of each bond in a plan of a solid that only stress can break; slender frames
/// need more than other solids.
inline constexpr std::uint64_t kStressOnlyEvaluationsPerBond = 1200;
/// Bound on the highest stress of a struck solid, as a multiple of that of a bar in its first mode
/// at the same mean speed: covers eccentric impacts, other shapes and the steady load (decision
/// 047).
inline constexpr double kStressBoundFactor = 4;
/// Maximum fraction of an impact's energy that a break by stress takes, whatever its cracks need.
inline constexpr double kMaxStressBreakShare = 0.9;

// Strikers that drive out a plug (decision 047).

/// Minimum cosine between a striker's relative velocity and the contact normal for a path along
/// that velocity; other strikers glance.
inline constexpr double kMinPathCosine = 0.4;
/// Minimum work of a striker, as a fraction of that of all that strikes at once, for a striker that
/// is alone.
inline constexpr double kMinShareAlone = 0.99;
/// Number of corners of the cross-section of a ball.
inline constexpr int kRoundSectionCorners = 8;
inline constexpr std::size_t kMaxSectionCorners = 8;  ///< Maximum corners of another cross-section.
/// Minimum area of a cross-section, as a fraction of its squared width.
inline constexpr double kMinSectionArea = 1e-2;
/// Maximum thickness that a striker perforates, in distances of its section's farthest corner from
/// the point of impact.
inline constexpr double kMaxPerforatedReaches = 8;
/// Distance from the middle of the section of the points that are tested for material around it, as
/// a multiple of that of its corners.
inline constexpr double kConfinementScale = 1.5;
/// Minimum fraction of the tested points around a section that are inside the solid, for a plug.
inline constexpr double kMinConfinement = 0.45;

// Budget of a frame for breaking, in parts to cut (decision 032).

/// Number of parts that a convex in reach of a pattern counts as.
inline constexpr std::size_t kPartsPerConvex = 8;
/// Number of evaluations of bonds in a solve for stress that take the time of one part.
inline constexpr std::uint64_t kBondEvaluationsPerPart = 160;
/// Number of evaluations of contacts in an impact probe that take the time of one part.
inline constexpr std::uint64_t kContactEvaluationsPerPart = 1000;
/// Number of clusters that are probed between two checks of the budget.
inline constexpr std::size_t kProbesAtOnce = 16;
/// Energy of an impact, as a fraction of all kinetic energy, below which the impact breaks nothing
/// once the budget is spent: it is neither probed nor deferred.
inline constexpr double kMinDeferredShare = 1e-3;
/// Closing speed above which a body that would hit a paused one is paused too, m/s: it would hit
/// the paused body like a wall.
inline constexpr double kPauseSpeed_m_s = 0.5;
/// Number of deferred clusters that are probed again in one round.
inline constexpr int kReleasedClustersPerRound = 3;

// Steady loads (decision 012).

/// Time constant of the mean of contact and joint forces, s: a push counts alike at every step
/// size.
inline constexpr double kForceAveragingTime_s = 0.1;
/// Change of the load on a convex for which the stress is solved again, as a fraction of the old
/// load with self-weight; for spin, of the squared angular velocity.
inline constexpr double kMinLoadChange = 0.1;
/// Change of a load that never counts, as a fraction of the actor's weight.
inline constexpr double kNegligibleLoad = 1e-5;
/// Mean force that is dropped, as a fraction of a negligible load.
inline constexpr double kNegligibleMeanForce = 0.1;
/// Stress ρ ω² r² of a spin that is not evaluated, as a fraction of the weakest limit. The largest
/// stress is half of ρ ω² r² in a rod, all of it in a ring, and more only where spin bends hollow
/// or curved solids.
inline constexpr double kNegligibleSpin = 0.03;
/// Number of evaluations of each bond reserved for an actor; those that it leaves go to others.
inline constexpr std::uint64_t kReservedEvaluationsPerBond = 30;
/// Maximum work that is saved up, in the work of a frame.
inline constexpr std::int64_t kMaxSavedFrames = 2;

// Plastic hinges (decision 039).

/// Growth of the strain for which the strength of a joint is updated, as a fraction of the
/// elongation at which it tears.
inline constexpr double kMinStrainUpdate = 0.01;
/// Time without yielding after which the sides of a hinge are joined for the first time, s.
inline constexpr double kRejoinDelay_s = 0.25;
/// Maximum number of times that kRejoinDelay_s is doubled, once for each time an actor was joined.
inline constexpr std::uint32_t kMaxRejoinDoublings = 12;
/// Maximum evaluations of each bond in the stress solve of the joined actor.
inline constexpr std::uint64_t kRejoinEvaluationsPerBond = 3000;
/// Bending since a hinge was last drawn for which it is drawn again, rad.
inline constexpr double kRedrawAngle_rad = 0.5 * std::numbers::pi / 180;
/// Sliding since a hinge was last drawn for which it is drawn again, as a fraction of the section's
/// reach.
inline constexpr double kRedrawSlide = 2e-3;

// Script (decision 013), bodies and joints.

/// Time in which a blast breaks solids before it pushes them, s.
inline constexpr double kBlastBreakTime_s = 0.05;
/// Maximum edge of a triangle of a face, as a fraction of its distance from the blast.
inline constexpr double kMaxBlastEdge = 0.35;
/// Maximum number of times that the edges of a triangle are halved for a blast.
inline constexpr int kMaxBlastHalvings = 4;
/// Distance from a point where a blast was tried within which it is not tried again, as a fraction
/// of the material's impact radius.
inline constexpr double kTriedBlastRadius = 0.6;
/// Number of cells along an edge of the cube of directions, for the cover from a blast.
inline constexpr int kCoverCellsPerEdge = 48;
/// One over the fraction of the limit of bodies that is kept free for breaks.
inline constexpr std::uint32_t kBodyReserve = 16;
/// Maximum distance of a joint's anchor from a piece that keeps it, as a fraction of the piece's
/// size.
inline constexpr double kAnchorTolerance = 0.02;

}  // namespace sunder
