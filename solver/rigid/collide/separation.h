// Separating-axis test: the axis along which two hulls have the largest separation or the smallest
// overlap.
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "solver/rigid/body/hull.h"

namespace sunder::solver {

/// Pose of B in A, in floats: point_A = R * point_B + p.
struct RelativePose {
  Mat3f R;
  Vec3f p;
};

/// Reused memory: vertices of each hull in the other's frame, edges that face the other hull, and
/// upper bounds on the separation along faces.
struct HullScratch {
  std::vector<Wide3> b_in_A, a_in_B;
  std::vector<std::uint16_t> edges_a, edges_b;
  std::vector<Wide> at_most, ahead, toward;

  Vec3f vertex_b(std::uint32_t i) const { return Hull::lane(b_in_A[i / kLanes], i % kLanes); }
};

struct SeparatingAxis {
  enum class Kind : std::uint8_t { kFaceA, kFaceB, kEdges };
  Kind kind = Kind::kFaceA;
  Vec3f normal_A = Vec3f::UnitY();  ///< Unit normal in A, from a to b.
  float separation_m = -1e30f;      ///< Distance of the supporting planes; negative: overlap.
  std::uint32_t index_a = 0;        ///< Face or edge of a.
  std::uint32_t index_b = 0;        ///< Face or edge of b.
};

/// Separation up to which shapes have a contact: a margin, and their motion along an axis.
struct AxisReach {
  float margin_m = 0;
  Vec3f displacement_A = Vec3f::Zero();  ///< Displacement of b from a within the step, in A.

  float along(const Vec3f& axis_A) const {
    return margin_m + std::max(0.f, -axis_A.dot(displacement_A));
  }
};

/// Sets `b_in_A` of the scratch, which is enough for make_patch().
void place_in_A(const Hull& b, const RelativePose& pose, HullScratch& scratch);
/// Sets the vertices of the scratch; must be called before separating_axis().
void place_in_each_other(const Hull& a, const Hull& b, const RelativePose& pose,
                         HullScratch& scratch);
/// Returns the best axis among face normals and cross products of edges, or the first one that
/// separates the hulls by more than `reach`. A face is preferred to an edge, and a face of a to one
/// of b, unless the other is better by `tolerance_m`, so that the choice is stable from step to
/// step.
SeparatingAxis separating_axis(const Hull& a, const Hull& b, const RelativePose& pose,
                               const AxisReach& reach, float tolerance_m, HullScratch& scratch);
/// True if the hulls touch only at an edge or a corner: two faces, 60 degrees or more apart, each
/// have the other hull in front of them within `sliver_m`. The scratch must be filled.
bool touch_without_area(const Hull& a, const Hull& b, const RelativePose& pose, float sliver_m,
                        const HullScratch& scratch);
/// Returns a face of either hull that has the other hull in front of it within `tolerance_m`, now
/// and at the end of `way_A`, the displacement of b from a within the step: hulls that slide past
/// each other in contact do not collide. Of several faces, returns that with the largest final
/// separation; none has no separation. The scratch must be filled.
std::optional<SeparatingAxis> passing_axis(const Hull& a, const Hull& b, const RelativePose& pose,
                                           const Vec3f& displacement_A, float tolerance_m,
                                           const HullScratch& scratch);
/// Returns the distance of the supporting planes along an axis given in A.
float separation_along(const Vec3f& axis_A, const Hull& a, const Hull& b, const RelativePose& pose);

}  // namespace sunder::solver
