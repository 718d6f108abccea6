// Contact patch of two hulls along a given axis: clipped faces or a pair of edges, reduced to four
// points.
#pragma once

#include <vector>

#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/collide/separation.h"

namespace sunder::solver {

/// Candidate for a contact point, in A.
struct PatchPoint {
  Vec3f on_a, on_b;
  float separation_m = 0;
  std::uint32_t feature = 0;
};

struct PatchScratch {
  struct Corner {
    Vec3f position;
    std::uint32_t feature;
  };
  std::vector<Corner> polygon, clipped;
  std::vector<Vec3f> reference;
  std::vector<float> ahead;  ///< Distance of the polygon's corners beyond a side.
};

/// Appends the points of the patch with a separation of at most `reach_m`.
void make_patch(const Hull& a, const Hull& b, const RelativePose& pose, const SeparatingAxis& axis,
                float reach_m, const HullScratch& hulls, PatchScratch& scratch,
                std::vector<PatchPoint>& points);

/// Appends the points of the faces that two edges swing together: the two faces that most face each
/// other along the axis of the edges, unless both are steep to it.
void add_faces_at_edges(const Hull& a, const Hull& b, const RelativePose& pose,
                        const SeparatingAxis& edges, float reach_m, const HullScratch& hulls,
                        PatchScratch& scratch, std::vector<PatchPoint>& points);

/// Keeps at most four points: the deepest, and those that span the largest area with it. Points
/// more than `layer_m` above the deepest count only if fewer than four are below that: a piece
/// would tip onto a deep point that was left out. All points that overlap count if the deepest does
/// so by more than twice the layer: a thin plate that is held at one edge rocks and stays buried.
void reduce_patch(const Vec3f& normal_A, float layer_m, std::vector<PatchPoint>& points);

}  // namespace sunder::solver
