// Every number of the rigid solver that somebody has tuned, by the rule it belongs to: what each
// rule buys is in docs/ablation.md. What is mathematics, rounding, or room for work and memory
// stays where it is used. tests/check_tolerances.py counts them.
//
// Lengths are shares of the inner radius of the smaller shape of a contact, unless they say
// otherwise; speeds and times are in those of falling (engine/base/froude.h, docs/decisions/034).
#pragma once

#include <cstddef>
#include <cstdint>

/// Numbers change in the copy of the solver that ablation_bench is linked with.
#ifdef SUNDER_ABLATION
#define SUNDER_TUNED inline
#else
#define SUNDER_TUNED inline constexpr
#endif

namespace sunder::solver {

// Softness of contacts (decision 003).

/// Contact frequency times substep: two sweeps keep up with it where pieces touch in a point or
/// two, as rubble does. Of joints, the share of an error that a substep takes out.
SUNDER_TUNED double kStiffness = 0.25;
/// Of faces, whose points are springs side by side, or a wall makes standing waves; friction
/// between them is half as stiff as a point.
SUNDER_TUNED double kFaceStiffness = 0.18;
SUNDER_TUNED double kDampingRatio = 5;  ///< To critical.
/// Fastest correction of an overlap, in speeds of falling; of joints, by the reach.
SUNDER_TUNED double kPush = 4;

// Stiffening: springs go by the mass they hold, so a pebble that boulders press into a corner sinks
// in by a share of its size. What gives way by more gets stiffer; slowly, or an impact would be
// thrown back by a spring that hardened while it was compressed (decision 031).

SUNDER_TUNED float kMostGive = 0.01f;        ///< Softer than this, a contact gets stiffer.
SUNDER_TUNED float kLeastCompliance = 0.1f;  ///< Of the softness: beyond, sweeps do not keep up.
/// Of it, for what is not pinched: what stands on it bounces at 0.3.
SUNDER_TUNED float kLeastProp = 0.5f;
SUNDER_TUNED float kComplianceStep = 0.97f;  ///< Of it, a step.
/// Loaded manifolds from which on a piece is pinched; a pebble under a column, held by two, would
/// bounce off contacts that get much stiffer.
SUNDER_TUNED std::uint8_t kPinched = 3;

// Rest.

/// In g·dt, of a step or a substep: what is slower rests. It may bear a load from the first step on
/// (decision 023), and does not rebound; what moves twice as fast is watched for energy (029), and
/// no slower impact is looked for (036).
SUNDER_TUNED double kSlowFalls = 2;
/// In a step, of the inner radius or of a body's reach, and in rad: what moves less lies still, and
/// needs no look, no new arms and no gyroscopic term.
SUNDER_TUNED float kStill = 1e-6f;

// The static warm start (decision 023).

SUNDER_TUNED double kMostLeft = 0.01;   ///< Of the energy of a substep of free fall.
SUNDER_TUNED float kLeastSlope = 0.2f;  ///< Cosine to the vertical of a normal that bears weight.

// Where shapes touch.

/// Contact before touch, and what rests is no farther from one (decision 023); how far a point may
/// slide that is kept (033). Boxes have room for three.
SUNDER_TUNED float kMargin = 0.05f;
/// An overlap of faces that is no area (decision 030), and a gap that is none to what rests (023).
SUNDER_TUNED float kSliver = 1e-3f;
/// Points so far above the lowest still count (031); half as much must another axis be better.
SUNDER_TUNED float kLayer = 0.02f;
SUNDER_TUNED float kApart = 0.5f;  ///< Cosine between two faces that leave no area.
/// Inner radius of a sliver, at least, of its reach.
SUNDER_TUNED float kLeastInner = 0.02f;
/// A contact as deep is deep, so are shapes whose middles are nearer by as much than balls that
/// touch (decision 020), and no seat is farther from a touch (023).
SUNDER_TUNED float kDeep = 0.1f;

// Manifolds that are kept, and points (decision 033).

/// Farther, and a manifold is made anew; or turned by as much at three inner radii.
SUNDER_TUNED float kReuse = 0.03f;
/// Is elsewhere: points as far from each other are others, and what moves as far in a step is
/// looked ahead for; what moves half as far keeps no old points, and what closes by as much is an
/// impact (036).
SUNDER_TUNED float kFar = 0.5f;

// Crowds (decision 020).

/// Neighbours of a shape, and deep contacts of a body, that are looked at, about; of more, a share.
SUNDER_TUNED std::size_t kCrowd = 24;

// Rules without a number at which they are off, for ablation_bench: the guard of energy (029),
// strikes (035), conjugate gradients (028), points that are kept (033), looking ahead for impacts.

SUNDER_TUNED bool kGuards = true, kStrikes = true, kAccelerates = true, kKeeps = true,
                  kLooksAhead = true;

// Sleep (decision 016). Rest is judged by the way, not by speed: a light piece pinched by heavy
// ones trembles on the spot at centimetres a second for ever, and would keep its neighbours awake.
// No step can tell what is slower than what gravity does in it, nor a few steps what is about to
// tip.

/// Of the reach, within the time of rest. The load of a body also moves by no more than this while
/// the contacts that it lost carried no larger share of its weight.
SUNDER_TUNED double kDrift = 0.005;
SUNDER_TUNED double kSlow = 0.25;     ///< Speeds of falling; a third of it is a hit.
SUNDER_TUNED double kRestTime = 2.6;  ///< Times of falling (half a second for a piece of 35 cm).
SUNDER_TUNED double kRestSteps = 20;  ///< At least so many.
/// Of the sleeper's weight: what wakes it, beyond as much of what each contact carried. Where
/// stones press each other with many times their weight, one that wakes shifts a fifth of that on;
/// less than this, and waking goes round for ever.
SUNDER_TUNED float kChange = 0.3f;

// Joints (decision 026).

/// Of the stiffness of a tension in a substep: from here damping grows by more than the tension
/// does, since what bends over many links is damped less than what bends at every one.
SUNDER_TUNED double kStiffest = 24;

// Spins.

SUNDER_TUNED double kLargestAngle = 0.1;  ///< Rad in one midpoint step.

}  // namespace sunder::solver
