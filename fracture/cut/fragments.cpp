#include "fracture/cut/fragments.h"

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <tuple>

#include "engine/base/parallel.h"
#include "engine/geometry/polygon_mesh.h"
#include "fracture/cut/ghosts.h"
#include "fracture/cut/intersect.h"
#include "fracture/cut/weld.h"

namespace sunder::fracture {
namespace {

/// Returns the box of a convex's visual mesh, which its polyhedron may exceed, if it has one.
Box solid_box(const Convex& convex) {
  return convex.is_internal() ? convex.box : bounds(*convex.visual);
}

/// Returns the group of a part: its cell's colour if the sphere touches it, else the rest.
std::uint32_t group_of(const CellPart& part, const AlignedPattern& pattern,
                       const ImpactSphere& sphere) {
  if (part.cell == CellPart::kFarCell) return Fragment::kRest;
  const Cell& cell = pattern.pattern->cells[pattern.cells[part.cell].index];
  if (sphere.is_infinite()) return cell.color;
  return !cell.outer && sphere.touches(*part.convex) ? cell.color : Fragment::kRest;
}

/// Welds the fragments of each cell that they fill.
class Welder {
 public:
  Welder(const AlignedPattern& pattern, std::uint32_t slot_count, Fragments& fragments)
      : pattern_(pattern), slot_count_(slot_count), fragments_(fragments) {
    welded_into_.resize(fragments.all.size());
    std::iota(welded_into_.begin(), welded_into_.end(), 0u);
    uncut_neighbour_.assign(fragments.all.size(), kNone);
    for (std::uint32_t g = 0; g < fragments.ghosts.size(); ++g) {
      const Ghost& ghost = fragments.ghosts[g];
      record_uncut_overlaps(ghost);
      const auto is_here = [&](std::uint32_t node) {
        return node >= slot_count && cell(node - slot_count) == cell_of(ghost);
      };
      if (ghost.of.size() < 2 || !std::all_of(ghost.of.begin(), ghost.of.end(), is_here)) continue;
      ghosts_of_cells_.emplace_back(cell_of(ghost), g);
    }
    std::sort(ghosts_of_cells_.begin(), ghosts_of_cells_.end());
  }

  void run() {
    std::vector<std::uint32_t> order = welded_into_;
    std::stable_sort(order.begin(), order.end(),
                     [&](std::uint32_t a, std::uint32_t b) { return cell(a) < cell(b); });
    for (std::size_t i = 0, end = 0; i < order.size(); i = end) {
      while (end < order.size() && cell(order[end]) == cell(order[i])) ++end;
      if (end - i > 1 && cell(order[i]) != CellPart::kFarCell) {
        weld_cell(std::span(order).subspan(i, end - i));
      }
    }
    if (fragments_.welded > 0) remove_welded();
  }

 private:
  static constexpr std::uint32_t kNone = 0xffffffff, kSeveral = 0xfffffffe;

  static void add_neighbour(std::uint32_t neighbour, std::uint32_t& all) {
    if (neighbour != kNone && neighbour != all) all = all == kNone ? neighbour : kSeveral;
  }
  void record_uncut_overlaps(const Ghost& ghost) {
    for (const std::uint32_t node : ghost.of) {
      if (node < slot_count_) continue;
      for (const std::uint32_t other : ghost.of)
        if (other < slot_count_) add_neighbour(other, uncut_neighbour_[node - slot_count_]);
    }
  }

  std::uint32_t cell(std::uint32_t fragment) const { return fragments_.all[fragment].cell; }
  std::uint32_t cell_of(const Ghost& ghost) const {
    return ghost.of.back() < slot_count_ ? CellPart::kFarCell : cell(ghost.of.back() - slot_count_);
  }

  /// Welds the fragments of a cell, unless that would connect several uncut convexes: all of one
  /// material, or else two and two. The order of convexes has no effect on the result.
  void weld_cell(std::span<std::uint32_t> members) {
    std::uint32_t uncut_neighbour = kNone;
    for (const std::uint32_t i : members) add_neighbour(uncut_neighbour_[i], uncut_neighbour);
    if (uncut_neighbour == kSeveral) return;
    std::ranges::sort(members, {}, [&](std::uint32_t i) {
      const Convex& convex = *fragments_.all[i].convex;
      const Vec3& at = convex.solid.centroid;
      return std::tuple(convex.material, at.x(), at.y(), at.z(), i);
    });
    const auto material = [&](std::uint32_t i) { return fragments_.all[i].convex->material; };
    for (auto i = members.begin(), end = i; i != members.end(); i = end) {
      end = std::find_if(i, members.end(), [&](auto m) { return material(m) != material(*i); });
      std::vector<std::uint32_t> alike(i, end);
      if (alike.size() < 2 || weld_all(alike) || alike.size() == 2) continue;
      for (std::size_t a = 0; a + 1 < alike.size(); ++a) {
        for (std::size_t b = a + 1; b < alike.size();) {
          const std::array both{alike[a], alike[b]};
          if (!weld_all(both)) {
            ++b;
            continue;
          }
          alike[a] = std::ranges::min(both);
          alike.erase(alike.begin() + static_cast<std::ptrdiff_t>(b));
          b = a + 1;  // those that did not fit before may fit now
        }
      }
    }
  }

