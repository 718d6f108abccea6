// Broad phase: finds pairs of near shapes. Moving shapes are in a tree, static ones in a forest.
// Each shape has a fat box, and only a shape that leaves its fat box is tested for new neighbours.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/box_forest.h"
#include "solver/rigid/collide/box_tree.h"
#include "solver/rigid/collide/contacts.h"

namespace sunder::solver {

/// Two shapes that came near each other; the order of a and b is that of Pair.
struct FoundPair {
  ShapeSlot shape_a, shape_b;

  std::uint64_t key() const { return pair_key(shape_a, shape_b); }
};

class BroadPhase {
 public:
  /// Adds shapes; the next update() finds their pairs.
  void add(std::span<const ShapeSlot> added, const Shapes& shapes, const Bodies& bodies);
  /// Returns the slots of all pairs with one of these shapes, each once, ascending. Must be called
  /// before the shapes are removed.
  std::vector<PairSlot> pairs_with(std::span<const ShapeSlot> of, const Shapes& shapes,
                                   const Contacts& contacts) const;
  /// Removes shapes.
  void remove(std::span<const ShapeSlot> removed);
  /// Updates the boxes of changed shapes, swept over the step, and adds pairs that came near. The
  /// order of pairs does not depend on the number of threads.
  void update(const StepContext& step, const Shapes& shapes, const Bodies& bodies,
              Contacts& contacts);
  /// Number of shapes that the last update() tested for neighbours.
  std::size_t moved() const { return moved_list_.size(); }
  /// Returns true if the last update() left out pairs of dense clusters.
  bool has_skipped() const {
    return std::ranges::any_of(moved_list_,
                               [&](ShapeSlot shape) { return has_skipped_[shape] != 0; });
  }
  /// True if the pair's shapes may touch within the step.
  bool may_touch(const Pair& pair) const;
  /// Returns false if the fat boxes no longer overlap; such a pair must be removed, as pairs_with()
  /// cannot find it.
  bool is_near(const Pair& pair) const;
  /// True if the fat boxes ceased to overlap in this update.
  bool left_fat_box(const Pair& pair) const {
    return (moved_[pair.shape_a] || moved_[pair.shape_b]) && !is_near(pair);
  }
  /// Returns the shapes that queries cannot find by the trees: those that have left their fat box,
  /// and those added since the last update; ascending.
  std::vector<ShapeSlot> strays(const Shapes& shapes, const Bodies& bodies) const;
  /// Calls hit(shape) for each shape that `ray` may meet, strays and half-spaces always; for some
  /// more than once. hit() may shorten the ray.
  template <class Hit>
  void on_ray(const Ray& ray, std::span<const ShapeSlot> strays, const Hit& hit) const {
    hit_without_trees(strays, hit);
    mover_tree_.on_ray(ray, if_present(hit));
    static_forest_.on_ray(ray, if_present(hit));
  }
  /// Likewise for each shape whose box may overlap `box`.
  template <class Hit>
  void in_box(const FloatBox& box, std::span<const ShapeSlot> strays, const Hit& hit) const {
    hit_without_trees(strays, hit);
    mover_tree_.overlaps(box, if_present(hit));
    static_forest_.overlaps(box, if_present(hit));
  }
  /// Returns the fat boxes of all shapes that have one, in order of slots.
  std::vector<ShapeBox> boxes(const Shapes& shapes, const Bodies& bodies) const;

  static auto fields(auto& self) {
    return std::tie(self.role_, self.swept_, self.fat_, self.moved_, self.has_skipped_,
                    self.movers_, self.new_statics_, self.moved_list_, self.half_spaces_,
                    self.half_space_of_, self.mover_tree_, self.static_forest_,
                    self.movers_changed_, self.test_all_, self.refits_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
  /// As wrong_field(), of the shapes that are in it.
  const char* wrong_field(const Shapes& shapes) const;

 private:
  enum class Role : std::uint8_t { kAbsent, kMover, kStatic, kHalfSpace };
  struct HalfSpace {
    ShapeSlot shape;
    Vec3f normal_W;
    float d;
  };
  template <class Hit>
  void hit_without_trees(std::span<const ShapeSlot> strays, const Hit& hit) const {
    for (const HalfSpace& plane : half_spaces_) hit(plane.shape);
    for (const ShapeSlot s : strays) hit(s);
  }
  /// Returns a function that calls hit(shape), unless the shape has been removed from its tree.
  template <class Hit>
  auto if_present(const Hit& hit) const {
    return [this, &hit](ShapeSlot s) {
      if (!s.none() && role_[s] != Role::kAbsent) hit(s);
    };
  }
  void add_half_space(ShapeSlot shape, const Shapes& shapes, const Bodies& bodies);
  void remove_half_space(ShapeSlot shape);
  void update_boxes(const StepContext& step, const Shapes& shapes, const Bodies& bodies);
  void update_trees();
  void find_pairs(ShapeSlot shape, const Shapes& shapes, const Bodies& bodies,
                  const Contacts& contacts, std::vector<FoundPair>& found);
  void drop_pairs(ShapeSlot shape, std::size_t neighbours, const Shapes& shapes,
                  const Bodies& bodies, std::vector<FoundPair>& found, std::size_t first);
  bool overlaps(const Pair& pair, const ByShape<FloatBox>& boxes) const;

  ByShape<Role> role_;
  ByShape<FloatBox> swept_, fat_;
  ByShape<std::uint8_t> moved_;        ///< 1: left its fat box in this update.
  ByShape<std::uint8_t> has_skipped_;  ///< 1: some neighbours were skipped.
  std::vector<ShapeSlot> movers_, new_statics_, moved_list_;
  std::vector<std::vector<FoundPair>> found_;  ///< By chunk of moved shapes.
  std::vector<HalfSpace> half_spaces_;
  ByShape<std::int32_t> half_space_of_;  ///< Index in `half_spaces_`; −1: not a half-space.
  BoxTree mover_tree_;
  BoxForest static_forest_;
  bool movers_changed_ = true;
  /// A half-space was added: all movers are tested, since it has no box.
  bool test_all_ = false;
  int refits_ = 0;
};

/// Returns the pair of two shapes, in the order in which they are tested.
Pair pair_of(ShapeSlot s, ShapeSlot t, const Shapes& shapes);
/// Returns true if the shapes of a pair are in the order in which they are tested.
bool is_in_order(const Pair& pair, const Shapes& shapes);

}  // namespace sunder::solver
