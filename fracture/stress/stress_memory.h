// What is known of a compound's stress from before: its springs, and where they last came to rest.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "engine/model/breaker.h"
#include "fracture/stress/stress_system.h"

namespace sunder::fracture {

/// How an impact bends a compound, as far as that is known.
struct KnownSwing {
  std::vector<ConvexSlot> struck;  ///< Convexes, in the order of the impulses.
  double impulse_Ns = 0;           ///< Sum of their magnitudes.
  std::vector<Displacement> displacements;
  Nodal<double> way;       ///< The last direction of the solve.
  std::uint64_t work = 0;  ///< Spent on impacts since the last answer.
};

/// What is handed back to the next solve.
struct KnownStress final : StressCache {
  std::vector<ConvexSlot> slots;  ///< Per convex.
  std::vector<ConvexPtr> convexes;
  std::vector<std::uint8_t> anchored;
  std::vector<Bond> bonds;
  std::shared_ptr<const StressSystem> system;
  std::vector<Displacement> displacements;  ///< Under the steady load.
  int iterations = 0;                       ///< Without coming to an end,
  Nodal<double> way;                        ///< and the last direction of these.
  KnownSwing swing;                         ///< By the last impact.

  bool is_of(const Compound& compound) const {
    // Bonds are only ever lost, so their number tells.
    return bonds.size() == compound.bonds.size() && convexes == compound.convexes &&
           anchored == compound.anchored;
  }
};

/// The system of a compound, and a guess of its displacements, from the memory of it or of what it
/// was a part of; null: of nothing. Adds to `work` what that took, in visits of springs.
std::shared_ptr<KnownStress> recall(const StressCache* memory, const Compound& compound,
                                    const std::vector<ConvexSlot>& slots,
                                    std::span<const Material> materials, std::uint64_t& work);

}  // namespace sunder::fracture
