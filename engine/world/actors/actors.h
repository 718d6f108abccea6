// All actors of the running world, by key. Internal to engine/world.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <deque>
#include <utility>
#include <vector>

#include "engine/base/archive.h"
#include "engine/world/actors/actor.h"

namespace sunder {

/// Actors ascending by key. Their indices change when one is erased.
class Actors {
 public:
  std::uint32_t new_key() { return next_key_++; }
  /// Next key; all keys handed out so far are less.
  std::uint32_t next_key() const { return next_key_; }
  /// Adds an actor, whose key must be the largest. Invalidates no reference to another actor.
  void add(Actor actor) {
    keys_.push_back(actor.key);
    if (free_.empty()) {
      slot_.push_back(static_cast<std::uint32_t>(slots_.size()));
      slots_.push_back(std::move(actor));
    } else {
      slot_.push_back(free_.back());
      slots_[free_.back()] = std::move(actor);
      free_.pop_back();
    }
  }
  void erase(std::size_t place) {
    slots_[slot_[place]] = {};
    free_.push_back(slot_[place]);
    keys_.erase(keys_.begin() + static_cast<std::ptrdiff_t>(place));
    slot_.erase(slot_.begin() + static_cast<std::ptrdiff_t>(place));
  }

  /// Returns the actor with a key; null if there is none.
  const Actor* find(std::uint32_t key) const {
    const auto it = std::ranges::lower_bound(keys_, key);
    if (it == keys_.end() || *it != key) return nullptr;
    return &(*this)[static_cast<std::size_t>(it - keys_.begin())];
  }
  Actor* find(std::uint32_t key) { return const_cast<Actor*>(std::as_const(*this).find(key)); }
  std::size_t place_of(const Actor& actor) const {
    return static_cast<std::size_t>(std::ranges::lower_bound(keys_, actor.key) - keys_.begin());
  }

  std::size_t size() const { return keys_.size(); }
  Actor& operator[](std::size_t place) { return slots_[slot_[place]]; }
  const Actor& operator[](std::size_t place) const { return slots_[slot_[place]]; }
  auto begin() { return Iterator<Actors, Actor>{this, 0}; }
  auto end() { return Iterator<Actors, Actor>{this, size()}; }
  auto begin() const { return Iterator<const Actors, const Actor>{this, 0}; }
  auto end() const { return Iterator<const Actors, const Actor>{this, size()}; }

  /// Writes or reads the actors in their order.
  friend void archive(Archive& bytes, Actors& actors) {
    std::uint64_t count = actors.size();
    bytes(count, actors.next_key_);
    if (!bytes.reads()) {
      for (Actor& actor : actors) bytes(actor);
      return;
    }
    actors.slots_.clear(), actors.free_.clear(), actors.slot_.clear(), actors.keys_.clear();
    for (; count > 0; --count) {
      Actor actor;
      bytes(actor);
      const bool ascends = actors.keys_.empty() || actors.keys_.back() < actor.key;
      if (!ascends || actor.key >= actors.next_key_) bytes.refuse_field<Actor>("key");
      actors.add(std::move(actor));
    }
  }

 private:
  template <class Owner, class Value>
  struct Iterator {
    using difference_type = std::ptrdiff_t;
    using value_type = Actor;

    Owner* owner = nullptr;
    std::size_t place = 0;

    Value& operator*() const { return (*owner)[place]; }
    Iterator& operator++() { return ++place, *this; }
    Iterator operator++(int) { return {owner, place++}; }
    bool operator==(const Iterator&) const = default;
  };

  std::deque<Actor> slots_;
  std::vector<std::uint32_t> free_;  ///< Slots without an actor.
  // In the order of keys, contiguous for fast search and removal:
  std::vector<std::uint32_t> keys_;
  std::vector<std::uint32_t> slot_;
  std::uint32_t next_key_ = 0;
};

}  // namespace sunder
