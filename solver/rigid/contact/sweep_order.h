// Which manifolds a solve has to do with, in the order of its sweeps, and what they are to their
// bodies.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/collide/impacts.h"

namespace sunder::solver {

class SweepOrder {
 public:
  /// Lists what touches and is awake; impacts among it, if they are wanted.
  void collect(const StepContext& step, const Bodies& bodies, const Contacts& contacts,
               bool impacts);

  /// By colour, in each those near an impact first, of these those of most points first; what found
  /// no colour last.
  std::span<const ManifoldSlot> manifolds() const { return manifolds_; }
  /// What is split included, which is the last.
  std::uint32_t colors() const { return static_cast<std::uint32_t>(start_.size()) / kKeysAColor; }
  /// Where those of a colour are in manifolds(): near an impact, or far from any.
  std::uint32_t begin(std::uint32_t color, bool near) const { return start_[key(color, near, 4)]; }
  std::uint32_t end(std::uint32_t color, bool near) const {
    return start_[key(color, near, 1) + 1];
  }
  std::uint32_t count(std::uint32_t color, bool near) const {
    return end(color, near) - begin(color, near);
  }
  /// From here on, manifolds have no colour.
  std::uint32_t first_split() const { return start_[start_.size() - 1 - kKeysAColor]; }
  const Impacts& impacts() const { return impacts_; }
  std::uint32_t points() const { return points_; }
  /// Whether any of them has restitution.
  bool bouncy() const { return bouncy_; }
  SpanByBody<std::uint8_t> in_contact() { return in_contact_; }
  /// Loaded manifolds, at most kPinched.
  SpanByBody<const std::uint8_t> loaded_contacts() const { return loaded_contacts_; }
  /// Empty if there are none.
  SpanByBody<const std::uint32_t> deep_contacts() const { return deep_contacts_; }

 private:
  static constexpr std::uint32_t kKeysAColor = 8, kNoColor = ~0u;
  static constexpr std::uint32_t key(std::uint32_t color, bool near, std::uint32_t points) {
    return color * kKeysAColor + (near ? 4 : 8) - points;
  }
  std::uint32_t color_rest(const Bodies& bodies, const Contacts& contacts);

  std::vector<ManifoldSlot> manifolds_;
  std::vector<std::pair<ManifoldSlot, std::uint32_t>> found_;  ///< The same by slot, with keys.
  std::vector<std::uint32_t> start_;                           ///< In `manifolds_`, by key().
  std::uint32_t points_ = 0;
  bool bouncy_ = false;
  ByBody<std::uint8_t> in_contact_, loaded_contacts_;
  ByBody<std::uint32_t> deep_contacts_;
  Impacts impacts_;
  SlotVector<ManifoldSlot, std::uint32_t>
      more_colors_;  ///< By manifold; of those near an impact without one.
};

}  // namespace sunder::solver
