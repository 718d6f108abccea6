// Every number of the rigid solver that somebody has tuned, by the rule it belongs to. What is
// mathematics, rounding, or room for work and memory stays where it is used.
//
// Lengths are shares of the inner radius of the smaller shape of a contact, unless they say
// otherwise; speeds and times are in those of falling (engine/base/froude.h, docs/decisions/034).
#pragma once

#include <cstddef>
#include <cstdint>

namespace sunder::solver {

// Softness of contacts (decision 003).

/// Contact frequency times substep, by the number of points less one. Two sweeps keep up with 0.25
/// where pieces touch in a point or two, as rubble does. Faces that meet in four are four springs
/// side by side, and friction as stiff as they are makes a standing wave of a wall.
inline constexpr double kPressStiffness[4] = {0.25, 0.25, 0.2, 0.18};
inline constexpr double kSlideStiffness[4] = {0.25, 0.25, 0.125, 0.125};
inline constexpr double kDampingRatio = 5;  ///< To critical.
inline constexpr double kPush = 4;  ///< Fastest correction of an overlap, speeds of falling.

// Stiffening: springs go by the mass they hold, so a pebble that boulders press into a corner sinks
// in by a share of its size. What gives way by more gets stiffer; slowly, or an impact would be
// thrown back by a spring that hardened while it was compressed (decision 031).

inline constexpr float kMostGive = 0.01f;
inline constexpr float kLeastCompliance =
    0.1f;  ///< Of the softness: beyond, sweeps do not keep up.
/// Of it, for what is not pinched: what stands on it bounces at 0.3.
inline constexpr float kLeastProp = 0.5f;
inline constexpr float kComplianceStep = 0.97f;  ///< Of it, a step.
/// Loaded manifolds from which on a piece is pinched; a pebble under a column, held by two, would
/// bounce off contacts that get much stiffer.
inline constexpr std::uint8_t kPinched = 3;

// The static warm start (decision 023).

inline constexpr double kWork = 2e5;  ///< Points swept, about; at least four rounds.
inline constexpr double kNearlyDone =
    1e-7;                                  ///< Of the loads' squares: what falls by then will fall.
inline constexpr double kMostLeft = 0.01;  ///< Of the energy of a substep of free fall.
inline constexpr double kSlowStart = 2;  ///< In g·dt: what is faster is under no load to be known.
inline constexpr float kMostOverlap =
    0.04f;                                ///< Deeper is not at rest; as far apart bears nothing.
inline constexpr float kMostRest = 0.1f;  ///< Farthest that a seat may be from a touch.
inline constexpr float kNoGap = 1e-4f;    ///< Rounding, or what would hardly be seen.
inline constexpr float kLeastSlope =
    0.2f;  ///< Cosine to the vertical of a normal that bears weight.

// Conjugate gradients (decision 028).

/// Sweeps a substep: fewer are over before those know their way.
inline constexpr int kAccelerateFrom = 4;

// Rebounds and strikes (decision 035).

inline constexpr int kStrikeRounds = 16;   ///< A substep: balls in a row that pass an impact on.
inline constexpr double kLeastImpact = 2;  ///< In g·h: what is slower does not rebound.

// Rest.

inline constexpr double kMoves = 1e-5;      ///< Of a body's reach, in a step: less is rest.
inline constexpr float kLeastWay = 1e-5f;   ///< What bodies move on unheeded.
inline constexpr float kStill = 1e-6f;      ///< A way that is not worth a look.
inline constexpr double kStillSpin = 1e-6;  ///< rad in a step: its inertia hardly turns.

// The guard of energy (decision 029).

inline constexpr double kSlowFalls = 4;  ///< In g·dt: where nothing is faster, nothing is weighed.

// Where shapes touch.

inline constexpr float kMargin = 0.05f;         ///< Contact before touch.
inline constexpr float kTouch = 1e-3f;          ///< Where an impact lands.
inline constexpr float kAxisTolerance = 0.01f;  ///< How much better another axis must be.
inline constexpr float kFast = 0.5f;            ///< In a step: its time of impact is looked for.
inline constexpr float kSliver = 1e-3f;  ///< An overlap of faces that is no area (decision 030).
inline constexpr float kApart = 0.5f;    ///< Cosine between two faces that leave no area.
inline constexpr float kLeastInner = 0.02f;  ///< Inner radius of a sliver, of its reach.

// The lowest layer (decision 031).

inline constexpr float kLayer = 0.02f;  ///< Points so far above the lowest still count.

// Manifolds that are kept, and points (decision 033).

inline constexpr float kReuseMove = 0.03f;
inline constexpr float kReuseRotation = 0.005f;  ///< Half-angle, rad.
inline constexpr float kMatchDistance = 0.5f;    ///< Between points that inherit impulses.
inline constexpr float kRocks = 0.25f;      ///< What moves no farther in a step keeps old points.
inline constexpr float kKeepSlide = 0.05f;  ///< An old point slid away.
inline constexpr float kKeepApart = 0.1f;   ///< Nearer to a new one, an old one tells nothing new.
inline constexpr float kKeepAlong = 0.9f;   ///< Cosine of how far the normal may have turned.
inline constexpr std::size_t kRocking = 2;  ///< Points: more, and there was an area to stand on.

// Crowds (decision 020).

inline constexpr float kDeep = 0.1f;  ///< A deep contact.
/// With more deep contacts on a body than these, each is pushed apart at a share of the fastest,
/// all of them together as fast as so many would be: however many lie in one place.
inline constexpr std::uint32_t kCrowdOfDeep = 8, kDeepTogether = 2;
inline constexpr std::uint64_t kMostDeep =
    24;  ///< Deep contacts of a body, about; of more, a share.
/// Neighbours of a shape that are looked at however deep they overlap, about.
inline constexpr std::size_t kCrowd = 24;
/// Shapes overlap deeply if their middles are nearer than this share of their inner radii together.
inline constexpr double kDeepMiddles = 0.9;

// Boxes.

inline constexpr float kFat = 0.15f;        ///< Room of a box for a few steps, of the inner radius,
inline constexpr double kFatSteps = 2;      ///< and of the motion, steps.
inline constexpr int kRefitsPerBuild = 12;  ///< Of the tree of what moves.

// Sleep (decision 016). Rest is judged by the way, not by speed: a light piece pinched by heavy
// ones trembles on the spot at centimetres a second for ever, and would keep its neighbours awake.
// No step can tell what is slower than what gravity does in it, nor a few steps what is about to
// tip.

inline constexpr double kDrift = 0.005;  ///< Of the reach, within the time of rest.
inline constexpr double kSlow = 0.25;    ///< Speeds of falling.
inline constexpr double kHit = 0.08;     ///< Speeds of falling.
inline constexpr double kRestTime =
    2.6;  ///< Times of falling (half a second for a piece of 35 cm).
inline constexpr double kRestSteps = 20;
inline constexpr float kChange = 0.3f;  ///< Of the sleeper's weight: what wakes it.
/// Of what each contact carried, in addition. Where stones press each other with many times their
/// weight, one that wakes shifts a fifth of that on; less than this, and waking goes round for
/// ever.
inline constexpr float kLoadChange = 0.3f;

// Joints (decision 026).

inline constexpr double kRate = 0.25;    ///< Of an error that a substep takes out.
inline constexpr double kJointPush = 2;  ///< Fastest correction, speeds of falling.
/// Of the stiffness of a tension in a substep: damping begins, and grows by more than the tension
/// does, since what bends over many links is damped less than what bends at every one.
inline constexpr double kStiff = 1, kStiffest = 24;

// Spins.

/// Rad in a step; slower, the gyroscopic term is left out. What it does adds up over turns.
inline constexpr double kGyroscopicAngle = 1e-4;
inline constexpr double kLargestAngle = 0.1;  ///< Rad in one midpoint step.
inline constexpr double kFastestAngle = 100;  ///< Rad in a step; faster, no rule follows it.
inline constexpr double kLeastMoment = 1e-4;  ///< Of inertia, of the largest.
inline constexpr double kUneven = 0.95;       ///< Of the largest: less, and what spins wobbles.

}  // namespace sunder::solver
