#include "fracture/cut/ghosts.h"

#include <algorithm>
#include <limits>
#include <span>

#include "engine/base/disjoint_sets.h"
#include "engine/base/parallel.h"
#include "fracture/adjacency/overlap.h"
#include "fracture/cut/intersect.h"

namespace sunder::fracture {
namespace {

// Least thickness of overlaps of surface convexes, over their size.
constexpr double kMinOverlapThickness = 1e-9;

/// Returns the distance of a point from a convex's faces; negative inside.
double signed_distance(const Convex& convex, const Vec3& point) {
  double most = -std::numeric_limits<double>::infinity();
  for (const ConvexPolyhedron::Face& face : convex.polyhedron.faces) {
    most = std::max(most, face.plane.distance(point));
  }
  return most;
}

/// Cuts ghosts and assigns the parts to fragments.
class GhostCutter {
 public:
  GhostCutter(const Structure& structure, const std::vector<ConvexSlot>& touched,
              const AlignedPattern& pattern, const std::vector<Fragment>& fragments)
      : structure_(structure), touched_(touched), pattern_(pattern), fragments_(fragments) {}

  /// Returns the parts of one ghost; may be called from any thread.
  std::vector<Ghost> cut(const Ghost& ghost, double& debris) const {
    std::vector<Ghost> parts;
    if (ghost.sign == 0) {
      find_overlaps_of_parts(ghost, parts);
      return parts;
    }
    const Intersection intersection = intersect(pattern_, ghost.convex);
    debris += ghost.sign * intersection.debris_volume_m3;
    for (const CellPart& part : intersection.parts) {
      const Vec3& center = part.convex->solid.centroid;
      std::vector<std::uint32_t> of;
      for (const std::uint32_t overlapped : ghost.of) {
        const ConvexSlot slot(overlapped);
        of.push_back(part_of(slot, part.cell, center));
        if (of.back() != kNone) continue;
        // A sliver was merged into another cell with its overlaps, and is counted there.
        of = {deepest_part(slot, center)};
        break;
      }
      std::sort(of.begin(), of.end());
      of.erase(std::unique(of.begin(), of.end()), of.end());
      parts.push_back({part.convex, std::move(of), ghost.sign});
    }
    return parts;
  }

 private:
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();

  bool is_cut(ConvexSlot slot) const {
    return std::binary_search(touched_.begin(), touched_.end(), slot);
  }

  std::span<const Fragment> parts_of(ConvexSlot slot) const {
    const auto less = [](const Fragment& part, std::uint32_t s) { return part.source.value < s; };
    const auto first = std::lower_bound(fragments_.begin(), fragments_.end(), slot.value, less);
    const auto last = std::lower_bound(first, fragments_.end(), slot.value + 1, less);
    return {first, last};
  }

  std::uint32_t node_of(const Fragment& fragment) const {
    return structure_.slot_count() + static_cast<std::uint32_t>(&fragment - fragments_.data());
  }

  /// Returns the part of a convex in a cell that contains a point; kNone if there is none.
  std::uint32_t part_of(ConvexSlot slot, std::uint32_t cell, const Vec3& point) const {
    if (!is_cut(slot)) return slot.value;
    const std::span<const Fragment> parts = parts_of(slot);
    if (parts.size() == 1) return node_of(parts[0]);  // The convex may have been left whole.
    std::uint32_t best = kNone;
    double least = std::numeric_limits<double>::infinity();
    for (const Fragment& part : parts) {
      if (part.cell != cell) continue;
      const double distance = signed_distance(*part.convex, point);
      if (distance < least) best = node_of(part);
      least = std::min(least, distance);
    }
    return best;
  }

  /// Returns the part of a convex in which a point lies deepest.
  std::uint32_t deepest_part(ConvexSlot slot, const Vec3& point) const {
    std::uint32_t best = kNone;
    double least = std::numeric_limits<double>::infinity();
    for (const Fragment& part : parts_of(slot)) {
      const double distance = signed_distance(*part.convex, point);
      if (distance < least) best = node_of(part);
      least = std::min(least, distance);
    }
    return best;
  }

