// Every tuned number of impact probes (decision 017), by the rule that uses it. Constants of
// mathematics and of rounding are defined where they are used. tests/check_tuning.py checks that
// tuned numbers are here and commented.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sunder::solver {

// Events of a probe.

/// Number of events that are taken in order of time. Each later one is the contact with the most
/// closing energy in the rest of the step, with all that close before it: a ball behind debris is
/// still found.
inline constexpr std::uint32_t kOrderedEvents = 12;
/// Bound on closing speeds after the solve of other contacts, as a multiple of the highest speed of
/// the event.
inline constexpr double kMaxProbeSpeedGain = 2;
/// Minimum closing energy of a contact that starts an event, as a fraction of the least work that
/// may break a body.
inline constexpr double kMinEventEnergy = 0.1;
/// Acceleration of a body by gravity and joints below which it hangs at rest, as a fraction of
/// gravity.
inline constexpr double kHangingAcceleration = 1e-4;

/// Maximum speed of a body relative to a striker, as a fraction of the striker's, at which the two
/// strike as one.
inline constexpr double kMaxRiderSpeed = 0.2;

// Solve of a cluster.

/// Compliance of a contact, as a fraction of the inverse mass of the heaviest body: supports share
/// their load.
inline constexpr double kProbeSoftness = 1e-5;
/// Maximum number of contacts of a group that is solved exactly. Exact solves of all groups took
/// forty times the time of the whole step in `house`.
inline constexpr std::size_t kMaxExactContacts = 48;
/// Maximum number of sweeps of a larger group. With ten, a fifth fewer pieces broke in `temple`.
inline constexpr int kMaxProbeSweeps = 20;
/// Closing speed of a contact at rest, as a fraction of the highest closing speed.
inline constexpr double kProbeConvergence = 1e-2;

// The exact solve, by block principal pivoting.

inline constexpr int kMaxPivots = 200;  ///< Maximum number of exchanges.
/// Number of block exchanges without progress before exchanges of single contacts.
inline constexpr int kPivotPatience = 3;
/// Maximum number of sweeps by projected Gauss-Seidel if pivoting does not end.
inline constexpr int kMaxFallbackSweeps = 200;

}  // namespace sunder::solver
