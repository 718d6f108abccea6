// Dense clusters: very many overlapping bodies in one place, as when thousands appear at one point.
// Each overlaps all others, and the work would grow with the square of their number.
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// Results of the narrow phase for a chunk of pairs.
struct ContactChanges {
  std::vector<std::pair<PairSlot, Manifold>> touched;
  std::vector<PairSlot> separated, removed;
  std::vector<PairSlot> deep;     ///< Pairs with a deep contact.
  std::vector<PairSlot> closing;  ///< Pairs whose contact may be at a seam: see seams.h.
  /// Number of pairs with a body that moved, and of pairs tested.
  std::uint64_t moved = 0, tested = 0;

  void clear() {
    touched.clear(), separated.clear(), removed.clear(), deep.clear();
    closing.clear();
    moved = tested = 0;
  }
};

class DenseClusters {
 public:
  /// Leaves out contacts between bodies that have more than kMaxDeepContacts deep ones, different
  /// contacts in each step, so that no body has many more than that. Bodies with fewer deep
  /// contacts keep all of theirs. The choice does not depend on the number of threads. Returns true
  /// if contacts were left out.
  bool drop_contacts(std::span<ContactChanges> changes, Contacts& contacts, const Bodies& bodies);

  static auto fields(auto& self) { return std::tie(self.times_); }

 private:
  std::uint64_t times_ = 0;
};

}  // namespace sunder::solver
