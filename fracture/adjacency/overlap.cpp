#include "fracture/adjacency/overlap.h"

#include <algorithm>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/clip.h"

namespace sunder::fracture {
namespace {

constexpr std::size_t kMostPartsOfOne = 1000;
constexpr std::size_t kMostGhosts = 1000000;

double rounding(const ConvexPolyhedron& convex) {
  double farthest = 0;
  for (const Vec3& vertex : convex.vertices) {
    farthest = std::max(farthest, vertex.cwiseAbs().maxCoeff());
  }
  return 4e-15 * farthest;
}

/// Returns the depth of `convex` behind a plane; negative if it is not behind.
double depth_behind(const Plane& plane, const ConvexPolyhedron& convex) {
  double least = plane.distance(convex.vertices[0]);
  for (const Vec3& vertex : convex.vertices) least = std::min(least, plane.distance(vertex));
  return -least;
}

/// Returns true if some face of `a` has `b` behind it by no more than `tolerance`.
bool face_separates(const ConvexPolyhedron& a, const ConvexPolyhedron& b, double tolerance) {
  return std::any_of(a.faces.begin(), a.faces.end(), [&](const ConvexPolyhedron::Face& face) {
    return depth_behind(face.plane, b) <= tolerance;
  });
}

bool is_thin(const ConvexPolyhedron& solid, double tolerance_m) {
  return face_separates(solid, solid, tolerance_m);
}

Box grown(const Box& box, double by) {
  return {box.min - Vec3::Constant(by), box.max + Vec3::Constant(by)};
}

/// Appends convex parts of `solid` that lie outside `other`.
void subtract_convex(ConvexPolyhedron solid, const ConvexPolyhedron& other, double tolerance_m,
                     std::vector<ConvexPolyhedron>& outside) {
  ClipScratch scratch;
  ConvexPolyhedron part;
  for (const ConvexPolyhedron::Face& face : other.faces) {
    const Plane beyond = face.plane.flipped();
    const double noise = rounding(solid);
    const PlaneSide side = clip(solid, beyond, face.id.opposite(), noise, part, scratch);
    if (side == PlaneSide::kOutside) continue;
    if (side == PlaneSide::kInside) {
      outside.push_back(std::move(solid));
      return;
    }
    if (!is_thin(part, tolerance_m)) outside.push_back(part);
    if (clip(solid, face.plane, face.id, noise, part, scratch) == PlaneSide::kCut) {
      std::swap(solid, part);
    }
  }
}

/// Returns true if more than kMaxConvexesPerGhost polyhedra intersect: `common` is the intersection
/// of `count`; `others` from `first` on are added to it.
bool is_too_deep(const ConvexPolyhedron& common, std::size_t count,
                 const std::vector<const ConvexPolyhedron*>& others, std::size_t first,
                 double tolerance_m) {
  if (count > kMaxConvexesPerGhost) return true;
  for (std::size_t i = first; i < others.size(); ++i) {
    const ConvexPolyhedron deeper = overlap(common, *others[i], tolerance_m);
    if (!deeper.empty() && is_too_deep(deeper, count + 1, others, i + 1, tolerance_m)) return true;
  }
  return false;
}

/// Returns the ghost of the convexes `of`, whose intersection is `common`.
Ghost make_ghost(std::span<const ConvexPtr> convexes, ConvexPolyhedron common,
                 std::vector<std::uint32_t> of) {
  const bool weighs = std::all_of(of.begin(), of.end(),
                                  [&](std::uint32_t c) { return convexes[c]->is_internal(); });
  const int sign = of.size() % 2 == 0 ? -1 : 1;
  const MaterialIndex material = convexes[of.back()]->material;
  return {make_convex(std::move(common), material), std::move(of),
          static_cast<std::int8_t>(weighs ? sign : 0)};
}

}  // namespace

ConvexPolyhedron overlap(const ConvexPolyhedron& a, const ConvexPolyhedron& b, double tolerance_m) {
  if (face_separates(a, b, tolerance_m) || face_separates(b, a, tolerance_m)) return {};
  const double noise = std::max(rounding(a), rounding(b));
  ClipScratch scratch;
  ConvexPolyhedron common = a, next;
  for (const ConvexPolyhedron::Face& face : b.faces) {
    const PlaneSide side = clip(common, face.plane, face.id, noise, next, scratch);
    if (side == PlaneSide::kOutside) return {};
    if (side == PlaneSide::kCut) std::swap(common, next);
  }
  return is_thin(common, tolerance_m) ? ConvexPolyhedron{} : common;
}

std::vector<ConvexPolyhedron> subtract(const ConvexPolyhedron& solid,
                                       const std::vector<const ConvexPolyhedron*>& others,
                                       double tolerance_m) {
  std::vector<ConvexPolyhedron> left{solid}, next;
  for (const ConvexPolyhedron* other : others) {
    next.clear();
    for (ConvexPolyhedron& part : left) {
      if (overlap(part, *other, tolerance_m).empty()) {
        next.push_back(std::move(part));
      } else {
        subtract_convex(std::move(part), *other, tolerance_m, next);
      }
    }
    std::swap(left, next);
    if (left.size() > kMostPartsOfOne) {
      throw InputError(
          "a part overlaps too many others at once; use fewer parts, or move them apart");
    }
  }
  return left;
}

PartPairs find_pairs(std::span<const Part> parts, double tolerance_m) {
  std::vector<Box> boxes;
  for (const Part& part : parts) boxes.push_back(grown(bounds(part.polyhedron), tolerance_m));
  const Bvh tree(boxes);
  PartPairs pairs;
  std::vector<std::uint32_t> found;
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    found.clear();
    tree.overlaps(boxes[i], found);
    for (const std::uint32_t j : found) {
      if (j > i) pairs.emplace_back(i, j);
    }
  }
  return pairs;
}

