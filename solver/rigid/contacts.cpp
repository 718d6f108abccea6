// The pair set and the colours of manifolds.
#include "solver/rigid/contacts.h"

#include <bit>

#include "engine/base/check.h"
#include "engine/base/hash.h"

namespace sunder::solver {

std::size_t KeySet::home(std::uint64_t key) const { return mix(key) & (slots_.size() - 1); }

bool KeySet::contains(std::uint64_t key) const {
  if (slots_.empty()) return false;
  for (std::size_t i = home(key);; i = (i + 1) & (slots_.size() - 1)) {
    if (slots_[i] == key) return true;
    if (slots_[i] == kEmpty) return false;
  }
}

void KeySet::insert(std::uint64_t key) {
  if (2 * (count_ + 1) > slots_.size()) grow();
  std::size_t i = home(key);
  while (slots_[i] != kEmpty) i = (i + 1) & (slots_.size() - 1);
  slots_[i] = key;
  ++count_;
}

void KeySet::erase(std::uint64_t key) {
  const std::size_t mask = slots_.size() - 1;
  std::size_t hole = home(key);
  while (slots_[hole] != key) {
    SUNDER_CHECK(slots_[hole] != kEmpty);
    hole = (hole + 1) & mask;
  }
  // Shift back whatever would no longer be found across the hole.
  for (std::size_t i = (hole + 1) & mask; slots_[i] != kEmpty; i = (i + 1) & mask) {
    if (((i - home(slots_[i])) & mask) < ((i - hole) & mask)) continue;
    slots_[hole] = slots_[i];
    hole = i;
  }
  slots_[hole] = kEmpty;
  --count_;
}

void KeySet::grow() {
  std::vector<std::uint64_t> old(std::max<std::size_t>(1024, 2 * slots_.size()), kEmpty);
  old.swap(slots_);
  count_ = 0;
  for (const std::uint64_t key : old)
    if (key != kEmpty) insert(key);
}

std::uint32_t Contacts::add(const Pair& pair) {
  if (free_slots.empty()) {
    free_slots.push_back(static_cast<std::uint32_t>(pairs.size()));
    pairs.emplace_back();
    manifolds.emplace_back();
  }
  const std::uint32_t slot = free_slots.back();
  free_slots.pop_back();
  pairs[slot] = pair;
  manifolds[slot] = Manifold();
  keys.insert(pair.key());
  return slot;
}

void Contacts::remove(std::uint32_t slot) {
  keys.erase(pairs[slot].key());
  const Manifold& m = manifolds[slot];
  if (m.color < kMaxColors) {
    body_colors[m.body_a] &= ~(std::uint64_t{1} << m.color);
    body_colors[m.body_b] &= ~(std::uint64_t{1} << m.color);
  }
  pairs[slot] = Pair();
  manifolds[slot].count = 0;
  manifolds[slot].color = kNoColor;
  free_slots.push_back(slot);
}

void Contacts::recolor(std::uint32_t slot, const Bodies& bodies) {
  Manifold& m = manifolds[slot];
  if (m.count > 0 && m.color == kNoColor) {
    const bool a = bodies.dynamic(m.body_a), b = bodies.dynamic(m.body_b);
    const std::uint64_t used = (a ? body_colors[m.body_a] : 0) | (b ? body_colors[m.body_b] : 0);
    m.color = static_cast<std::uint8_t>(std::countr_one(used));
    if (m.color == kMaxColors) return;
    if (a) body_colors[m.body_a] |= std::uint64_t{1} << m.color;
    if (b) body_colors[m.body_b] |= std::uint64_t{1} << m.color;
  } else if (m.count == 0 && m.color != kNoColor) {
    if (m.color < kMaxColors) {
      body_colors[m.body_a] &= ~(std::uint64_t{1} << m.color);
      body_colors[m.body_b] &= ~(std::uint64_t{1} << m.color);
    }
    m.color = kNoColor;
  }
}

}  // namespace sunder::solver
