// Which contacts close, how fast, and with how much mass behind them.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// One approach for each manifold that closes, or would within the step; kept from one time to the
/// next where nothing has changed.
class Approaches {
 public:
  /// In order of pair keys.
  std::vector<Approach> find(const Contacts& contacts, const Bodies& bodies, const Shapes& shapes,
                             const StepContext& step);
  /// A pair comes to touch, or parts.
  void forget(const Pair& pair) { forgotten_[pair.body_a] = forgotten_[pair.body_b] = 1; }
  /// What a collide is about to look at anew.
  void forget_changed(const Bodies& bodies);

 private:
  using Keyed = std::pair<std::uint64_t, Approach>;

  std::vector<Keyed> known_;        ///< Ascending by pair key.
  double dt_s_ = 0;                 ///< Of the step then.
  ByBody<std::uint8_t> forgotten_;  ///< Since the last time.
};

/// The manifolds of each body that can move.
class ContactsOfBodies {
 public:
  ContactsOfBodies() = default;
  ContactsOfBodies(const Contacts& contacts, const Bodies& bodies);

  bool empty() const { return first_.empty(); }
  void clear() { first_.clear(); }
  std::span<const ManifoldSlot> of(BodySlot body) const {
    const std::uint32_t first = first_[body.value];
    return std::span(manifolds_).subspan(first, first_[body.value + 1] - first);
  }

 private:
  std::vector<std::uint32_t> first_;  ///< In `manifolds_`, by body; one more than there are.
  std::vector<ManifoldSlot> manifolds_;
};

/// The bodies of the contacts of any of `bodies`; in order of pair keys.
std::vector<TouchingBodies> find_touching(const Contacts& contacts, const Bodies& bodies,
                                          const ContactsOfBodies& contacts_of_bodies,
                                          std::span<const BodyId> of);
/// The contact points of any of `bodies`, each once; in order of pair keys.
std::vector<Touch> find_touches(const Contacts& contacts, const Bodies& bodies,
                                const Shapes& shapes, const ContactsOfBodies& contacts_of_bodies,
                                std::span<const BodyId> of);

/// Approach speed at an arm, along the manifold's normal; > 0 when closing.
double closing_speed(const Manifold& m, const Bodies& bodies, const Vec3f& arm_A,
                     const Vec3f& arm_B);

}  // namespace sunder::solver
