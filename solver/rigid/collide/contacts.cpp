// Adds and removes pairs and manifolds, and colours manifolds.
#include "solver/rigid/collide/contacts.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "engine/base/state_checks.h"
#include "solver/rigid/collide/broad_phase.h"

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

const char* Manifold::wrong_field() const {
  if (count > points.size()) return "count";
  if ((count == 0) != pair.none()) return "pair";
  if (count == 0) return nullptr;
  if (color > kMaxColors) return "color";
  if (!is_unit(normal_W)) return "normal_W";
  if (!is_unit(normal_body)) return "normal_body";
  const auto is_number = [](float number) { return is_bounded(number, kMostCoefficient); };
  if (!is_number(friction)) return "friction";
  if (!(restitution >= 0 && restitution <= 1)) return "restitution";
  if (!is_number(compliance_scale)) return "compliance_scale";
  if (!is_number(size_m)) return "size_m";
  return is_number(rolling_m) ? nullptr : "rolling_m";
}

const char* Contacts::wrong_field() const {
  if (colors > kMaxColors) return "colors";
  std::size_t present = 0, touching = 0;
  for (const PairSlot slot : pairs.slots()) {
    const Pair& pair = pairs[slot];
    if (!pair.present()) {
      if (pair.touching()) return "pairs";
      continue;
    }
    ++present;
    if (slot_of.find(pair.key()) != slot.value) return "slot_of";
    if (!pair.touching()) continue;
    ++touching;
    if (pair.manifold.value >= manifolds.size() || manifolds[pair.manifold].pair != slot)
      return "pairs";
    if (manifolds[pair.manifold].body_a != pair.body_a ||
        manifolds[pair.manifold].body_b != pair.body_b)
      return "manifolds";
  }
  if (slot_of.size() != present) return "slot_of";
  const auto are_free = [](const auto& free, const auto& items, const auto& is_free) {
    return are_different_below(free, items.size()) &&
           std::ranges::all_of(free, [&](auto slot) { return is_free(items[slot]); });
  };
  if (!are_free(free_pairs, pairs, [](const Pair& pair) { return !pair.present(); }) ||
      free_pairs.size() + present != pairs.size())
    return "free_pairs";
  if (!are_free(free_manifolds, manifolds, [](const Manifold& m) { return m.count == 0; }) ||
      free_manifolds.size() + touching != manifolds.size())
    return "free_manifolds";
  return all_below(cold, manifolds.size()) ? nullptr : "cold";
}

const char* Contacts::wrong_field(const Bodies& bodies, const Shapes& shapes) const {
  const auto is_of = [&](ShapeSlot shape, BodySlot body) {
    return shape.value < shapes.size() && body.value < bodies.size() &&
           shapes[shape].body == body && bodies.motion[body] != Motion::kAbsent;
  };
  for (const Pair& pair : pairs) {
    if (!pair.present()) continue;
    if (!is_of(pair.shape_a, pair.body_a) || !is_of(pair.shape_b, pair.body_b) ||
        pair.body_a == pair.body_b || !is_in_order(pair, shapes) ||
        shapes[pair.shape_b].kind == ShapeDesc::Kind::kHalfSpace)
      return "pairs";
  }
  if (body_colors.size() != bodies.size()) return "body_colors";
  ByBody<std::uint64_t> used(bodies.size());
  for (const Manifold& m : manifolds) {
    if (m.count == 0 || m.color >= kMaxColors) continue;
    for (const BodySlot body : {m.body_a, m.body_b}) {
      const std::uint64_t bit = std::uint64_t{1} << m.color;
      if (!bodies.dynamic(body)) continue;
      // Manifolds of one colour are solved in parallel: they share no body.
      if ((used[body] & bit) != 0) return "manifolds";
      if ((body_colors[body] & bit) == 0) return "body_colors";
      used[body] |= bit;
    }
  }
  return nullptr;
}

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
