#include "fracture/cut/cutter.h"

#include <algorithm>
#include <cmath>

#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

constexpr double kVolumeError = 1e-12;  // Relative; a larger error is a failure.

double farthest_coordinate(const Convex& convex) {
  return std::max(convex.box.min.cwiseAbs().maxCoeff(), convex.box.max.cwiseAbs().maxCoeff());
}

/// Returns the distance below which rounding errors dominate.
double tolerance_of(const Convex& convex) { return 4e-15 * farthest_coordinate(convex); }

/// Returns the volume error caused by rounding of vertices, besides the relative error.
double volume_noise(const Convex& convex) {
  const Vec3 extent = convex.box.extent();
  const double area = extent.x() * extent.y() + extent.y() * extent.z() + extent.z() * extent.x();
  return 4e-16 * farthest_coordinate(convex) * area;
}

double area_in(const ConvexPolyhedron& shape, PlaneId name) {
  double area = 0;
  for (std::size_t f = 0; f < shape.faces.size(); ++f) {
    if (shape.faces[f].id == name) area += face_area(shape, f);
  }
  return area;
}

/// Returns true if some plane separates two regions.
bool are_separated(const std::vector<PlaneId>& a, const std::vector<PlaneId>& b) {
  return std::any_of(a.begin(), a.end(), [&](PlaneId id) {
    return std::find(b.begin(), b.end(), id.opposite()) != b.end();
  });
}

}  // namespace

Cutter::Cutter(const AlignedPattern& pattern, const ConvexPtr& solid)
    : pattern_(pattern),
      parent_(solid),
      tolerance_(tolerance_of(*solid)),
      noise_(volume_noise(*solid)) {}

bool Cutter::cut(double floor_m3) {
  cut_outside_box();
  std::vector<std::uint32_t> cells;
  pattern_.overlapping(parent_->box, cells);
  for (const std::uint32_t cell : cells) cut_cell(cell);
  merge_slivers(floor_m3);
  if (!adds_up()) cut_successively(cells, floor_m3);
  return adds_up();
}

void Cutter::add_draft(std::uint32_t cell, std::vector<PlaneId> region, ConvexPtr convex) {
  const double volume = convex->solid.volume_m3;
  drafts_.push_back({cell, std::move(region), std::move(convex), {}, {}, volume, false});
}

/// Makes drafts of the space outside the pattern's box, one slab per plane of the box.
void Cutter::cut_outside_box() {
  std::vector<PlaneId> region;
  for (std::uint32_t i = 0; i < Pattern::kBoxPlanes; ++i) {
    region.push_back(pattern_plane(i, true));
    if (ConvexPtr convex = clip_by(region)) {
      add_draft(CellPart::kFarCell, region, std::move(convex));
    }
    region.back() = pattern_plane(i, false);
  }
}

void Cutter::cut_cell(std::uint32_t index) {
  const AlignedPattern::Cell& cell = pattern_.cells[index];
  const ConvexPolyhedron& shape = pattern_.pattern->cells[cell.index].polyhedron;
  region_.clear();
  for (const ConvexPolyhedron::Face& face : shape.faces) region_.push_back(face.id);
  ConvexPtr convex = contains(cell) ? make_part(pattern_.polyhedron(cell)) : clip_by(region_);
  if (convex) add_draft(index, region_, std::move(convex));
}

/// Returns true if the cell lies strictly inside the parent.
bool Cutter::contains(const AlignedPattern::Cell& cell) const {
  if ((cell.box.min.array() <= parent_->box.min.array()).any()) return false;
  if ((cell.box.max.array() >= parent_->box.max.array()).any()) return false;
  for (const ConvexPolyhedron::Face& face : parent_->polyhedron.faces) {
    for (const Vec3& vertex : pattern_.cell_vertices(cell)) {
      if (face.plane.distance(vertex) >= -tolerance_) return false;
    }
  }
  return true;
}

