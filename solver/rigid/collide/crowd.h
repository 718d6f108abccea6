// Very many bodies in one place, as when thousands appear at the same point: each overlaps all
// others, and work would grow with their square.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// What the narrow phase found in a chunk of pairs.
struct ContactChanges {
  std::vector<std::pair<PairSlot, Manifold>> touched;
  std::vector<PairSlot> parted, gone;
  std::vector<PairSlot> deep;          ///< Of those that touch.
  std::uint64_t moved = 0, looks = 0;  ///< Pairs of which a body moved; those looked at.

  void clear() {
    touched.clear(), parted.clear(), gone.clear(), deep.clear();
    moved = looks = 0;
  }
};

class Crowd {
 public:
  /// Leaves out contacts of crowded bodies with each other, others in every step, so that none has
  /// many more than 24; bodies with fewer deep contacts keep all of theirs. The same for any number
  /// of threads.
  void thin_out(std::span<ContactChanges> changes, Contacts& contacts, const Bodies& bodies);

 private:
  std::uint64_t times_ = 0;
};

}  // namespace sunder::solver
