// A compound made ready to be broken again and again: adjacency and a spatial index that persist,
// so that a break costs what it touches and not what the compound has.
//
// Read first: Structure, then BreakEdit (breaker.h). Convexes live in slots; a slot keeps its
// number until its convex is gone, and is not used again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"
#include "engine/geometry/bvh.h"
#include "engine/model/compound.h"

namespace sunder {

struct BreakEdit;

/// A convex of a structure; Structure::compound() numbers those that are left anew.
struct ConvexSlotTag;
using ConvexSlot = Index<ConvexSlotTag>;

/// A contact as seen from one of its convexes.
struct Link {
  ConvexSlot other;
  std::uint32_t face = 0;
  std::uint32_t other_face = 0;
  double area_m2 = 0;
};

/// Convexes, bonds and ghosts by slots and numbers; queried from any thread, changed by one.
class Structure {
 public:
  Structure() = default;
  /// Of a compound that hangs together; parts that do not stay together until a break meets them.
  explicit Structure(const Compound& compound);

  /// Slots ever used: those below have or had a convex.
  std::uint32_t slot_count() const { return static_cast<std::uint32_t>(slots_.size()); }
  /// Convexes that are there.
  std::uint32_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// Contacts that are there.
  std::size_t bond_count() const { return bonds_; }
  /// Whether the world holds any of them.
  bool is_anchored() const { return anchored_ > 0; }
  /// Whether a slot is there and has a convex.
  bool has(ConvexSlot slot) const {
    return slot.value < slots_.size() && slots_[slot.value].convex;
  }
  /// Null where the convex is gone.
  const ConvexPtr& convex(ConvexSlot slot) const { return slots_[slot.value].convex; }
  /// As in Compound.
  std::uint8_t anchored(ConvexSlot slot) const { return slots_[slot.value].anchored; }
  /// The contacts of a convex, in no order.
  std::span<const Link> links(ConvexSlot slot) const { return slots_[slot.value].links; }
  /// The numbers of the ghosts of a convex; ascending.
  std::span<const std::uint32_t> ghosts_of(ConvexSlot slot) const {
    return slots_[slot.value].ghosts;
  }
  /// By number; its convexes are slots.
  const Ghost& ghost(std::uint32_t number) const { return ghosts_[number]; }
  /// Calls `use` with each slot that has a convex, and the convex; ascending.
  template <class Use>
  void for_each(const Use& use) const {
    for (std::uint32_t s = 0; s < slot_count(); ++s) {
      if (slots_[s].convex) use(ConvexSlot(s), *slots_[s].convex);
    }
  }
  /// Slots that have a convex; ascending.
  std::vector<ConvexSlot> slots() const;

  /// Slots whose boxes come within `radius_m` of a point, ascending; all if it is infinite.
  std::vector<ConvexSlot> within(const Vec3& center_R, double radius_m) const;
  /// Carries a break out, in time proportional to what it changes.
  void apply(const BreakEdit& edit);
  /// The world lets go of a convex.
  void loosen(ConvexSlot slot);
  /// What is left, in the order of the slots.
  Compound compound() const;
  /// Bytes of memory for each convex, its geometry included.
  double bytes_per_convex() const;

 private:
  struct Slot {
    ConvexPtr convex;
    std::uint8_t anchored = 0;
    std::vector<Link> links;
    std::vector<std::uint32_t> ghosts;
  };
  /// A tree over some slots. Trees shrink from the first to the last, each less than half of the
  /// one before, so that slots are seldom sorted anew (Bentley and Saxe 1980).
  struct Level {
    Bvh tree;
    std::vector<ConvexSlot> slots;
  };

  void link(const Bond& bond);
  void unlink(const Bond& bond);
  void add_ghost(Ghost ghost);
  void remove_ghost(std::uint32_t number);
  void remove_slot(ConvexSlot slot);
  void add_level(std::vector<ConvexSlot> slots);

  std::vector<Slot> slots_;
  std::vector<Ghost> ghosts_;  ///< Numbers are not used again.
  std::vector<Level> levels_;
  std::uint32_t size_ = 0;
  std::uint32_t anchored_ = 0;  ///< Convexes that the world holds.
  std::size_t bonds_ = 0;
};

/// The least box around its convexes.
Box bounds(const Structure& structure);
/// How far a point is from a structure, at least; 0 inside.
double distance_outside(const Structure& structure, const Vec3& point_R);
/// The convex that has a point, or else is nearest to it, of a structure that is not empty; the
/// first of them.
ConvexSlot nearest(const Structure& structure, const Vec3& point_R);

/// Length of a ray inside a structure, from where it enters near `point_R` to the first gap; at
/// most about `most_m`.
double thickness_along(const Structure& structure, const Vec3& point_R, const Vec3& direction_R,
                       double most_m);

}  // namespace sunder
