#include "solver/rigid/contact/sweep_order.h"

#include <algorithm>
#include <bit>

#include "solver/rigid/tuning.h"

namespace sunder::solver {

void SweepOrder::collect(const StepContext& step, const Bodies& bodies, const Contacts& contacts,
                         bool impacts) {
  in_contact_.assign(bodies.size(), 0);
  loaded_contacts_.assign(bodies.size(), 0);
  points_ = 0;
  bouncy_ = false;
  deep_contacts_.clear();
  impacts_.clear();
  if (impacts) impacts_.find(step, bodies, contacts);
  const std::uint32_t colors = color_rest(bodies, contacts) + 1;
  start_.assign(colors * kKeysAColor + 1, 0);
  const auto key_of = [&](ManifoldSlot i, const Manifold& m) {
    if (m.color < kMaxColors) return key(m.color, impacts_.propagates(m), m.count);
    const std::uint32_t color = more_colors_.empty() ? kNoColor : more_colors_[i];
    return color == kNoColor ? key(colors - 1, false, m.count) : key(color, true, m.count);
  };
  found_.clear();
  for (const ManifoldSlot i : contacts.manifolds.slots()) {
    const Manifold& m = contacts.manifolds[i];
    if (!touches_awake(m, bodies)) continue;
    found_.emplace_back(i, key_of(i, m));
    ++start_[found_.back().second + 1];
    in_contact_[m.body_a] = in_contact_[m.body_b] = 1;
    if (m.normal_impulse() > 0)
      for (const BodySlot body : {m.body_a, m.body_b})
        loaded_contacts_[body] =
            std::min<std::uint8_t>(loaded_contacts_[body] + 1, kPinchedContacts);
    points_ += m.count;
    bouncy_ = bouncy_ || m.restitution > 0;
    if (!m.deep) continue;
    deep_contacts_.resize(bodies.size());
    ++deep_contacts_[m.body_a], ++deep_contacts_[m.body_b];
  }
  for (std::size_t k = 1; k < start_.size(); ++k) start_[k] += start_[k - 1];
  manifolds_.resize(start_.back());
  std::vector<std::uint32_t> next = start_;
  for (const auto& [i, key] : found_) manifolds_[next[key]++] = i;
}

/// Gives the uncoloured manifolds near an impact more colours, since split manifolds take up an
/// impact slowly. Returns the number of colours then.
std::uint32_t SweepOrder::color_rest(const Bodies& bodies, const Contacts& contacts) {
  more_colors_.clear();
  std::uint32_t colors = kMaxColors;
  // split by choice of the option
  if (impacts_.empty() || contacts.colors < kMaxColors) return colors;
  ByBody<std::uint64_t> taken(bodies.size());
  more_colors_.assign(contacts.manifolds.size(), kNoColor);
  for (const ManifoldSlot i : contacts.manifolds.slots()) {
    const Manifold& m = contacts.manifolds[i];
    if (m.count == 0 || m.color < kMaxColors || !impacts_.propagates(m)) continue;
    const bool a = bodies.awake(m.body_a), b = bodies.awake(m.body_b);
    const std::uint64_t used = (a ? taken[m.body_a] : 0) | (b ? taken[m.body_b] : 0);
    if ((!a && !b) || ~used == 0) continue;
    const auto color = static_cast<std::uint32_t>(std::countr_one(used));
    for (const BodySlot body : {m.body_a, m.body_b}) taken[body] |= std::uint64_t{1} << color;
    more_colors_[i] = kMaxColors + color;
    colors = std::max(colors, kMaxColors + color + 1);
  }
  return colors;
}

}  // namespace sunder::solver
