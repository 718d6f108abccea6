#include "fracture/fragments.h"

#include <algorithm>
#include <tuple>

#include "engine/base/parallel.h"
#include "fracture/intersect.h"
#include "fracture/weld.h"

namespace sunder::fracture {
namespace {

/// The sides of the parent by which it is held that a part of it still reaches.
std::uint8_t inherited_anchors(std::uint8_t anchored, const Box& parent, const Box& part) {
  if (anchored == 0) return 0;
  std::uint8_t kept = 0;
  const Vec3 near = 1e-9 * parent.extent();
  for (int axis = 0; axis < 3; ++axis) {
    const auto low = anchor_side(axis, false), high = anchor_side(axis, true);
    if (part.min[axis] <= parent.min[axis] + near[axis]) kept |= low;
    if (part.max[axis] >= parent.max[axis] - near[axis]) kept |= high;
  }
  return kept & anchored;
}

/// The group of a part: its cell's colour where the impact reaches it.
std::uint32_t group_of(const CellPart& part, const AlignedPattern& pattern,
                       const ImpactSphere& sphere) {
  if (part.cell == CellPart::kFarCell) return Fragment::kRest;
  const Cell& cell = pattern.pattern->cells[pattern.cells[part.cell].index];
  if (sphere.is_endless()) return cell.color;
  return !cell.outer && sphere.touches(*part.convex) ? cell.color : Fragment::kRest;
}

void weld_cells(const AlignedPattern& pattern, Fragments& fragments) {
  std::vector<Fragment>& all = fragments.all;
  std::stable_sort(all.begin(), all.end(),
                   [](const Fragment& a, const Fragment& b) { return a.cell < b.cell; });
  std::vector<Fragment> result;
  std::vector<ConvexPtr> parts;
  for (std::size_t i = 0, end = 0; i < all.size(); i = end) {
    parts.clear();
    std::uint8_t anchored = 0;
    bool together = all[i].cell != CellPart::kFarCell;
    for (end = i; end < all.size() && all[end].cell == all[i].cell; ++end) {
      parts.push_back(all[end].convex);
      anchored |= all[end].anchored;
      together &= all[end].group == all[i].group;
    }
    const ConvexPtr whole =
        together && parts.size() > 1 ? weld(pattern, pattern.cells[all[i].cell], parts) : nullptr;
    if (whole) {
      result.push_back({whole, all[i].source, all[i].cell, all[i].group, anchored});
      ++fragments.welded;
    } else {
      result.insert(result.end(), all.begin() + static_cast<std::ptrdiff_t>(i),
                    all.begin() + static_cast<std::ptrdiff_t>(end));
    }
  }
  std::stable_sort(result.begin(), result.end(), [](const Fragment& a, const Fragment& b) {
    return std::tie(a.source, a.cell) < std::tie(b.source, b.cell);
  });
  all = std::move(result);
}

}  // namespace

Fragments make_fragments(const Structure& structure, std::vector<std::uint32_t>& touched,
                         const AlignedPattern& pattern, const ImpactSphere& sphere) {
  std::vector<Intersection> cut(touched.size());
  for_chunks(touched.size(), 4, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      cut[i] = intersect(pattern, structure.convex(touched[i]));
    }
  });
  Fragments fragments;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const std::uint32_t source = touched[i];
    const Convex& parent = *structure.convex(source);
    fragments.failed += cut[i].failed ? 1 : 0;
    const CellPart& first = cut[i].parts[0];
    if (first.convex.get() == &parent && group_of(first, pattern, sphere) == Fragment::kRest) {
      continue;
    }
    touched[kept++] = source;
    fragments.debris_volume_m3 += cut[i].debris_volume_m3;
    for (const CellPart& part : cut[i].parts) {
      fragments.all.push_back(
          {part.convex, source, part.cell, group_of(part, pattern, sphere),
           inherited_anchors(structure.anchored(source), parent.box, part.convex->box)});
    }
  }
  touched.resize(kept);
  weld_cells(pattern, fragments);
  return fragments;
}

}  // namespace sunder::fracture
