// The manifolds of a solve in the order of its sweeps, and the numbers of contacts of their bodies.
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
  /// Lists the awake manifolds, and finds impacts among them if `impacts`.
  void collect(const StepContext& step, const Bodies& bodies, const Contacts& contacts,
               bool impacts);

  /// Manifolds by colour, in each colour those near an impact first, then by falling number of
  /// points; those without a colour last.
  std::span<const ManifoldSlot> manifolds() const { return manifolds_; }
  /// Number of colours, with one for split manifolds, which is the last.
  std::uint32_t colors() const { return static_cast<std::uint32_t>(start_.size()) / kKeysAColor; }
  /// Range in manifolds() of those of a colour, near an impact or not.
  std::uint32_t begin(std::uint32_t color, bool near) const { return start_[key(color, near, 4)]; }
  std::uint32_t end(std::uint32_t color, bool near) const {
    return start_[key(color, near, 1) + 1];
  }
  std::uint32_t count(std::uint32_t color, bool near) const {
    return end(color, near) - begin(color, near);
  }
  /// Index of the first manifold without a colour.
  std::uint32_t first_split() const { return start_[start_.size() - 1 - kKeysAColor]; }
  const Impacts& impacts() const { return impacts_; }
  std::uint32_t points() const { return points_; }
  /// True if a manifold has restitution.
  bool bouncy() const { return bouncy_; }
  SpanByBody<std::uint8_t> in_contact() { return in_contact_; }
  /// Number of loaded manifolds by body, at most kPinchedContacts.
  SpanByBody<const std::uint8_t> loaded_contacts() const { return loaded_contacts_; }
  /// Number of deep contacts by body; empty if there are none.
  SpanByBody<const std::uint32_t> deep_contacts() const { return deep_contacts_; }

 private:
  static constexpr std::uint32_t kKeysAColor = 8, kNoColor = ~0u;
  static constexpr std::uint32_t key(std::uint32_t color, bool near, std::uint32_t points) {
    return color * kKeysAColor + (near ? 4 : 8) - points;
  }
  std::uint32_t color_rest(const Bodies& bodies, const Contacts& contacts);

  std::vector<ManifoldSlot> manifolds_;
  /// Slots of `manifolds_` in order of slots, with their keys.
  std::vector<std::pair<ManifoldSlot, std::uint32_t>> found_;
  std::vector<std::uint32_t> start_;  ///< First index into `manifolds_`, by key().
  std::uint32_t points_ = 0;
  bool bouncy_ = false;
  ByBody<std::uint8_t> in_contact_, loaded_contacts_;
  ByBody<std::uint32_t> deep_contacts_;
  Impacts impacts_;
  /// Additional colour by manifold, of uncoloured ones near an impact; else kNoColor.
  SlotVector<ManifoldSlot, std::uint32_t> more_colors_;
};

}  // namespace sunder::solver
