// Linear probing with backward-shift deletion.
#include "solver/rigid/body/key_map.h"

#include <algorithm>
#include <bit>

#include "engine/base/check.h"
#include "engine/base/hash.h"

namespace sunder::solver {

std::size_t KeyMap::home(std::uint64_t key) const { return mix(key) & (entries_.size() - 1); }

std::uint32_t KeyMap::find(std::uint64_t key) const {
  if (entries_.empty()) return kAbsent;
  for (std::size_t i = home(key);; i = (i + 1) & (entries_.size() - 1)) {
    if (entries_[i].key == key) return entries_[i].slot;
    if (entries_[i].key == kEmpty) return kAbsent;
  }
}

const char* KeyMap::wrong_field() const {
  if (!entries_.empty() && !std::has_single_bit(entries_.size())) return "entries_";
  const auto is_empty = [](const Entry& entry) { return entry.key == kEmpty; };
  const auto empty = static_cast<std::size_t>(std::ranges::count_if(entries_, is_empty));
  if (entries_.size() - empty != count_ || 2 * count_ > entries_.size()) return "count_";
  for (const Entry& entry : entries_) {
    if (is_empty(entry)) continue;
    std::size_t i = home(entry.key);
    while (!is_empty(entries_[i]) && entries_[i].key != entry.key)
      i = (i + 1) & (entries_.size() - 1);
    if (&entries_[i] != &entry) return "entries_";
  }
  return nullptr;
}

void KeyMap::expect(std::size_t more) {
  std::size_t size = std::max<std::size_t>(1024, entries_.size());
  while (2 * (count_ + more) > size) size *= 2;
  if (size > entries_.size()) grow(size);
}

void KeyMap::insert(std::uint64_t key, std::uint32_t slot) {
  if (2 * (count_ + 1) > entries_.size()) grow(std::max<std::size_t>(1024, 2 * entries_.size()));
  std::size_t i = home(key);
  while (entries_[i].key != kEmpty) i = (i + 1) & (entries_.size() - 1);
  entries_[i] = {key, slot};
  ++count_;
}

void KeyMap::erase(std::uint64_t key) {
  const std::size_t mask = entries_.size() - 1;
  std::size_t hole = home(key);
  while (entries_[hole].key != key) {
    SUNDER_CHECK(entries_[hole].key != kEmpty);
    hole = (hole + 1) & mask;
  }
  // Shift back entries that a search would no longer find across the hole.
  for (std::size_t i = (hole + 1) & mask; entries_[i].key != kEmpty; i = (i + 1) & mask) {
    if (((i - home(entries_[i].key)) & mask) < ((i - hole) & mask)) continue;
    entries_[hole] = entries_[i];
    hole = i;
  }
  entries_[hole] = Entry();
  --count_;
}

void KeyMap::grow(std::size_t size) {
  std::vector<Entry> old(size);
  old.swap(entries_);
  count_ = 0;
  for (const Entry& entry : old)
    if (entry.key != kEmpty) insert(entry.key, entry.slot);
}

}  // namespace sunder::solver
