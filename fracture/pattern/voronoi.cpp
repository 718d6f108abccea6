#include "fracture/pattern/voronoi.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/base/roots.h"
#include "engine/geometry/bvh.h"
#include "engine/geometry/clip.h"
#include "fracture/pattern/pattern.h"

namespace sunder::fracture {
namespace {

constexpr std::uint64_t kFirstSiteId = std::uint64_t{1} << 40;

/// Lists the sites around one site by distance, in shells of increasing radius.
class Neighbours {
 public:
  Neighbours(std::span<const Vec3> sites, const Bvh& tree, std::uint32_t site, double radius)
      : sites_(sites), tree_(tree), site_(site), radius_(radius) {}

  /// Sets `ring` to the next shell, nearest first, ties by index; returns false if all sites nearer
  /// than `limit` have been listed.
  bool next(double limit, std::vector<std::pair<double, std::uint32_t>>& ring) {
    if (hits_.size() == sites_.size() || last_ >= limit) return false;
    ring.clear();
    hits_.clear();
    tree_.within(sites_[site_], radius_, hits_);
    for (const std::uint32_t other : hits_) {
      const double distance = (sites_[other] - sites_[site_]).norm();
      if (other != site_ && distance >= last_ && distance < radius_) {
        ring.emplace_back(distance, other);
      }
    }
    std::sort(ring.begin(), ring.end());
    last_ = radius_;
    radius_ *= 2;
    return true;
  }

 private:
  std::span<const Vec3> sites_;
  const Bvh& tree_;
  std::uint32_t site_;
  double radius_;
  double last_ = 0;
  std::vector<std::uint32_t> hits_;
};

double reach(const ConvexPolyhedron& cell, const Vec3& site) {
  double square = 0;
  for (const Vec3& vertex : cell.vertices) square = std::max(square, (vertex - site).squaredNorm());
  return std::sqrt(square);
}

Plane bisector(const Vec3& low, const Vec3& high) {
  return Plane::through(0.5 * (low + high), (high - low).normalized());
}

/// Returns one cell. A face made by site j has the id kFirstSiteId + j until planes have indices.
ConvexPolyhedron clip_cell(std::span<const Vec3> sites, std::uint32_t site, const Bvh& tree,
                           double ring_m, const ConvexPolyhedron& solid, double tolerance,
                           ClipScratch& scratch) {
  ConvexPolyhedron cell = solid, cut;
  Neighbours neighbours(sites, tree, site, ring_m);
  std::vector<std::pair<double, std::uint32_t>> ring;
  double reach_m = reach(cell, sites[site]);
  while (neighbours.next(2 * reach_m, ring)) {
    for (const auto& [distance, other] : ring) {
      if (distance >= 2 * reach_m) return cell;
      if (distance == 0 && other < site) return {};  // A duplicate site has no cell.
      if (distance == 0) continue;
      const bool is_low = site < other;
      const Plane plane = is_low ? bisector(sites[site], sites[other])
                                 : bisector(sites[other], sites[site]).flipped();
      const PlaneSide side = clip(cell, plane, {kFirstSiteId + other}, tolerance, cut, scratch);
      if (side == PlaneSide::kOutside) return {};
      if (side == PlaneSide::kInside) continue;
      std::swap(cell, cut);
      reach_m = reach(cell, sites[site]);
    }
  }
  return cell;
}

}  // namespace

std::vector<ConvexPolyhedron> voronoi_cells(std::span<const Vec3> sites,
                                            const ConvexPolyhedron& solid,
                                            std::vector<Plane>& planes) {
  std::vector<Box> points(sites.size());
  for (std::size_t i = 0; i < sites.size(); ++i) points[i].extend(sites[i]);
  const Bvh tree(points);
  const Vec3 extent = bounds(solid).extent();
  const double ring_m = 2 * cube_root(extent.prod() / static_cast<double>(sites.size() + 1));
  const double tolerance = 1e-14 * extent.maxCoeff();
  std::vector<ConvexPolyhedron> cells(sites.size());
  for_chunks(sites.size(), 32, [&](std::size_t begin, std::size_t end, std::size_t) {
    ClipScratch scratch;
    for (std::size_t i = begin; i < end; ++i) {
      cells[i] =
          clip_cell(sites, static_cast<std::uint32_t>(i), tree, ring_m, solid, tolerance, scratch);
    }
  });

  std::map<std::pair<std::uint32_t, std::uint32_t>, std::uint32_t> names;
  for (std::size_t i = 0; i < cells.size(); ++i) {
    for (ConvexPolyhedron::Face& face : cells[i].faces) {
      if (face.id.value < kFirstSiteId) continue;
      const auto site = static_cast<std::uint32_t>(i);
      const auto other = static_cast<std::uint32_t>(face.id.value - kFirstSiteId);
      const auto pair = std::minmax(site, other);
      const auto [it, is_new] = names.emplace(pair, static_cast<std::uint32_t>(planes.size()));
      if (is_new) planes.push_back(bisector(sites[pair.first], sites[pair.second]));
      face.id = pattern_plane(it->second, site == pair.second);
    }
  }
  return cells;
}

}  // namespace sunder::fracture
