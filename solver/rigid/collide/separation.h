// The axis along which two hulls are furthest apart, or overlap least (separating-axis test).
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "solver/rigid/body/hull.h"

namespace sunder::solver {

/// B in A, in floats: point_A = R * point_B + p.
struct RelativePose {
  Mat3f R;
  Vec3f p;
};

/// Vertices of each hull in the other's frame, edges that face the other, and how far faces may be
/// from it at most; reused memory.
struct HullScratch {
  std::vector<Wide3> b_in_A, a_in_B;
  std::vector<std::uint16_t> edges_a, edges_b;
  std::vector<Wide> at_most, ahead, toward;

  Vec3f vertex_b(std::uint32_t i) const { return Hull::lane(b_in_A[i / kLanes], i % kLanes); }
};

struct SeparatingAxis {
  enum class Kind : std::uint8_t { kFaceA, kFaceB, kEdges };
  Kind kind = Kind::kFaceA;
  Vec3f normal_A = Vec3f::UnitY();  ///< Unit, in A, from a to b.
  float separation_m = -1e30f;      ///< Distance of the supporting planes; negative: overlap.
  std::uint32_t index_a = 0;        ///< Face or edge of a.
  std::uint32_t index_b = 0;        ///< Face or edge of b.
};

/// How far apart shapes may be and still matter: a margin, and what they may close along an axis.
struct AxisReach {
  float margin_m = 0;
  Vec3f way_A = Vec3f::Zero();  ///< Of b from a within the step, in A.

  float along(const Vec3f& axis_A) const { return margin_m + std::max(0.f, -axis_A.dot(way_A)); }
};

/// Fills the vertices of b in A of the scratch; enough for make_patch().
void place_in_A(const Hull& b, const RelativePose& pose, HullScratch& scratch);
/// Fills the vertices of the scratch; to be called before separating_axis().
void place_in_each_other(const Hull& a, const Hull& b, const RelativePose& pose,
                         HullScratch& scratch);
/// The best axis over face normals and edge cross products. As soon as one parts the hulls beyond
/// `reach`, that one. A face is preferred to an edge unless the edge is better by
/// `tolerance_m`, and a's faces to b's, so that the choice stays put from step to step.
SeparatingAxis separating_axis(const Hull& a, const Hull& b, const RelativePose& pose,
                               const AxisReach& reach, float tolerance_m, HullScratch& scratch);
/// Whether the hulls touch at an edge or a corner only: two faces, 60 degrees or more apart, each
/// have the other hull in front of them but for `sliver_m`. The scratch must be filled.
bool touch_without_area(const Hull& a, const Hull& b, const RelativePose& pose, float sliver_m,
                        const HullScratch& scratch);
/// A face of either hull that the other is in front of but for `tolerance_m`, and still is at the
/// end of `way_A`, of b from a within the step: hulls that slide past each other where they touch
/// do not meet. Of several, the one that is furthest apart then; none has no separation. The
/// scratch must be filled.
std::optional<SeparatingAxis> passing_axis(const Hull& a, const Hull& b, const RelativePose& pose,
                                           const Vec3f& way_A, float tolerance_m,
                                           const HullScratch& scratch);
/// Distance of the supporting planes along an axis given in A.
float separation_along(const Vec3f& axis_A, const Hull& a, const Hull& b, const RelativePose& pose);

}  // namespace sunder::solver
