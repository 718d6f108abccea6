// Pairs and manifolds come and go; the colours of manifolds.
#include "solver/rigid/contacts.h"

#include <bit>

namespace sunder::solver {
namespace {

template <class Item>
std::uint32_t take_slot(std::vector<std::uint32_t>& free_slots, std::vector<Item>& items) {
  if (free_slots.empty()) {
    items.emplace_back();
    return static_cast<std::uint32_t>(items.size() - 1);
  }
  const std::uint32_t slot = free_slots.back();
  free_slots.pop_back();
  return slot;
}

}  // namespace

void Contacts::add(const Pair& pair) {
  const std::uint32_t slot = take_slot(free_pairs, pairs);
  pairs[slot] = pair;
  slot_of.insert(pair.key(), slot);
}

void Contacts::remove(std::uint32_t slot) {
  if (pairs[slot].touching()) part(slot);
  slot_of.erase(pairs[slot].key());
  pairs[slot] = Pair();
  free_pairs.push_back(slot);
}

void Contacts::touch(std::uint32_t pair, const Manifold& manifold, const Bodies& bodies) {
  const std::uint32_t slot = take_slot(free_manifolds, manifolds);
  Manifold& m = manifolds[slot];
  m = manifold;
  m.pair = pair;
  m.unseeded = bodies.is_new[m.body_a] || bodies.is_new[m.body_b];
  if (m.unseeded) unseeded.push_back(slot);
  pairs[pair].manifold = slot;
  const bool a = bodies.dynamic(m.body_a), b = bodies.dynamic(m.body_b);
  const std::uint64_t used = (a ? body_colors[m.body_a] : 0) | (b ? body_colors[m.body_b] : 0);
  const int least = std::countr_one(used);
  m.color = least < colors ? static_cast<std::uint8_t>(least) : kMaxColors;
  if (m.color == kMaxColors) return;
  if (a) body_colors[m.body_a] |= std::uint64_t{1} << m.color;
  if (b) body_colors[m.body_b] |= std::uint64_t{1} << m.color;
}

void Contacts::part(std::uint32_t pair) {
  const std::uint32_t slot = pairs[pair].manifold;
  Manifold& m = manifolds[slot];
  if (m.color < kMaxColors) {
    body_colors[m.body_a] &= ~(std::uint64_t{1} << m.color);
    body_colors[m.body_b] &= ~(std::uint64_t{1} << m.color);
  }
  m = Manifold();
  pairs[pair].manifold = kNone;
  free_manifolds.push_back(slot);
}

}  // namespace sunder::solver
