// Sleeping and waking of islands: bodies joined by contacts that carry load.
#pragma once

#include <vector>

#include "solver/rigid/bodies.h"
#include "solver/rigid/contacts.h"

namespace sunder::solver {

class Islands {
 public:
  /// Puts islands to sleep whose every body has been slow for half a second; the answer is the
  /// momentum that took away.
  Vec3 put_to_sleep(const Contacts& contacts, double dt_s, Bodies& bodies);
  /// Wakes islands that something awake touches or will touch within dt_s. True if any woke.
  bool wake_touched(const Contacts& contacts, double dt_s, Bodies& bodies) const;

 private:
  std::uint32_t root(std::uint32_t body);

  std::vector<std::uint32_t> parent_;
  std::vector<float> least_slow_s_;         ///< Of an island, at its root.
  std::vector<std::uint32_t> last_asleep_;  ///< Of an island, while its ring is made.
};

}  // namespace sunder::solver
