// Which bodies collide with which.
#pragma once

#include <cstdint>

namespace sunder {

/// Two bodies collide if the category of each, a set of bits, has a bit in the mask of the other.
/// The ground is in all categories.
struct CollisionFilter {
  std::uint32_t category = 1;
  std::uint32_t mask = 0xffffffff;

  bool operator==(const CollisionFilter&) const = default;
  /// Returns true if bodies of the two filters collide.
  bool collides_with(const CollisionFilter& other) const {
    return (category & other.mask) != 0 && (other.category & mask) != 0;
  }
};

}  // namespace sunder
