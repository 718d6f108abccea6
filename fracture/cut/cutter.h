// Cuts one convex polyhedron by a pattern. Internal to intersect.cpp and surface.cpp.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "engine/geometry/clip.h"
#include "engine/geometry/split_mesh.h"
#include "fracture/cut/cell_part.h"
#include "fracture/pattern/align.h"

namespace sunder::fracture {

/// A part under construction; its region of the pattern is an intersection of half-spaces.
struct Draft {
  std::uint32_t cell = CellPart::kFarCell;
  std::vector<PlaneId> region;  ///< Half-spaces, by ids within the pattern.
  ConvexPtr convex;             ///< The polyhedron within the region.
  PolygonMesh visual;           ///< Visual mesh within the region; empty for an internal convex.
  MassProperties visual_solid;  ///< Mass properties of the mesh.
  double volume_m3 = 0;         ///< Volume of the mesh if there is one, else of the convex.
  bool has_grown = false;       ///< A sliver was added since the last cut.
};

/// Cuts an internal convex into drafts that tile it.
class Cutter {
 public:
  Cutter(const AlignedPattern& pattern, const ConvexPtr& solid);

  /// Makes the drafts and merges slivers below `floor_m3`; returns false if volumes do not add up.
  bool cut(double floor_m3);
  std::vector<Draft>& drafts() { return drafts_; }
  /// Merges drafts below `floor_m3` into neighbours; those that fit none become debris.
  void merge_slivers(double floor_m3);
  double debris_m3() const { return debris_; }
  /// Returns the cell of the largest draft.
  std::uint32_t largest_cell() const;
  /// Returns the least volume of a part of a convex of volume `whole_m3`; less is a sliver.
  double min_part_m3(double whole_m3) const;
  /// Returns the tolerance for the sum of the volumes of parts of a convex of volume `whole_m3`.
  double allowed_error_m3(double whole_m3) const;
  /// Returns the distance below which rounding errors dominate.
  double tolerance_m() const { return tolerance_; }
  /// Returns the planes of a region that cut the polyhedron, deepest first.
  std::vector<NamedPlane> cutting_planes(const std::vector<PlaneId>& region);

 private:
  struct Cut {
    double depth;
    PlaneId id;
    bool operator<(const Cut& other) const {
      return depth != other.depth ? depth > other.depth : id < other.id;
    }
  };
  /// The rest of the polyhedron while cells are cut from it one after the other.
  struct Remnant {
    ConvexPolyhedron solid;
    std::vector<PlaneId> region;
  };

  void cut_outside_box();
  void cut_cell(std::uint32_t index);
  bool contains(const AlignedPattern::Cell& cell) const;
  bool find_cuts(const std::vector<PlaneId>& region, std::vector<Cut>& cuts) const;
  ConvexPtr clip_by(const std::vector<PlaneId>& region);
  /// Returns a convex with the parent's material and texture frame.
  ConvexPtr make_part(ConvexPolyhedron polyhedron) const;
  void add_draft(std::uint32_t cell, std::vector<PlaneId> region, ConvexPtr convex);
  bool merge_sliver(std::size_t sliver);
  bool extend_over(std::span<const std::pair<double, std::size_t>> receivers,
                   const std::vector<PlaneId>& cuts, const Draft& sliver);
  bool lies_within(const Convex& convex, const std::vector<PlaneId>& region) const;
  bool adds_up() const;
  void cut_successively(const std::vector<std::uint32_t>& cells, double floor_m3);
  bool split_remnant(Remnant& remnant, const ConvexPolyhedron& cell, std::vector<Remnant>& beyond);

  const AlignedPattern& pattern_;
  const ConvexPtr& parent_;
  double tolerance_;
  double noise_;
  double debris_ = 0;
  std::vector<Draft> drafts_;
  std::vector<PlaneId> region_;
  std::vector<Cut> cuts_;
  ConvexPolyhedron current_, next_;
  ClipScratch scratch_;
};

}  // namespace sunder::fracture
