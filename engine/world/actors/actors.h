// All actors of the running world, by key. Internal to engine/world.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/world/actors/actor.h"

namespace sunder {

/// Actors ascending by key. Their indices change when one is erased.
class Actors {
 public:
  std::uint32_t new_key() { return next_key_++; }
  /// Next key; all keys handed out so far are less.
  std::uint32_t next_key() const { return next_key_; }
  /// Adds an actor, whose key must be the largest.
  void add(Actor actor) {
    keys_.push_back(actor.key);
    all_.push_back(std::move(actor));
  }
  void erase(std::size_t place) {
    keys_.erase(keys_.begin() + static_cast<std::ptrdiff_t>(place));
    all_.erase(all_.begin() + static_cast<std::ptrdiff_t>(place));
  }

  /// Returns the actor with a key; null if there is none.
  const Actor* find(std::uint32_t key) const {
    const auto it = std::ranges::lower_bound(keys_, key);
    return it != keys_.end() && *it == key ? &all_[static_cast<std::size_t>(it - keys_.begin())]
                                           : nullptr;
  }
  Actor* find(std::uint32_t key) { return const_cast<Actor*>(std::as_const(*this).find(key)); }
  std::size_t place_of(const Actor& actor) const {
    return static_cast<std::size_t>(&actor - all_.data());
  }

  std::size_t size() const { return all_.size(); }
  Actor& operator[](std::size_t place) { return all_[place]; }
  const Actor& operator[](std::size_t place) const { return all_[place]; }
  auto begin() { return all_.begin(); }
  auto end() { return all_.end(); }
  auto begin() const { return all_.begin(); }
  auto end() const { return all_.end(); }

  static auto fields(auto& self) { return std::tie(self.all_, self.keys_, self.next_key_); }

 private:
  std::vector<Actor> all_;
  std::vector<std::uint32_t> keys_;  ///< Keys of all_, contiguous for fast search.
  std::uint32_t next_key_ = 0;
};

}  // namespace sunder
