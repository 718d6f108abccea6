// A compound made ready to be broken again and again: adjacency and a spatial index that persist,
// so that a break costs what it touches and not what the compound has.
//
// Read first: Structure, then BreakEdit. Convexes live in slots; a slot keeps its number until its
// convex is gone, and is not used again.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/geometry/bvh.h"
#include "engine/world/breaker.h"

namespace sunder::fracture {

/// Where a fracture reaches: convexes outside stay as they are.
struct ImpactSphere {
  Vec3 center_R = Vec3::Zero();
  double radius_m = 1;  ///< Infinity: everything breaks.

  bool is_endless() const;
  bool touches(const Convex& convex) const;
};

/// A contact as seen from one of its convexes.
struct Link {
  std::uint32_t other = 0;  ///< Slot.
  std::uint32_t face = 0;
  std::uint32_t other_face = 0;
  double area_m2 = 0;
};

/// What a break does to a structure, and what comes off it.
struct BreakEdit {
  std::vector<std::uint32_t> removed;  ///< Slots whose convexes were cut or came off; ascending.
  /// Convexes that take new slots, in this order from the structure's slot_count() on.
  std::vector<ConvexPtr> added;
  std::vector<std::uint8_t> added_anchors;
  std::vector<Bond> bonds;    ///< Contacts of added convexes: a and b are slots.
  std::vector<Ghost> ghosts;  ///< Of added convexes, and of them with others, by slots.
  /// The pieces that came off, and the figures of the whole break. Exposed faces name piece p as
  /// p + 1; 0 is the structure, and their convex a slot of it.
  BreakPlan loose;
  bool changed = false;  ///< Something came off; otherwise nothing else here is set.
};

class Structure {
 public:
  /// Of a compound that hangs together (split_islands() sees to that).
  explicit Structure(const Compound& compound);

  std::uint32_t slot_count() const { return static_cast<std::uint32_t>(slots_.size()); }
  /// Convexes that are there.
  std::uint32_t size() const { return size_; }
  /// Null where the convex is gone.
  const ConvexPtr& convex(std::uint32_t slot) const { return slots_[slot].convex; }
  std::uint8_t anchored(std::uint32_t slot) const { return slots_[slot].anchored; }
  std::span<const Link> links(std::uint32_t slot) const { return slots_[slot].links; }
  /// The numbers of the ghosts of a convex; ascending.
  std::span<const std::uint32_t> ghosts_of(std::uint32_t slot) const { return slots_[slot].ghosts; }
  /// By number; its convexes are slots.
  const Ghost& ghost(std::uint32_t number) const { return ghosts_[number]; }

  /// Slots that the sphere touches, ascending.
  std::vector<std::uint32_t> touched(const ImpactSphere& sphere) const;
  /// Carries a break out, in time proportional to what it changes.
  void apply(const BreakEdit& edit);
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
    std::vector<std::uint32_t> slots;
  };

  void link(const Bond& bond);
  void add_ghost(Ghost ghost);
  void remove_ghost(std::uint32_t number);
  void add_level(std::vector<std::uint32_t> slots);

  std::vector<Slot> slots_;
  std::vector<Ghost> ghosts_;  ///< Numbers are not used again.
  std::vector<Level> levels_;
  std::uint32_t size_ = 0;
};

}  // namespace sunder::fracture
