#include "fracture/intersect.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <utility>

#include "engine/base/check.h"

namespace sunder::fracture {
namespace {

constexpr double kVolumeError = 1e-12;  // relative; more than this is a failure

/// Distances that rounding cannot tell from zero.
double tolerance_of(const Convex& convex) {
  const double far =
      std::max(convex.box.min.cwiseAbs().maxCoeff(), convex.box.max.cwiseAbs().maxCoeff());
  return 1e-13 * convex.box.extent().maxCoeff() + 2e-15 * far;
}

/// Volume that rounding of vertices may add or take, besides the relative error.
double volume_noise(const Convex& convex) {
  const Vec3 extent = convex.box.extent();
  const double far =
      std::max(convex.box.min.cwiseAbs().maxCoeff(), convex.box.max.cwiseAbs().maxCoeff());
  const double area = extent.x() * extent.y() + extent.y() * extent.z() + extent.z() * extent.x();
  return 4e-16 * far * area;
}

/// A part under way: its region of the pattern is the intersection of half-spaces.
struct Draft {
  std::uint32_t cell = CellPart::kFarCell;
  std::vector<PlaneId> region;  ///< Pattern names.
  ConvexPtr convex;
};

/// Cuts one convex.
class Cutter {
 public:
  Cutter(const AlignedPattern& pattern, const ConvexPtr& parent)
      : pattern_(pattern), parent_(parent), tolerance_(tolerance_of(*parent)) {}

  Intersection run() {
    cut_far();
    std::vector<std::uint32_t> cells;
    pattern_.overlapping(parent_->box, cells);
    for (const std::uint32_t cell : cells) cut_cell(cell);
    settle_slivers();
    return finish();
  }

 private:
  struct Cut {
    double depth;
    PlaneId id;
    bool operator<(const Cut& other) const {
      return depth != other.depth ? depth > other.depth : id < other.id;
    }
  };

  /// What lies outside the pattern's box, one slab a plane of the box.
  void cut_far() {
    std::vector<PlaneId> region;
    for (std::uint32_t i = 0; i < Pattern::kBoxPlanes; ++i) {
      region.push_back(pattern_plane(i, true));
      if (ConvexPtr convex = clip_by(region))
        drafts_.push_back({CellPart::kFarCell, region, convex});
      region.back() = pattern_plane(i, false);
    }
  }

  void cut_cell(std::uint32_t index) {
    const AlignedPattern::Cell& cell = pattern_.cells[index];
    const ConvexPolyhedron& shape = pattern_.pattern->cells[cell.index].polyhedron;
    std::vector<PlaneId> region;
    for (const ConvexPolyhedron::Face& face : shape.faces) region.push_back(face.id);
    ConvexPtr convex = contains(cell) ? make_convex(pattern_.polyhedron(cell), parent_->material)
                                      : clip_by(region);
    if (convex) drafts_.push_back({index, std::move(region), std::move(convex)});
  }

  /// Whether the cell lies strictly inside the parent.
  bool contains(const AlignedPattern::Cell& cell) const {
    if ((cell.box.min.array() <= parent_->box.min.array()).any()) return false;
    if ((cell.box.max.array() >= parent_->box.max.array()).any()) return false;
    for (const ConvexPolyhedron::Face& face : parent_->polyhedron.faces) {
      for (const Vec3& vertex : pattern_.cell_vertices(cell)) {
        if (face.plane.distance(vertex) >= -tolerance_) return false;
      }
    }
    return true;
  }

  /// The planes of a region that cut the parent, deepest first; nothing if it lies outside one.
  std::optional<std::vector<Cut>> find_cuts(const std::vector<PlaneId>& region) const {
    std::vector<Cut> cuts;
    for (const PlaneId id : region) {
      const Plane plane = pattern_.plane(id);
      double least = 1e300, most = -1e300;
      for (const Vec3& vertex : parent_->polyhedron.vertices) {
        const double distance = plane.distance(vertex);
        least = std::min(least, distance);
        most = std::max(most, distance);
      }
      if (least >= -tolerance_) return std::nullopt;
      if (most > tolerance_) cuts.push_back({plane.distance(parent_->solid.centroid), id});
    }
    std::sort(cuts.begin(), cuts.end());
    return cuts;
  }

  /// The parent within a region: null if there is nothing, the parent itself if all of it.
  ConvexPtr clip_by(const std::vector<PlaneId>& region) {
    const std::optional<std::vector<Cut>> cuts = find_cuts(region);
    if (!cuts) return nullptr;
    const ConvexPolyhedron* from = &parent_->polyhedron;
    for (const Cut& cut : *cuts) {
      const PlaneSide side =
          clip(*from, pattern_.plane(cut.id), pattern_.name(cut.id), tolerance_, next_, scratch_);
      if (side == PlaneSide::kOutside) return nullptr;
      if (side == PlaneSide::kInside) continue;
      std::swap(current_, next_);
      from = &current_;
    }
    return from == &current_ ? make_convex(current_, parent_->material) : parent_;
  }

