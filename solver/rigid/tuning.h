// Every tuned number of the rigid solver, by the rule that uses it; docs/ablation.md has the
// effect of each rule as it was measured. Constants of mathematics, of rounding and of memory are
// defined where they are used. tests/check_tuning.py checks that tuned numbers are here and
// commented.
//
// A length is a fraction of the inner radius of the smaller shape of a contact, unless its comment
// says otherwise. Speeds and times are multiples of the speed and time of falling by a body's size
// (engine/base/froude.h, docs/decisions/034).
#pragma once

#include <cstddef>
#include <cstdint>

namespace sunder::solver {

// Softness of contacts (decision 003).

/// Frequency of a contact of one or two points, times the substep. Two sweeps solve contacts of
/// this stiffness in rubble, where pieces touch in one or two points.
inline constexpr double kPointStiffness = 0.25;
/// Frequency of a contact of three or more points, times the substep: its points are springs in
/// parallel, and a stiffer wall has standing waves. Their friction has half of kPointStiffness.
inline constexpr double kFaceStiffness = 0.18;
inline constexpr double kDampingRatio = 5;  ///< Damping of a contact over critical damping.
/// Maximum speed at which an overlap is corrected, in speeds of falling by the inner radius.
inline constexpr double kMaxPushSpeed = 4;

// Stiffening: the stiffness of a contact follows from the mass of its bodies, so boulders would
// press a pebble into a corner by a fraction of its size. A contact that is compressed by more than
// kStiffeningDepth becomes stiffer; slowly, since a spring that hardens while an impact compresses
// it would throw the bodies back (decision 031).

inline constexpr float kStiffeningDepth =
    0.01f;  ///< Compression above which a contact becomes stiffer.
/// Minimum compliance of a contact of a pinched body, as a fraction of its unloaded compliance. The
/// sweeps do not converge at a lower one.
inline constexpr float kMinPinchedCompliance = 0.1f;
/// Minimum compliance of a contact of any other body: a body on such contacts bounces at 0.3.
inline constexpr float kMinCompliance = 0.5f;
/// Factor by which the compliance of a contact changes in a step, at most.
inline constexpr float kComplianceStep = 0.97f;
/// Number of loaded manifolds from which a body counts as pinched. A pebble under a column has two,
/// and would bounce off contacts as stiff as kMinPinchedCompliance.
inline constexpr std::uint8_t kPinchedContacts = 3;

// Rest. These speeds are multiples of g·dt, the speed that gravity adds in a step.

/// Speed below which a new contact is at rest, and gets a static warm start (decision 023).
inline constexpr double kRestingSpeed = 2;
/// Closing speed below which a contact does not rebound; multiple of g·h, h being the substep.
inline constexpr double kReboundSpeed = kRestingSpeed;
/// Speed of a body above which the energy guard is active (decision 029).
inline constexpr double kGuardedSpeed = 2 * kRestingSpeed;
/// Minimum closing speed of an impact that is propagated (decision 036).
inline constexpr double kMinImpactSpeed = 2 * kRestingSpeed;

// Landings: contacts whose normal impulse has just begun.

/// Closing speed below which a contact does not land; multiple of g·h, h being the substep.
inline constexpr double kLandingSpeed = kReboundSpeed;
/// Maximum number of times that a sweep solves a contact that lands. With fewer, a cube of 20 m/s
/// that lands flat turns over.
inline constexpr int kLandingRounds = 8;

/// Motion of two bodies against each other in a step below which their contact is not tested again.
inline constexpr float kStillMotion = 1e-6f;
/// Motion in a step below which the lever arms of a contact are kept; for the check of all bodies,
/// a fraction of a body's reach.
inline constexpr float kArmMotion = kStillMotion;
/// Rotation in a step below which a body has no gyroscopic term, rad.
inline constexpr float kStillAngle = kStillMotion;

// The static warm start (decision 023).

/// Maximum kinetic energy that a supported body has left, over that of a substep of free fall.
inline constexpr double kMaxResidualEnergy = 0.01;
/// Minimum cosine between the vertical and the normal of a contact that supports weight.
inline constexpr float kMinSupportCosine = 0.2f;

// Contact distances and overlaps (decisions 030, 031).

/// Distance within which shapes have a contact before they touch, besides their motion in the step.
inline constexpr float kContactMargin = 0.05f;
/// Distance that a box of the broad phase has around its shape; a fat box has three more.
inline constexpr float kBoxMargin = kContactMargin;
/// Overlap up to which two bodies that pass each other have no contact in the way.
inline constexpr float kPassingOverlap = kContactMargin;
/// Distance that a kept contact point may slide (decision 033).
inline constexpr float kKeptPointSlide = kContactMargin;
/// Maximum gap or overlap of a new contact at rest (decision 023).
inline constexpr float kRestingDistance = kContactMargin;

/// Overlap of two faces up to which they touch without area (decision 030).
inline constexpr float kEdgeOverlap = 1e-3f;
/// Distance from a facet's sides within which a contact point is on the facet.
inline constexpr float kFacetTolerance = kEdgeOverlap;
/// Gap at which a ball that is cast counts as touching.
inline constexpr float kBallImpactGap = kEdgeOverlap;
/// Gap that the static warm start takes for none (decision 023).
inline constexpr float kClosedGap = kEdgeOverlap;

/// Distance from the deepest point within which points of a contact count as deep (decision 031).
inline constexpr float kDepthTolerance = 0.02f;
/// Half of this is the separation by which an axis must be better than a preferred one.
inline constexpr float kAxisPreference = kDepthTolerance;
inline constexpr float kMaxEdgeCosine =
    0.5f;  ///< Maximum cosine between two faces that touch without area.
/// Minimum inner radius of a hull as a tolerance, as a fraction of its reach.
inline constexpr float kMinInnerRadius = 0.02f;

/// Overlap from which a contact is deep (decision 020).
inline constexpr float kDeepOverlap = 0.1f;
/// Overlap at the start of a step from which a shape that passes through another is not put back.
inline constexpr float kPassageOverlap = 0.5f;
/// Overlap of two balls of the inner radii from which shapes of a dense cluster may be skipped; a
/// fraction of the sum of the radii.
inline constexpr float kDenseOverlap = kDeepOverlap;
/// Maximum distance between the rest separation of a contact and touch (decision 023).
inline constexpr float kMaxRestOffset = kDeepOverlap;

// Manifolds and points that are kept (decision 033), and casting.

/// Motion since a manifold was built, from which the manifold is built again; or a rotation that
/// moves a point at three inner radii by this distance.
inline constexpr float kMaxReuseMotion = 0.03f;
/// Motion in a step above which a ball is cast: its normal depends on where it touches.
inline constexpr float kBallCastingMotion = kMaxReuseMotion;
/// Motion in a step above which a pair is cast (continuous collision).
inline constexpr float kCastingMotion = 0.5f;
/// Motion by rotation in a step above which a pair that is cast turns on its way.
inline constexpr float kTurningMotion = kContactMargin;
/// Closing speed of an end of a body after an impact at its other end, over the speed before.
inline constexpr float kSwing = 2;
/// Cosine of the greatest angle to the axis of two edges at which faces swing together: 45 degrees.
inline constexpr float kSwingCosine = 0.7f;
/// Distance between contact points of two steps above which they are different points.
inline constexpr float kPointMatchDistance = kCastingMotion;
/// Motion in a step above which no old contact points are kept.
inline constexpr float kKeptPointMotion = 0.5f * kCastingMotion;
/// Closing in a step below which a contact is no impact (decision 036).
inline constexpr float kImpactMotion = 0.5f * kCastingMotion;

// Seams between shapes that bear another together.

/// Maximum step between two flush shapes.
inline constexpr float kSeamTolerance = 0.01f;
/// Cosine of the least angle between two faces that are not one surface: 2 degrees.
inline constexpr float kSeamCosine = 0.9994f;

// Dense clusters: many overlapping shapes (decision 020).

/// Number of neighbours of a shape above which only some of its pairs are tested.
inline constexpr std::size_t kMaxNeighbours = 24;
/// Number of deep contacts of a body above which only some of them are kept.
inline constexpr std::size_t kMaxDeepContacts = kMaxNeighbours;

// Sleep (decision 016). Rest is decided by drift and not by speed alone: a light piece pinched by
// heavy ones vibrates in place at centimetres a second, and would keep its neighbours awake. A
// speed below that of gravity in a step cannot be measured, nor tipping in a few steps.

/// Maximum drift of a body during the time of rest, as a fraction of its reach.
inline constexpr double kMaxRestDrift = 0.005;
/// Maximum drift of a body that has been slow for long, in those of one that has just become slow:
/// the drift that counts as rest grows by kMaxRestDrift with each time of rest that it was slow.
inline constexpr double kPatience = 8;
/// Weight that the lost contacts of a body at rest may have carried, as a fraction of its weight: a
/// smaller one moves the body by no more than kMaxRestDrift.
inline constexpr double kMaxLostSupport = kMaxRestDrift;
inline constexpr double kMaxRestSpeed =
    0.25;  ///< Maximum speed of a body at rest, in speeds of falling.
/// Closing speed from which a contact wakes a sleeping body, in speeds of falling.
inline constexpr double kHitSpeed = kMaxRestSpeed / 3;
/// Speed down to which an impact wakes bodies behind the one that it strikes, in speeds of falling.
inline constexpr double kPassedSpeed = kHitSpeed / 8;
/// Minimum time of rest before sleep, in times of falling: half a second for a piece of 35 cm.
inline constexpr double kMinRestTime = 2.6;
inline constexpr double kMinRestSteps = 20;  ///< Minimum time of rest before sleep, in steps.
/// Change of the contact forces on a sleeping body that wakes it, as a fraction of its weight. In
/// heaps whose stones press each other with many times their weight, a stone that wakes changes
/// those forces by a fifth, and with a smaller value wakes never end.
inline constexpr float kWakingForceChange = 0.3f;
/// Change of a contact's force that does not count, as a fraction of the force.
inline constexpr float kIgnoredForceChange = kWakingForceChange;
/// Minimum force, as a fraction of a body's weight, with which another body supports it.
inline constexpr float kSupportingForce = kWakingForceChange;
/// Contacts that can be listed by body in the time in which those of one shape are found in the
/// tree of boxes. It has no effect on results.
inline constexpr std::size_t kManifoldsPerQuery = 64;

// Joints (decision 026).

/// Fraction of a joint's error that a substep corrects.
inline constexpr double kJointCorrection = kPointStiffness;
/// Maximum speed at which an error of a joint is corrected, in speeds of falling by the reach.
inline constexpr double kMaxJointPushSpeed = kMaxPushSpeed;
/// Stiffness of a tension, h²·K/I, above which damping grows faster than the tension: a chain that
/// bends over many links is damped less than one that bends at each link.
inline constexpr double kMaxTensionStiffness = 24;

// Free rotation.

inline constexpr double kMaxMidpointAngle = 0.1;  ///< Maximum rotation in one midpoint step, rad.

}  // namespace sunder::solver
