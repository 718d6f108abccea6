// Finds the contacts of single bodies.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/broad_phase.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/collide/speculative_contacts.h"

namespace sunder::solver {

/// Finds the manifolds of bodies by the shapes near them, so that the cost follows the number of
/// neighbours; or in the list of all, which is made once that costs less. Both find the same.
class ContactFinder {
 public:
  /// `all` is empty, or the list of the present contacts. `broad_phase` may be null if pairs have
  /// left their fat boxes: the list is used.
  ContactFinder(const Contacts& contacts, const Bodies& bodies, const Shapes& shapes,
                const BroadPhase* broad_phase, ContactsOfBodies& all)
      : contacts_(contacts),
        bodies_(bodies),
        shapes_(shapes),
        broad_phase_(broad_phase),
        all_(all) {}

  /// Returns the manifolds of a dynamic body; valid until the next call.
  std::span<const ManifoldSlot> of(BodySlot body);
  const Contacts& contacts() const { return contacts_; }
  /// Returns the number of manifolds looked at, those to make the list included.
  std::size_t looked_at() const { return looked_at_; }

 private:
  const Contacts& contacts_;
  const Bodies& bodies_;
  const Shapes& shapes_;
  const BroadPhase* broad_phase_;
  ContactsOfBodies& all_;
  std::vector<ManifoldSlot> found_;
  std::size_t queries_ = 0, looked_at_ = 0;
};

}  // namespace sunder::solver