  void settle_slivers() {
    const double floor = kVolumeFloor * parent_->solid.volume_m3;
    for (std::size_t i = 0; i < drafts_.size();) {
      const double volume = drafts_[i].convex->solid.volume_m3;
      if (volume >= floor || drafts_.size() == 1) {
        ++i;
        continue;
      }
      if (!hand_over(i)) debris_ += std::max(0.0, volume);
      drafts_.erase(drafts_.begin() + static_cast<std::ptrdiff_t>(i));
    }
  }

  /// Gives a sliver to its neighbours by not making the cuts towards it: to the one behind its
  /// largest cut if that takes all of it, otherwise shared among all.
  bool hand_over(std::size_t sliver) {
    const Draft& giver = drafts_[sliver];
    std::vector<std::pair<double, std::size_t>> neighbours;  // −area of the cut, draft
    std::vector<PlaneId> cuts(drafts_.size());
    for (const PlaneId id : giver.region) {
      const double area = area_in(giver.convex->polyhedron, pattern_.name(id));
      if (area <= 0) continue;
      for (std::size_t other = 0; other < drafts_.size(); ++other) {
        const std::vector<PlaneId>& region = drafts_[other].region;
        if (other == sliver || !cuts[other].none()) continue;
        if (std::find(region.begin(), region.end(), id.opposite()) == region.end()) continue;
        cuts[other] = id.opposite();
        neighbours.emplace_back(-area, other);
      }
    }
    std::sort(neighbours.begin(), neighbours.end());
    for (const auto& neighbour : neighbours) {
      if (take_over(std::span(&neighbour, 1), cuts, giver)) return true;
    }
    return neighbours.size() > 1 && take_over(neighbours, cuts, giver);
  }

  static double area_in(const ConvexPolyhedron& shape, PlaneId name) {
    double area = 0;
    for (std::size_t f = 0; f < shape.faces.size(); ++f) {
      if (shape.faces[f].id == name) area += face_area(shape, f);
    }
    return area;
  }

  /// Whether drafts without their cuts towards a sliver are exactly themselves and it; if so, they
  /// become that.
  bool take_over(std::span<const std::pair<double, std::size_t>> takers,
                 const std::vector<PlaneId>& cuts, const Draft& sliver) {
    std::vector<Draft> grown;
    double surplus = -sliver.convex->solid.volume_m3;
    for (const auto& [area, taker] : takers) {
      grown.push_back(drafts_[taker]);
      std::erase(grown.back().region, cuts[taker]);
      grown.back().convex = clip_by(grown.back().region);
      if (!grown.back().convex) return false;
      surplus += grown.back().convex->solid.volume_m3 - drafts_[taker].convex->solid.volume_m3;
    }
    const double allowed = 0.1 * (kVolumeError * parent_->solid.volume_m3 + noise_);
    if (std::abs(surplus) > allowed) return false;
    for (std::size_t i = 0; i < takers.size(); ++i) drafts_[takers[i].second] = std::move(grown[i]);
    return true;
  }

  Intersection finish() {
    Intersection result;
    double sum = debris_;
    std::size_t largest = 0;
    for (std::size_t i = 0; i < drafts_.size(); ++i) {
      const double volume = drafts_[i].convex->solid.volume_m3;
      sum += volume;
      if (volume > drafts_[largest].convex->solid.volume_m3) largest = i;
      result.parts.push_back({drafts_[i].cell, drafts_[i].convex});
    }
    result.debris_volume_m3 = debris_;
    const double error = std::abs(sum - parent_->solid.volume_m3);
    if (drafts_.empty() || !(error <= kVolumeError * parent_->solid.volume_m3 + noise_)) {
      result = {{{drafts_.empty() ? CellPart::kFarCell : drafts_[largest].cell, parent_}}, 0, true};
    }
    return result;
  }

  const AlignedPattern& pattern_;
  const ConvexPtr& parent_;
  double tolerance_;
  double noise_ = volume_noise(*parent_);
  double debris_ = 0;
  std::vector<Draft> drafts_;
  ConvexPolyhedron current_, next_;
  ClipScratch scratch_;
};

}  // namespace

Intersection intersect(const AlignedPattern& pattern, const ConvexPtr& convex) {
  return Cutter(pattern, convex).run();
}

}  // namespace sunder::fracture