/// Finds the planes of a region that cut the parent, deepest first; returns false if it is outside.
bool Cutter::find_cuts(const std::vector<PlaneId>& region, std::vector<Cut>& cuts) const {
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

ConvexPtr Cutter::make_part(ConvexPolyhedron polyhedron) const {
  return make_convex(std::move(polyhedron), parent_->material, nullptr, parent_->X_RT);
}

/// Returns the parent within a region: null if nothing is there, the parent itself if it is whole.
ConvexPtr Cutter::clip_by(const std::vector<PlaneId>& region) {
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
  return from == &current_ ? make_part(current_) : parent_;
}

std::uint32_t Cutter::largest_cell() const {
  std::uint32_t cell = CellPart::kFarCell;
  double largest = 0;
  for (const Draft& draft : drafts_) {
    if (draft.volume_m3 <= largest) continue;
    largest = draft.volume_m3;
    cell = draft.cell;
  }
  return cell;
}

std::vector<NamedPlane> Cutter::cutting_planes(const std::vector<PlaneId>& region) {
  std::vector<NamedPlane> planes;
  if (!find_cuts(region, cuts_)) return planes;
  for (const Cut& cut : cuts_) planes.push_back({pattern_.plane(cut.id), pattern_.name(cut.id)});
  return planes;
}

double Cutter::min_part_m3(double whole_m3) const {
  const double unit = pattern_.placement.linear.determinant();
  return kMinPartVolume * std::min(whole_m3, unit);
}

double Cutter::allowed_error_m3(double whole_m3) const { return kVolumeError * whole_m3 + noise_; }

void Cutter::merge_slivers(double floor_m3) {
  for (std::size_t i = 0; i < drafts_.size();) {
    if (drafts_[i].volume_m3 >= floor_m3 || drafts_.size() == 1) {
      ++i;
      continue;
    }
    if (!merge_sliver(i)) debris_ += std::max(0.0, drafts_[i].volume_m3);
    drafts_.erase(drafts_.begin() + static_cast<std::ptrdiff_t>(i));
  }
}

/// Merges a sliver into its neighbours by not making the cuts towards it: into the one behind its
/// largest cut if that takes all of it, otherwise into all of them.
bool Cutter::merge_sliver(std::size_t sliver) {
  const Draft& draft = drafts_[sliver];
  std::vector<std::pair<double, std::size_t>> neighbours;  // Negative area of the cut, and draft.
  std::vector<PlaneId> cuts(drafts_.size());
  for (const PlaneId id : draft.region) {
    const double area = area_in(draft.convex->polyhedron, pattern_.name(id));
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
    if (extend_over(std::span(&neighbour, 1), cuts, draft)) return true;
  }
  return neighbours.size() > 1 && extend_over(neighbours, cuts, draft);
}

/// Extends drafts beyond their cuts towards a sliver; returns false unless they gain exactly the
/// sliver, and no part of it twice.
bool Cutter::extend_over(std::span<const std::pair<double, std::size_t>> receivers,
                         const std::vector<PlaneId>& cuts, const Draft& sliver) {
  std::vector<Draft> grown;
  double missing = sliver.convex->solid.volume_m3;
  for (const auto& [area, receiver] : receivers) {
    Draft draft = drafts_[receiver];
    std::replace(draft.region.begin(), draft.region.end(), cuts[receiver],
                 cuts[receiver].opposite());
    const ConvexPtr gain = clip_by(draft.region);
    if (gain && !lies_within(*gain, sliver.region)) return false;
    for (const Draft& other : grown) {
      if (!are_separated(draft.region, other.region)) return false;
    }
    missing -= gain ? gain->solid.volume_m3 : 0;
    std::erase(draft.region, cuts[receiver].opposite());
    draft.convex = clip_by(draft.region);
    draft.volume_m3 += draft.convex->solid.volume_m3 - drafts_[receiver].convex->solid.volume_m3;
    draft.has_grown = true;
    grown.push_back(std::move(draft));
  }
  if (std::abs(missing) > 0.1 * allowed_error_m3(parent_->solid.volume_m3)) return false;
  for (std::size_t i = 0; i < receivers.size(); ++i)
    drafts_[receivers[i].second] = std::move(grown[i]);
  return true;
}

bool Cutter::lies_within(const Convex& convex, const std::vector<PlaneId>& region) const {
  for (const PlaneId id : region) {
    const Plane plane = pattern_.plane(id);
    for (const Vec3& vertex : convex.polyhedron.vertices) {
      if (plane.distance(vertex) > 4 * tolerance_) return false;
    }
  }
  return true;
}

bool Cutter::adds_up() const {
  double sum = debris_;
  for (const Draft& draft : drafts_) sum += draft.convex->solid.volume_m3;
  const double whole = parent_->solid.volume_m3;
  return !drafts_.empty() && std::abs(sum - whole) <= allowed_error_m3(whole);
}

/// Cuts by cells that do not tile exactly (rounded files): each cell takes its part of what the
/// cells before it left, so that every cut has two sides and no volume is lost. Cuts pass through
/// the whole remnant, which makes more parts than there are cells.
void Cutter::cut_successively(const std::vector<std::uint32_t>& cells, double floor_m3) {
  drafts_.clear();
  debris_ = 0;
  std::vector<Remnant> left{{parent_->polyhedron, {}}}, beyond;
  const auto take = [&](std::uint32_t cell, Remnant& part) {
    add_draft(cell, std::move(part.region), make_part(std::move(part.solid)));
  };
  for (const std::uint32_t index : cells) {
    const ConvexPolyhedron& cell = pattern_.pattern->cells[pattern_.cells[index].index].polyhedron;
    beyond.clear();
    for (Remnant& remnant : left) {
      if (split_remnant(remnant, cell, beyond)) take(index, remnant);
    }
    std::swap(left, beyond);
  }
  for (Remnant& remnant : left) take(CellPart::kFarCell, remnant);
  merge_slivers(floor_m3);
}

/// Cuts a remnant to its part in a cell, the rest goes to `beyond`; returns false if none is
/// inside.
bool Cutter::split_remnant(Remnant& remnant, const ConvexPolyhedron& cell,
                           std::vector<Remnant>& beyond) {
  const std::size_t before = beyond.size();
  current_ = remnant.solid;
  region_ = remnant.region;
  for (const ConvexPolyhedron::Face& face : cell.faces) {
    const Plane plane = pattern_.plane(face.id);
    const PlaneId name = pattern_.name(face.id);
    const PlaneSide side = clip(current_, plane, name, tolerance_, next_, scratch_);
    if (side == PlaneSide::kInside) continue;
    if (side == PlaneSide::kOutside) {
      beyond.resize(before);
      beyond.push_back(std::move(remnant));
      return false;
    }
    Remnant& outside = beyond.emplace_back(Remnant{{}, region_});
    clip(current_, plane.flipped(), name.opposite(), tolerance_, outside.solid, scratch_);
    outside.region.push_back(face.id.opposite());
    region_.push_back(face.id);
    std::swap(current_, next_);
  }
  remnant = {current_, region_};
  return true;
}

}  // namespace sunder::fracture
