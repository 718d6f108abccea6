#include "solver/rigid/contact/sweep_order.h"

#include <algorithm>

#include "solver/rigid/tolerances.h"

namespace sunder::solver {

void SweepOrder::collect(const Bodies& bodies, const Contacts& contacts) {
  std::fill(std::begin(start_), std::end(start_), 0u);
  in_contact_.assign(bodies.size(), 0);
  loaded_contacts_.assign(bodies.size(), 0);
  points_ = 0;
  bouncy_ = false;
  deep_contacts_.clear();
  auto for_each = [&](const auto& visit) {
    for (const ManifoldSlot i : contacts.manifolds.slots()) {
      const Manifold& m = contacts.manifolds[i];
      if (m.count > 0 && (bodies.awake(m.body_a) || bodies.awake(m.body_b))) visit(i, m);
    }
  };
  for_each([&](ManifoldSlot, const Manifold& m) {
    ++start_[m.sweep_key() + 1];
    in_contact_[m.body_a] = in_contact_[m.body_b] = 1;
    if (m.normal_impulse() > 0)
      for (const BodySlot body : {m.body_a, m.body_b})
        loaded_contacts_[body] = std::min<std::uint8_t>(loaded_contacts_[body] + 1, kPinched);
    points_ += m.count;
    bouncy_ = bouncy_ || m.restitution > 0;
    if (!m.deep) return;
    deep_contacts_.resize(bodies.size());
    ++deep_contacts_[m.body_a], ++deep_contacts_[m.body_b];
  });
  for (std::size_t k = 0; k < kSweepKeys; ++k) start_[k + 1] += start_[k];
  manifolds_.resize(start_[kSweepKeys]);
  std::uint32_t next[kSweepKeys];
  std::copy_n(start_, kSweepKeys, next);
  for_each([&](ManifoldSlot i, const Manifold& m) { manifolds_[next[m.sweep_key()]++] = i; });
}

}  // namespace sunder::solver
