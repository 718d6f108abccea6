// Speculative contacts: contacts that close, their closing speed and their effective mass.
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// Finds one speculative contact for each manifold that closes now or within the step; keeps those
/// of unchanged pairs from call to call.
class SpeculativeContacts {
 public:
  /// Returns the speculative contacts in order of pair keys.
  std::vector<SpeculativeContact> find(const Contacts& contacts, const Bodies& bodies,
                                       const Shapes& shapes, const StepContext& step);
  /// Must be called when a pair begins or ceases to touch.
  void invalidate(const Pair& pair) { stale_[pair.body_a] = stale_[pair.body_b] = 1; }
  /// Must be called before a collide clears Bodies::changed.
  void invalidate_changed(const Bodies& bodies);

  static auto fields(auto& self) { return std::tie(self.known_, self.dt_s_, self.stale_); }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field(const Contacts& contacts, const Bodies& bodies,
                          const Shapes& shapes) const;

 private:
  using Keyed = std::pair<std::uint64_t, SpeculativeContact>;

  std::vector<Keyed> known_;    ///< Ascending by pair key.
  double dt_s_ = 0;             ///< Step of the last find().
  ByBody<std::uint8_t> stale_;  ///< 1: the body's contacts are to be found again.
};

/// The manifolds of each dynamic body.
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
  /// First index into `manifolds_`, by body; one more than there are bodies.
  std::vector<std::uint32_t> first_;
  std::vector<ManifoldSlot> manifolds_;
};

/// Returns the bodies in contact with any of `of`, in order of pair keys.
std::vector<TouchingBodies> find_touching(const Contacts& contacts, const Bodies& bodies,
                                          const ContactsOfBodies& contacts_of_bodies,
                                          std::span<const BodyId> of);
/// Returns the contact points of any of `of`, each once, in order of pair keys.
std::vector<Touch> find_touches(const Contacts& contacts, const Bodies& bodies,
                                const Shapes& shapes, const ContactsOfBodies& contacts_of_bodies,
                                std::span<const BodyId> of);

/// Returns the closing speed at two lever arms along the manifold's normal; positive if closing.
double closing_speed(const Manifold& m, const Bodies& bodies, const Vec3f& arm_A,
                     const Vec3f& arm_B);

}  // namespace sunder::solver
