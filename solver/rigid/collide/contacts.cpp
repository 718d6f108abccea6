// Adds and removes pairs and manifolds, and colours manifolds.
#include "solver/rigid/collide/contacts.h"

#include <algorithm>
#include <bit>

namespace sunder::solver {
namespace {

template <class Slot, class Item>
Slot put(const Item& item, std::vector<Slot>& free_slots, SlotVector<Slot, Item>& items) {
  if (free_slots.empty()) {
    items.push_back(item);
    return Slot(items.size() - 1);
  }
  const Slot slot = free_slots.back();
  free_slots.pop_back();
  items[slot] = item;
  return slot;
}

/// Reserves memory for `more` items; at least doubles it, or many small steps would copy all items
/// each time.
template <class Item>
void make_room(std::size_t more, std::size_t free_slots, std::vector<Item>& items) {
  if (more <= free_slots || items.size() + more - free_slots <= items.capacity()) return;
  items.reserve(std::max(2 * items.size(), items.size() + more - free_slots));
}

}  // namespace

void Contacts::add(const Pair& pair) {
  slot_of.insert(pair.key(), put(pair, free_pairs, pairs).value);
}

void Contacts::expect_pairs(std::size_t more) {
  make_room(more, free_pairs.size(), pairs);
  slot_of.expect(more);
}

void Contacts::expect_manifolds(std::size_t more) {
  make_room(more, free_manifolds.size(), manifolds);
}

void Contacts::remove(PairSlot slot) {
  if (pairs[slot].touching()) remove_manifold(slot);
  slot_of.erase(pairs[slot].key());
  pairs[slot] = Pair();
  free_pairs.push_back(slot);
}

void Contacts::add_manifold(PairSlot pair, const Manifold& manifold, const Bodies& bodies) {
  const ManifoldSlot slot = put(manifold, free_manifolds, manifolds);
  Manifold& m = manifolds[slot];
  m.pair = pair;
  m.cold = bodies.is_new[m.body_a] || bodies.is_new[m.body_b];
  if (m.cold) cold.push_back(slot);
  pairs[pair].manifold = slot;
  const bool a = bodies.dynamic(m.body_a), b = bodies.dynamic(m.body_b);
  const std::uint64_t used = (a ? body_colors[m.body_a] : 0) | (b ? body_colors[m.body_b] : 0);
  const int least = std::countr_one(used);
  m.color = least < colors ? static_cast<std::uint8_t>(least) : kMaxColors;
  if (m.color == kMaxColors) return;
  if (a) body_colors[m.body_a] |= std::uint64_t{1} << m.color;
  if (b) body_colors[m.body_b] |= std::uint64_t{1} << m.color;
}

void Contacts::remove_manifold(PairSlot pair) {
  const ManifoldSlot slot = pairs[pair].manifold;
  Manifold& m = manifolds[slot];
  if (m.color < kMaxColors) {
    body_colors[m.body_a] &= ~(std::uint64_t{1} << m.color);
    body_colors[m.body_b] &= ~(std::uint64_t{1} << m.color);
  }
  m = Manifold();
  pairs[pair].manifold = {};
  free_manifolds.push_back(slot);
}

}  // namespace sunder::solver
