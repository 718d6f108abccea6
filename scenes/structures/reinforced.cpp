// The structure `reinforced`: a box of concrete with bars of steel in it; one compound.
//
// Bars are cut into segments at the joints between blocks. Where the bonds between two blocks are
// broken, the bonds between the segments of the bars alone connect them, and may yield there. A
// segment overlaps no block but its own, so there is no other connection.
#include <algorithm>
#include <cmath>

#include "engine/base/check.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

struct Reinforced {
  Vec3 size_m = Vec3(0.4, 3, 0.4);
  double block_m = 0.4;
  int bars = 2;
  double bar_m = 0.025;
  double cover_m = 0.04;
  MaterialRef material{"concrete", {}};
  MaterialRef steel{"steel", {}};
};

/// Appends the box [min, max], cut along an axis into `count` equal segments. Boxes with equal
/// extents along the axis are cut at exactly equal coordinates.
void add_segments(std::vector<fracture::Part>& parts, const Vec3& min, const Vec3& max, int axis,
                  int count, MaterialIndex material) {
  check_parts(static_cast<double>(parts.size()) + count);
  for (int i = 0; i < count; ++i) {
    const auto level = [&](int k) {
      return k == count ? max[axis] : min[axis] + (max[axis] - min[axis]) * k / count;
    };
    Vec3 low = min, high = max;
    low[axis] = level(i), high[axis] = level(i + 1);
    parts.push_back({make_box(low, high), material});
  }
}

/// Builds the box. Bars come first, so that their overlap with concrete has their density.
std::vector<Piece> build_reinforced(const Reinforced& box) {
  int along = 0;
  box.size_m.maxCoeff(&along);
  const int u = (along + 1) % 3, v = (along + 2) % 3;
  const double inset_m = box.cover_m + box.bar_m / 2;
  const double least_m = 2 * inset_m + (box.bars > 1 ? (box.bars - 1) * box.bar_m : 0);
  if (box.bars > 0 && std::min(box.size_m[u], box.size_m[v]) <= least_m)
    throw InputError("reinforced: bars of bar_m with cover_m around them do not fit into size_m");
  const Vec3 min = -Vec3(box.size_m.x() / 2, 0, box.size_m.z() / 2), max = min + box.size_m;
  const auto middle = [&](int axis, int i) {
    const double share = box.bars > 1 ? static_cast<double>(i) / (box.bars - 1) : 0.5;
    return min[axis] + inset_m + share * (box.size_m[axis] - 2 * inset_m);
  };
  const int count =
      std::max(1, static_cast<int>(std::ceil(box.size_m[along] / box.block_m - 1e-9)));
  const auto is_outer = [&](int i) { return i == 0 || i == box.bars - 1; };
  Piece piece;
  for (int i = 0; i < box.bars; ++i) {
    for (int j = 0; j < box.bars; ++j) {
      if (!is_outer(i) && !is_outer(j)) continue;
      Vec3 low = min, high = max;
      low[u] = middle(u, i) - box.bar_m / 2, high[u] = low[u] + box.bar_m;
      low[v] = middle(v, j) - box.bar_m / 2, high[v] = low[v] + box.bar_m;
      add_segments(piece.parts, low, high, along, count, box.steel.index);
    }
  }
  add_segments(piece.parts, min, max, along, count, box.material.index);
  return {piece};
}

}  // namespace

StructureType reinforced_structure() {
  const Range length{0.001, 1000};
  return make_structure<Reinforced, build_reinforced>(
      "reinforced", "A box with bars in it, along its longest edge.",
      {key<&Reinforced::size_m>("size_m", "m", length, "Edge lengths."),
       key<&Reinforced::block_m>(
           "block_m", "m", Range{0.05, 1000},
           "Most length of its blocks, which go through its section, and of a bar's."),
       key<&Reinforced::bars>("bars", "", Range{0, 20},
                              "Along each side of its section, from corner to corner."),
       key<&Reinforced::bar_m>("bar_m", "m", Range{0.001, 10}, "Edge of a bar, which is square."),
       key<&Reinforced::cover_m>("cover_m", "m", Range{0, 100}, "From a bar to the surface."),
       key<&Reinforced::material>("material", "What it is made of."),
       key<&Reinforced::steel>("steel", "What the bars are made of; yield_Pa makes them bend.")});
}

}  // namespace sunder::scenes
