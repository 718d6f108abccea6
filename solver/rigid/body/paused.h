// Bodies paused for a solve: they do not move in it, and keep their motion.
#pragma once

#include <algorithm>
#include <tuple>
#include <utility>
#include <vector>

#include "solver/rigid/body/bodies.h"

namespace sunder::solver {

class Paused {
 public:
  /// Pauses a body for the solve between the next suspend() and resume().
  void add(BodySlot body) { items_.push_back({body}); }
  /// Must be called before a body is removed: another may take its slot.
  void remove(BodySlot body) {
    std::erase_if(items_, [&](const Item& item) { return item.body == body; });
  }
  /// Stores the motion of paused bodies that are awake, and puts them to sleep.
  void suspend(Bodies& bodies) {
    std::erase_if(items_, [&](const Item& item) { return !bodies.awake(item.body); });
    std::ranges::sort(items_, {}, &Item::body);
    const auto same = [](const Item& x, const Item& y) { return x.body == y.body; };
    items_.erase(std::unique(items_.begin(), items_.end(), same), items_.end());
    for (Item& item : items_) {
      item.velocity = std::exchange(bodies.velocity[item.body], Vec3::Zero());
      item.angular_velocity = std::exchange(bodies.angular_velocity[item.body], Vec3::Zero());
      bodies.motion[item.body] = Motion::kAsleep;
    }
  }
  /// Wakes the paused bodies with their stored motion.
  void resume(Bodies& bodies) {
    for (const Item& item : items_) {
      bodies.motion[item.body] = Motion::kAwake;
      bodies.velocity[item.body] = item.velocity;
      bodies.angular_velocity[item.body] = item.angular_velocity;
      bodies.changed[item.body] = 1;
    }
    items_.clear();
  }

  static auto fields(auto& self) { return std::tie(self.items_); }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field(const Bodies& bodies) const {
    const auto is_wrong = [&](const Item& item) {
      return item.body.value >= bodies.size() || !bodies.dynamic(item.body);
    };
    return std::ranges::any_of(items_, is_wrong) ? "items_" : nullptr;
  }

 private:
  struct Item {
    BodySlot body;
    Vec3 velocity = Vec3::Zero(), angular_velocity = Vec3::Zero();
  };
  std::vector<Item> items_;
};

}  // namespace sunder::solver
