// One convex polyhedron cut by a pattern. Internal to intersect.cpp and surface.cpp.
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

/// A part under way: its region of the pattern is the intersection of half-spaces.
struct Draft {
  std::uint32_t cell = CellPart::kFarCell;
  std::vector<PlaneId> region;  ///< Pattern names.
  ConvexPtr convex;             ///< The solid within the region.
  PolygonMesh visual;           ///< Of a surface convex: its mesh within the region.
  MassProperties visual_solid;  ///< Of the mesh.
  double volume_m3 = 0;         ///< Of what counts: the convex, or its visual mesh.
  bool has_grown = false;       ///< Took over a sliver since it was cut.
};

/// Cuts an internal convex into drafts that tile it.
class Cutter {
 public:
  Cutter(const AlignedPattern& pattern, const ConvexPtr& solid);

  /// Makes the drafts and settles those smaller than `floor_m3`; false if they do not add up.
  bool cut(double floor_m3);
  std::vector<Draft>& drafts() { return drafts_; }
  /// Drafts smaller than `floor_m3` go to their neighbours, the others become debris.
  void settle_slivers(double floor_m3);
  double debris_m3() const { return debris_; }
  /// The cell of the largest draft.
  std::uint32_t largest_cell() const;
  /// Parts smaller than this are slivers, if `whole_m3` is what the convex holds.
  double least_m3(double whole_m3) const;
  /// What volumes may be off by, where parts of `whole_m3` should make up the whole.
  double allowed_error_m3(double whole_m3) const;
  /// Distances that rounding cannot tell from zero.
  double tolerance_m() const { return tolerance_; }
  /// The planes of a region that cut the solid, deepest first.
  std::vector<NamedPlane> cutting_planes(const std::vector<PlaneId>& region);

 private:
  struct Cut {
    double depth;
    PlaneId id;
    bool operator<(const Cut& other) const {
      return depth != other.depth ? depth > other.depth : id < other.id;
    }
  };
  /// What is left of the solid while cells take their parts in turn.
  struct Remnant {
    ConvexPolyhedron solid;
    std::vector<PlaneId> region;
  };

  void cut_far();
  void cut_cell(std::uint32_t index);
  bool contains(const AlignedPattern::Cell& cell) const;
  bool find_cuts(const std::vector<PlaneId>& region, std::vector<Cut>& cuts) const;
  ConvexPtr clip_by(const std::vector<PlaneId>& region);
  /// A convex of the parent's material, painted as that is.
  ConvexPtr made(ConvexPolyhedron polyhedron) const;
  void add_draft(std::uint32_t cell, std::vector<PlaneId> region, ConvexPtr convex);
  bool hand_over(std::size_t sliver);
  bool take_over(std::span<const std::pair<double, std::size_t>> takers,
                 const std::vector<PlaneId>& cuts, const Draft& sliver);
  bool lies_within(const Convex& convex, const std::vector<PlaneId>& region) const;
  bool adds_up() const;
  void cut_in_turn(const std::vector<std::uint32_t>& cells, double floor_m3);
  bool take_part(Remnant& remnant, const ConvexPolyhedron& cell, std::vector<Remnant>& beyond);

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
