// Which manifolds a solve has to do with, in the order of its sweeps, and what they are to their
// bodies.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

class SweepOrder {
 public:
  /// Lists what touches and is awake.
  void collect(const Bodies& bodies, const Contacts& contacts);

  /// By colour, and in each those of most points first; what found no colour last.
  std::span<const ManifoldSlot> manifolds() const { return manifolds_; }
  /// Where those of a colour and a number of points (1 to 4) are in manifolds().
  std::uint32_t begin(std::uint32_t color, std::uint32_t points) const {
    return start_[color * 4 + 4 - points];
  }
  std::uint32_t end(std::uint32_t color, std::uint32_t points) const {
    return start_[color * 4 + 5 - points];
  }
  /// From here on, manifolds have no colour.
  std::uint32_t first_split() const { return begin(kMaxColors, 4); }
  std::uint32_t points() const { return points_; }
  /// Whether any of them has restitution.
  bool bouncy() const { return bouncy_; }
  SpanByBody<std::uint8_t> in_contact() { return in_contact_; }
  /// Loaded manifolds, at most kPinched.
  SpanByBody<const std::uint8_t> loaded_contacts() const { return loaded_contacts_; }
  /// Empty if there are none.
  SpanByBody<const std::uint32_t> deep_contacts() const { return deep_contacts_; }

 private:
  std::vector<ManifoldSlot> manifolds_;
  std::uint32_t start_[kSweepKeys + 1] = {};  ///< In `manifolds_`, by sweep_key().
  std::uint32_t points_ = 0;
  bool bouncy_ = false;
  ByBody<std::uint8_t> in_contact_, loaded_contacts_;
  ByBody<std::uint32_t> deep_contacts_;
};

}  // namespace sunder::solver