  /// A convex after the cuts.
  struct Node {
    const ConvexPtr& convex;
    std::uint32_t number;
    const Fragment* fragment;  ///< Null if the convex was not cut.
  };
  std::vector<Node> nodes_of(ConvexSlot slot) const {
    std::vector<Node> nodes;
    if (!is_cut(slot)) nodes.push_back({structure_.convex(slot), slot.value, nullptr});
    for (const Fragment& part : parts_of(slot))
      nodes.push_back({part.convex, node_of(part), &part});
    return nodes;
  }

  /// Finds the overlaps of surface convexes again, as their parts were fitted to the visual meshes.
  void find_overlaps_of_parts(const Ghost& ghost, std::vector<Ghost>& parts) const {
    for (const Node& a : nodes_of(ConvexSlot(ghost.of.front()))) {
      for (const Node& b : nodes_of(ConvexSlot(ghost.of.back()))) {
        if (a.fragment && b.fragment && a.fragment->cell != b.fragment->cell) continue;
        const Vec3 size = a.convex->box.extent().cwiseMin(b.convex->box.extent());
        ConvexPolyhedron common = overlap(a.convex->polyhedron, b.convex->polyhedron,
                                          kMinOverlapThickness * size.maxCoeff());
        if (common.empty()) continue;
        parts.push_back({make_convex(std::move(common), a.convex->material),
                         {std::min(a.number, b.number), std::max(a.number, b.number)},
                         0});
      }
    }
  }

  const Structure& structure_;
  const std::vector<ConvexSlot>& touched_;
  const AlignedPattern& pattern_;
  const std::vector<Fragment>& fragments_;
};

}  // namespace

std::vector<Ghost> cut_ghosts(const Structure& structure, const std::vector<ConvexSlot>& touched,
                              const AlignedPattern& pattern, const std::vector<Fragment>& fragments,
                              double& debris_volume_m3) {
  std::vector<std::uint32_t> old;
  for (const ConvexSlot slot : touched) {
    const std::span<const std::uint32_t> of_slot = structure.ghost_indices(slot);
    old.insert(old.end(), of_slot.begin(), of_slot.end());
  }
  std::sort(old.begin(), old.end());
  old.erase(std::unique(old.begin(), old.end()), old.end());
  const GhostCutter cutter(structure, touched, pattern, fragments);
  std::vector<std::vector<Ghost>> parts(old.size());
  std::vector<double> debris(old.size(), 0.0);
  for_chunks(old.size(), 4, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      parts[i] = cutter.cut(structure.ghost(old[i]), debris[i]);
    }
  });
  std::vector<Ghost> ghosts;
  for (std::size_t i = 0; i < old.size(); ++i) {
    std::move(parts[i].begin(), parts[i].end(), std::back_inserter(ghosts));
    debris_volume_m3 += debris[i];
  }
  return ghosts;
}

void group_overlaps(const std::vector<Ghost>& ghosts, std::uint32_t slot_count,
                    std::vector<Fragment>& fragments) {
  if (ghosts.empty()) return;
  DisjointSets sets(fragments.size());
  std::vector<std::uint32_t> kept;  // Overlapping a convex that is not cut.
  for (const Ghost& ghost : ghosts) {
    const std::uint32_t last = ghost.of.back();
    if (last < slot_count) continue;
    for (const std::uint32_t node : ghost.of) {
      if (node < slot_count) {
        kept.push_back(last - slot_count);
      } else {
        sets.join(node - slot_count, last - slot_count);
      }
    }
  }
  std::vector<std::uint32_t> group(fragments.size(), Fragment::kRest);
  for (std::uint32_t i = 0; i < fragments.size(); ++i) {
    std::uint32_t& of_root = group[sets.root(i)];
    of_root = std::min(of_root, fragments[i].group);
  }
  for (const std::uint32_t i : kept) group[sets.root(i)] = Fragment::kRest;
  for (std::uint32_t i = 0; i < fragments.size(); ++i) fragments[i].group = group[sets.root(i)];
}

}  // namespace sunder::fracture
