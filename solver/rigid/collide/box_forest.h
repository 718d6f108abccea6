// Boxes of static shapes: a few trees whose sizes grow by a factor of eight, so that adding costs
// little more than building a tree of the added items, and removing costs a path to a root (Bentley
// and Saxe 1980, "Decomposable Searching Problems").
#pragma once

#include <cstdint>
#include <span>
#include <tuple>
#include <vector>

#include "solver/rigid/body/slots.h"
#include "solver/rigid/collide/box_tree.h"

namespace sunder::solver {

class BoxForest {
 public:
  /// Adds items that are not in the forest; `boxes` must have those of all items.
  void add(const ByShape<FloatBox>& boxes, std::span<const ShapeSlot> items);
  /// Removes an item that is in the forest.
  void remove(ShapeSlot item);
  bool contains(ShapeSlot item) const;
  /// Returns the number of items.
  std::size_t size() const;
  /// Calls hit(item) for each item whose box overlaps `query`.
  template <class Hit>
  void overlaps(const FloatBox& query, const Hit& hit) const {
    for (const BoxTree& tree : trees_) tree.overlaps(query, hit);
  }
  /// As BoxTree::on_ray().
  template <class Hit>
  void on_ray(const Ray& ray, const Hit& hit) const {
    for (const BoxTree& tree : trees_) tree.on_ray(ray, hit);
  }

  static auto fields(auto& self) { return std::tie(self.trees_, self.place_); }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  struct Place {
    std::uint32_t tree, leaf;
  };
  std::vector<BoxTree> trees_;  ///< Large ones first.
  ByShape<Place> place_;
};

}  // namespace sunder::solver
