// Structure: a compound with persistent adjacency and a spatial index, so that a break costs in
// proportion to the convexes it touches.
//
// Begin with Structure, then BreakEdit (breaker.h). Convexes are in slots; a slot keeps its number
// until its convex is removed, and is not reused.
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "engine/base/types.h"
#include "engine/geometry/bvh.h"
#include "engine/model/compound.h"

namespace sunder {

struct BreakEdit;

/// Slot of a convex in a structure; Structure::compound() renumbers the remaining convexes.
struct ConvexSlotTag;
using ConvexSlot = Index<ConvexSlotTag>;

/// A bond as seen from one of its convexes.
struct Link {
  ConvexSlot other;
  std::uint32_t face = 0;
  std::uint32_t other_face = 0;
  double area_m2 = 0;
};

/// Convexes, bonds and ghosts of a compound; any number of threads may read, one may change it.
class Structure {
 public:
  Structure() = default;
  /// Makes a structure; unconnected parts of the compound stay together until a break reaches them.
  explicit Structure(const Compound& compound);

  /// Number of slots ever used, empty ones included.
  std::uint32_t slot_count() const { return static_cast<std::uint32_t>(slots_.size()); }
  /// Number of convexes.
  std::uint32_t size() const { return size_; }
  bool empty() const { return size_ == 0; }
  /// Number of bonds.
  std::size_t bond_count() const { return bonds_; }
  /// True if any convex is anchored.
  bool is_anchored() const { return anchored_ > 0; }
  /// True if the slot exists and has a convex.
  bool has(ConvexSlot slot) const {
    return slot.value < slots_.size() && slots_[slot.value].convex;
  }
  /// Returns the convex of a slot; null if it was removed.
  const ConvexPtr& convex(ConvexSlot slot) const { return slots_[slot.value].convex; }
  /// Returns the anchored sides of a convex, as in Compound::anchored.
  std::uint8_t anchored(ConvexSlot slot) const { return slots_[slot.value].anchored; }
  /// Returns the bonds of a convex, unordered.
  std::span<const Link> links(ConvexSlot slot) const { return slots_[slot.value].links; }
  /// Returns the indices of the ghosts of a convex; ascending.
  std::span<const std::uint32_t> ghost_indices(ConvexSlot slot) const {
    return slots_[slot.value].ghosts;
  }
  /// Returns a ghost by its index; its convexes are slots.
  const Ghost& ghost(std::uint32_t number) const { return ghosts_[number]; }
  /// Calls `use(slot, convex)` for each slot that has a convex; ascending.
  template <class Use>
  void for_each(const Use& use) const {
    for (std::uint32_t s = 0; s < slot_count(); ++s) {
      if (slots_[s].convex) use(ConvexSlot(s), *slots_[s].convex);
    }
  }
  /// Returns the slots that have a convex; ascending.
  std::vector<ConvexSlot> slots() const;

  /// Returns the slots whose boxes are within `radius_m` (maybe infinite) of a point, ascending.
  std::vector<ConvexSlot> within(const Vec3& center_R, double radius_m) const;
  /// Applies an edit, in time proportional to the change.
  void apply(const BreakEdit& edit);
  /// Removes the anchors of a convex.
  void loosen(ConvexSlot slot);
  /// Returns the remaining convexes, in the order of their slots.
  Compound compound() const;
  /// Returns the mean memory per convex in bytes, geometry included.
  double bytes_per_convex() const;

  static auto fields(auto& self) {
    return std::tie(self.slots_, self.ghosts_, self.levels_, self.size_, self.anchored_,
                    self.bonds_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  struct Slot {
    ConvexPtr convex;
    std::uint8_t anchored = 0;
    std::vector<Link> links;
    std::vector<std::uint32_t> ghosts;
  };
  /// A tree over some slots. Each tree has less than half the slots of the one before it, so that
  /// slots are seldom sorted again (Bentley and Saxe 1980).
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
  std::vector<Ghost> ghosts_;  ///< Indices are not reused.
  std::vector<Level> levels_;
  std::uint32_t size_ = 0;
  std::uint32_t anchored_ = 0;  ///< Number of anchored convexes.
  std::size_t bonds_ = 0;
};

/// Returns the bounding box of all convexes.
Box bounds(const Structure& structure);
/// Returns a lower bound of the distance from a point to the structure; 0 inside.
double distance_to(const Structure& structure, const Vec3& point_R);
/// Returns the convex that contains a point, or else the nearest one; the lowest slot if several
/// do. The structure must not be empty.
ConvexSlot nearest(const Structure& structure, const Vec3& point_R);

/// Returns the length of a ray inside a structure, from the entry near `point_R` to the first gap;
/// at most about `most_m`, 0 if the ray misses.
double thickness_along(const Structure& structure, const Vec3& point_R, const Vec3& direction_R,
                       double most_m);

/// Returns the length of the first stretch of a ray inside a structure that ends behind `point_R`.
/// The ray begins `back_m` before the point and ends `most_m` behind it; 0 if it misses.
double path_through(const Structure& structure, const Vec3& point_R, const Vec3& direction_R,
                    double back_m, double most_m);

}  // namespace sunder
