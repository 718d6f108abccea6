// All actors of the running world, by key. Internal to engine/world.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

#include "engine/world/actors/actor.h"

namespace sunder {

/// Actors ascending by key. Their places change when one goes.
class Actors {
 public:
  std::uint32_t new_key() { return next_key_++; }
  /// Keys handed out so far are less than this.
  std::uint32_t next_key() const { return next_key_; }
  /// The newest comes last.
  void add(Actor actor) { all_.push_back(std::move(actor)); }
  void erase(std::size_t place) { all_.erase(all_.begin() + static_cast<std::ptrdiff_t>(place)); }

  /// Null if the actor is gone.
  const Actor* find(std::uint32_t key) const {
    const auto it = std::ranges::lower_bound(all_, key, {}, &Actor::key);
    return it != all_.end() && it->key == key ? &*it : nullptr;
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

 private:
  std::vector<Actor> all_;
  std::uint32_t next_key_ = 0;
};

}  // namespace sunder
