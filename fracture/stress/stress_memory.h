// State kept between stress solves of a structure: its spring system and the last displacements.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "engine/model/breaker.h"
#include "fracture/stress/stress_system.h"

namespace sunder::fracture {

/// Deflection of a compound by an impact, as far as it has been solved.
struct KnownDeflection {
  std::vector<ConvexSlot> struck;  ///< Convexes with impulses, in the order of the impulses.
  double impulse_Ns = 0;           ///< Sum of the magnitudes of the impulses.
  std::vector<Displacement> displacements;
  Nodal<double> last_direction;  ///< Last search direction of the solve.
  std::uint64_t work = 0;        ///< Work spent on impacts since the last answer.
};

/// State for the next solve.
struct KnownStress final : StressCache {
  std::vector<ConvexSlot> slots;  ///< Per convex.
  std::vector<ConvexPtr> convexes;
  std::vector<std::uint8_t> anchored;
  std::vector<Bond> bonds;
  std::size_t ghosts = 0;
  std::shared_ptr<const StressSystem> system;  ///< Null, and no bonds, in memory of a small piece.
  std::vector<Displacement> displacements;     ///< Under the steady load.
  int iterations = 0;                          ///< Iterations of a solve that has not converged.
  Nodal<double> last_direction;                ///< Last search direction of that solve.
  KnownDeflection deflection;                  ///< Under the last impact.

  /// A piece that has less than kMinKnownShare of the convexes gets displacements alone: its system
  /// will be made anew, and it shall not keep that of a large structure.
  std::vector<StressCachePtr> divide(std::span<const Structure* const> pieces) const override;
  static auto fields(auto& self) {
    return std::tie(self.slots, self.convexes, self.anchored, self.bonds, self.ghosts, self.system,
                    self.displacements, self.iterations, self.last_direction, self.deflection);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
  bool is_of(const Compound& compound) const {
    // For equal convexes bonds and ghosts are never added, so equal numbers imply equal ones.
    return bonds.size() == compound.bonds.size() && ghosts == compound.ghosts.size() &&
           convexes == compound.convexes && anchored == compound.anchored;
  }
};

/// Returns the system of a compound and an estimate of its displacements, from the memory of the
/// compound or of a compound that it was a part of; `memory` may be null. Adds the cost to `work`,
/// in evaluations of springs.
std::shared_ptr<KnownStress> recall(const StressCache* memory, const Compound& compound,
                                    const std::vector<ConvexSlot>& slots,
                                    std::span<const Material> materials, std::uint64_t& work);

}  // namespace sunder::fracture