  /// Returns the fragment that one was welded into, or itself.
  std::uint32_t whole_of(std::uint32_t fragment) const {
    while (welded_into_[fragment] != fragment) fragment = welded_into_[fragment];
    return fragment;
  }

  /// Welds fragments of a cell into that of the lowest index; returns false if their union is not
  /// convex.
  bool weld_all(std::span<const std::uint32_t> members) {
    const std::uint32_t lowest = std::ranges::min(members);
    Fragment& first = fragments_.all[lowest];
    std::vector<ConvexPtr> parts;
    std::uint8_t anchored = 0;
    for (const std::uint32_t i : members) {
      const Fragment& fragment = fragments_.all[i];
      if (fragment.group != first.group) return false;
      parts.push_back(fragment.convex);
      anchored |= fragment.anchored;
    }
    const auto is_member = [&](std::uint32_t node) {
      return std::ranges::count(members, whole_of(node - slot_count_)) > 0;
    };
    std::vector<Ghost*> used;
    std::vector<Ghost> ghosts;
    for (auto at = std::ranges::lower_bound(ghosts_of_cells_, std::pair(first.cell, 0u));
         at != ghosts_of_cells_.end() && at->first == first.cell; ++at) {
      Ghost& ghost = fragments_.ghosts[at->second];
      if (!ghost.convex || !std::ranges::all_of(ghost.of, is_member)) continue;
      used.push_back(&ghost);
      ghosts.push_back(ghost);
    }
    const ConvexPtr whole = weld(pattern_, pattern_.cells[first.cell], parts, ghosts);
    if (!whole) return false;
    for (Ghost* ghost : used) ghost->convex = nullptr;
    for (const std::uint32_t i : members) welded_into_[i] = lowest;
    first.convex = whole;
    first.anchored = anchored;
    ++fragments_.welded;
    return true;
  }

  /// Removes welded fragments and renumbers the others.
  void remove_welded() {
    std::vector<std::uint32_t> new_of_old(welded_into_.size());
    std::uint32_t kept = 0;
    for (std::uint32_t i = 0; i < welded_into_.size(); ++i) {
      new_of_old[i] = welded_into_[i] == i ? kept : new_of_old[welded_into_[i]];
      if (welded_into_[i] == i) fragments_.all[kept++] = std::move(fragments_.all[i]);
    }
    fragments_.all.resize(kept);
    std::erase_if(fragments_.ghosts, [](const Ghost& ghost) { return !ghost.convex; });
    for (Ghost& ghost : fragments_.ghosts) {
      for (std::uint32_t& node : ghost.of) {
        if (node >= slot_count_) node = slot_count_ + new_of_old[node - slot_count_];
      }
      std::sort(ghost.of.begin(), ghost.of.end());
      ghost.of.erase(std::unique(ghost.of.begin(), ghost.of.end()), ghost.of.end());
    }
  }

  const AlignedPattern& pattern_;
  std::uint32_t slot_count_;
  Fragments& fragments_;
  /// Per fragment: the fragment that it was welded into, or itself.
  std::vector<std::uint32_t> welded_into_;
  /// Per fragment: the slot of the uncut convex that it overlaps.
  std::vector<std::uint32_t> uncut_neighbour_;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> ghosts_of_cells_;  ///< Cell, ghost.
};

}  // namespace

Fragments make_fragments(const Structure& structure, std::vector<ConvexSlot>& touched,
                         const AlignedPattern& pattern, const ImpactSphere& sphere,
                         const Fit& fit) {
  std::vector<Intersection> cut(touched.size());
  for_chunks(touched.size(), 4, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      cut[i] = intersect(pattern, structure.convex(touched[i]), fit);
    }
  });
  Fragments fragments;
  std::size_t kept = 0;
  for (std::size_t i = 0; i < cut.size(); ++i) {
    const ConvexSlot source = touched[i];
    const Convex& parent = *structure.convex(source);
    if (cut[i].failed) {
      ++fragments.failed;
      fragments.failed_m3 += parent.solid.volume_m3;
    }
    const CellPart& first = cut[i].parts[0];
    if (first.convex.get() == &parent && group_of(first, pattern, sphere) == Fragment::kRest) {
      continue;
    }
    touched[kept++] = source;
    fragments.debris_volume_m3 += cut[i].debris_volume_m3;
    const std::uint8_t anchored = structure.anchored(source);
    for (const CellPart& part : cut[i].parts) {
      fragments.all.push_back({part.convex, source, part.cell, group_of(part, pattern, sphere), 0});
      if (anchored == 0) continue;  // Boxes of meshes are expensive.
      fragments.all.back().anchored =
          inherited_anchors(anchored, solid_box(parent), solid_box(*part.convex));
    }
  }
  touched.resize(kept);
  std::stable_sort(fragments.all.begin(), fragments.all.end(),
                   [](const Fragment& a, const Fragment& b) {
                     return std::tie(a.source, a.cell) < std::tie(b.source, b.cell);
                   });
  fragments.ghosts =
      cut_ghosts(structure, touched, pattern, fragments.all, fragments.debris_volume_m3);
  group_overlaps(fragments.ghosts, structure.slot_count(), fragments.all);
  Welder(pattern, structure.slot_count(), fragments).run();
  return fragments;
}

}  // namespace sunder::fracture