PartPairs find_overlaps(std::span<const Part> parts, const PartPairs& pairs, double tolerance_m) {
  std::vector<std::uint8_t> do_overlap(pairs.size());
  for_chunks(pairs.size(), 256, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t p = begin; p < end; ++p) {
      const auto [a, b] = pairs[p];
      do_overlap[p] = !overlap(parts[a].polyhedron, parts[b].polyhedron, tolerance_m).empty();
    }
  });
  PartPairs found;
  for (std::size_t p = 0; p < pairs.size(); ++p) {
    if (do_overlap[p]) found.push_back(pairs[p]);
  }
  return found;
}

bool cut_deep_overlaps(std::vector<Part>& parts, const PartPairs& overlaps, double tolerance_m) {
  std::vector<std::vector<std::uint32_t>> before(
      parts.size());  // Per part: the earlier parts that it overlaps.
  std::size_t most = 0;
  for (const auto& [a, b] : overlaps) {
    if (parts[a].visual || parts[b].visual) continue;
    before[b].push_back(a);
    most = std::max(most, before[b].size());
  }
  if (most < kMaxConvexesPerGhost) return false;
  std::vector<std::vector<Part>> result(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    std::vector<const ConvexPolyhedron*> others;
    for (const std::uint32_t other : before[p]) {
      for (const Part& part : result[other]) others.push_back(&part.polyhedron);
    }
    Part& part = parts[p];
    if (!is_too_deep(part.polyhedron, 1, others, 0, tolerance_m)) {
      result[p].push_back(std::move(part));
      continue;
    }
    const Box whole = bounds(part.polyhedron);
    for (ConvexPolyhedron& left : subtract(part.polyhedron, others, tolerance_m)) {
      const std::uint8_t anchored = inherited_anchors(part.anchored, whole, bounds(left));
      result[p].push_back({std::move(left), part.material, anchored});
    }
  }
  parts.clear();
  for (std::vector<Part>& some : result) {
    std::move(some.begin(), some.end(), std::back_inserter(parts));
  }
  return true;
}

std::vector<Ghost> find_ghosts(std::span<const ConvexPtr> convexes, const PartPairs& overlaps,
                               double tolerance_m) {
  std::vector<Ghost> ghosts;
  for (const auto& [a, b] : overlaps) {
    ConvexPolyhedron common =
        overlap(convexes[a]->polyhedron, convexes[b]->polyhedron, tolerance_m);
    if (!common.empty()) ghosts.push_back(make_ghost(convexes, std::move(common), {a, b}));
  }
  std::vector<std::vector<std::uint32_t>> after(convexes.size());
  for (const Ghost& ghost : ghosts) {
    if (ghost.sign != 0) after[ghost.of[0]].push_back(ghost.of[1]);
  }
  for (std::size_t g = 0; g < ghosts.size(); ++g) {
    if (ghosts[g].sign == 0 || ghosts[g].of.size() == kMaxConvexesPerGhost) continue;
    for (const std::uint32_t next : after[ghosts[g].of.back()]) {
      ConvexPolyhedron common =
          overlap(ghosts[g].convex->polyhedron, convexes[next]->polyhedron, tolerance_m);
      if (common.empty()) continue;
      std::vector<std::uint32_t> of = ghosts[g].of;
      of.push_back(next);
      ghosts.push_back(make_ghost(convexes, std::move(common), std::move(of)));
    }
    if (ghosts.size() > kMostGhosts) {
      throw InputError(
          "parts overlap in more than 1,000,000 places; use fewer parts, or move them apart");
    }
  }
  sort_ghosts(ghosts);
  return ghosts;
}

}  // namespace sunder::fracture
