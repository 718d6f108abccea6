// Actions to come, in order of their times: those of the scene's script, and those that a program
// adds while the world runs. Internal to engine/world.
#pragma once

#include <algorithm>
#include <iterator>
#include <span>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/world/actors/clock.h"

namespace sunder {

/// Actions of one kind; `Act` has a member time_s.
template <class Act>
class Agenda {
 public:
  /// Adds an action after those of the same time.
  void add(Act act) {
    const auto place = std::ranges::upper_bound(acts_, act.time_s, {}, &Act::time_s);
    acts_.insert(place, std::move(act));
  }
  /// Removes the actions that are due in the current step, and returns them.
  std::vector<Act> take_due(const Clock& clock) {
    const auto later =
        std::ranges::find_if_not(acts_, [&](const Act& act) { return clock.is_due(act.time_s); });
    std::vector<Act> due(std::make_move_iterator(acts_.begin()), std::make_move_iterator(later));
    acts_.erase(acts_.begin(), later);
    return due;
  }
  std::span<const Act> to_come() const { return acts_; }

  static auto fields(auto& self) { return std::tie(self.acts_); }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const {
    return std::ranges::is_sorted(acts_, {}, &Act::time_s) ? nullptr : "acts_";
  }

 private:
  std::vector<Act> acts_;
};

}  // namespace sunder
