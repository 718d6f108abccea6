#include "fracture/intersect.h"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "engine/base/check.h"

namespace sunder::fracture {
namespace {

constexpr double kVolumeError = 1e-12;  // relative; more than this is a failure

double farthest_coordinate(const Convex& convex) {
  return std::max(convex.box.min.cwiseAbs().maxCoeff(), convex.box.max.cwiseAbs().maxCoeff());
}

/// Distances that rounding cannot tell from zero.
double tolerance_of(const Convex& convex) { return 4e-15 * farthest_coordinate(convex); }

/// Volume that rounding of vertices may add or take, besides the relative error.
double volume_noise(const Convex& convex) {
  const Vec3 extent = convex.box.extent();
  const double area = extent.x() * extent.y() + extent.y() * extent.z() + extent.z() * extent.x();
  return 4e-16 * farthest_coordinate(convex) * area;
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
    if (!adds_up()) cut_in_turn(cells);
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
    region_.clear();
    for (const ConvexPolyhedron::Face& face : shape.faces) region_.push_back(face.id);
    ConvexPtr convex = contains(cell) ? make_convex(pattern_.polyhedron(cell), parent_->material)
                                      : clip_by(region_);
    if (convex) drafts_.push_back({index, region_, std::move(convex)});
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

  /// Finds the planes of a region that cut the parent, deepest first; false if it lies outside one.
  bool find_cuts(const std::vector<PlaneId>& region, std::vector<Cut>& cuts) const {
    cuts.clear();
    for (const PlaneId id : region) {
      const Plane plane = pattern_.plane(id);
      double least = 1e300, most = -1e300;
      for (const Vec3& vertex : parent_->polyhedron.vertices) {
        const double distance = plane.distance(vertex);
        least = std::min(least, distance);
        most = std::max(most, distance);
      }
      if (least >= -tolerance_) return false;
      if (most > tolerance_) cuts.push_back({plane.distance(parent_->solid.centroid), id});
    }
    std::sort(cuts.begin(), cuts.end());
    return true;
  }

  /// The parent within a region: null if there is nothing, the parent itself if all of it.
  ConvexPtr clip_by(const std::vector<PlaneId>& region) {
    if (!find_cuts(region, cuts_)) return nullptr;
    const ConvexPolyhedron* from = &parent_->polyhedron;
    for (const Cut& cut : cuts_) {
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
    const double unit = pattern_.placement.linear.determinant();
    const double floor = kVolumeFloor * std::min(parent_->solid.volume_m3, unit);
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

  /// Lets drafts grow beyond their cuts towards a sliver, if what they gain is all of it, no more,
  /// and none of it twice.
  bool take_over(std::span<const std::pair<double, std::size_t>> takers,
                 const std::vector<PlaneId>& cuts, const Draft& sliver) {
    std::vector<Draft> grown;
    double missing = sliver.convex->solid.volume_m3;
    for (const auto& [area, taker] : takers) {
      Draft draft = drafts_[taker];
      std::replace(draft.region.begin(), draft.region.end(), cuts[taker], cuts[taker].opposite());
      const ConvexPtr gain = clip_by(draft.region);
      if (gain && !lies_within(*gain, sliver.region)) return false;
      for (const Draft& other : grown) {
        if (!are_apart(draft.region, other.region)) return false;
      }
      missing -= gain ? gain->solid.volume_m3 : 0;
      std::erase(draft.region, cuts[taker].opposite());
      draft.convex = clip_by(draft.region);
      grown.push_back(std::move(draft));
    }
    const double allowed = 0.1 * (kVolumeError * parent_->solid.volume_m3 + noise_);
    if (std::abs(missing) > allowed) return false;
    for (std::size_t i = 0; i < takers.size(); ++i) drafts_[takers[i].second] = std::move(grown[i]);
    return true;
  }

  bool lies_within(const Convex& convex, const std::vector<PlaneId>& region) const {
    for (const PlaneId id : region) {
      const Plane plane = pattern_.plane(id);
      for (const Vec3& vertex : convex.polyhedron.vertices) {
        if (plane.distance(vertex) > 4 * tolerance_) return false;
      }
    }
    return true;
  }

  /// Whether some plane keeps two regions apart.
  static bool are_apart(const std::vector<PlaneId>& a, const std::vector<PlaneId>& b) {
    return std::any_of(a.begin(), a.end(), [&](PlaneId id) {
      return std::find(b.begin(), b.end(), id.opposite()) != b.end();
    });
  }

  bool adds_up() const {
    double sum = debris_;
    for (const Draft& draft : drafts_) sum += draft.convex->solid.volume_m3;
    const double allowed = kVolumeError * parent_->solid.volume_m3 + noise_;
    return !drafts_.empty() && std::abs(sum - parent_->solid.volume_m3) <= allowed;
  }

  /// For cells that do not quite tile (rounded files): each takes its part of what those before it
  /// left, so that every cut has two sides and nothing is lost. Cuts go right through what is left,
  /// which makes more parts than there are cells.
  void cut_in_turn(const std::vector<std::uint32_t>& cells) {
    drafts_.clear();
    debris_ = 0;
    std::vector<ConvexPolyhedron> left{parent_->polyhedron}, beyond;
    for (const std::uint32_t index : cells) {
      const AlignedPattern::Cell& cell = pattern_.cells[index];
      beyond.clear();
      for (ConvexPolyhedron& solid : left) {
        if (take_part(solid, pattern_.pattern->cells[cell.index].polyhedron, beyond)) {
          drafts_.push_back({index, {}, make_convex(std::move(solid), parent_->material)});
        }
      }
      std::swap(left, beyond);
    }
    for (ConvexPolyhedron& solid : left) {
      drafts_.push_back({CellPart::kFarCell, {}, make_convex(std::move(solid), parent_->material)});
    }
    settle_slivers();
  }

  /// Cuts `solid` down to what lies in a cell; the rest goes `beyond`. False if nothing does.
  bool take_part(ConvexPolyhedron& solid, const ConvexPolyhedron& cell,
                 std::vector<ConvexPolyhedron>& beyond) {
    const std::size_t before = beyond.size();
    current_ = solid;
    for (const ConvexPolyhedron::Face& face : cell.faces) {
      const Plane plane = pattern_.plane(face.id);
      const PlaneId name = pattern_.name(face.id);
      const PlaneSide side = clip(current_, plane, name, tolerance_, next_, scratch_);
      if (side == PlaneSide::kInside) continue;
      if (side == PlaneSide::kOutside) {
        beyond.resize(before);
        beyond.push_back(std::move(solid));
        return false;
      }
      ConvexPolyhedron outside;
      clip(current_, plane.flipped(), name.opposite(), tolerance_, outside, scratch_);
      beyond.push_back(std::move(outside));
      std::swap(current_, next_);
    }
    solid = current_;
    return true;
  }

  Intersection finish() {
    Intersection result;
    if (!adds_up()) {
      std::uint32_t cell = CellPart::kFarCell;
      double largest = 0;
      for (const Draft& draft : drafts_) {
        if (draft.convex->solid.volume_m3 <= largest) continue;
        largest = draft.convex->solid.volume_m3;
        cell = draft.cell;
      }
      result.parts.push_back({cell, parent_});
      result.failed = true;
      return result;
    }
    result.debris_volume_m3 = debris_;
    for (const Draft& draft : drafts_) result.parts.push_back({draft.cell, draft.convex});
    return result;
  }

  const AlignedPattern& pattern_;
  const ConvexPtr& parent_;
  double tolerance_;
  double noise_ = volume_noise(*parent_);
  double debris_ = 0;
  std::vector<Draft> drafts_;
  std::vector<PlaneId> region_;
  std::vector<Cut> cuts_;
  ConvexPolyhedron current_, next_;
  ClipScratch scratch_;
};

}  // namespace

Intersection intersect(const AlignedPattern& pattern, const ConvexPtr& convex) {
  return Cutter(pattern, convex).run();
}

}  // namespace sunder::fracture
