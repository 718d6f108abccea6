// Separating axes, eight planes or eight edges at a time.
#include "solver/rigid/separation.h"

#include <cmath>

namespace sunder::solver {
namespace {

Wide3 splat3(const Vec3f& v) { return {splat(v.x()), splat(v.y()), splat(v.z())}; }

Wide3 turned(const Mat3f& R, const Wide3& v) {
  return {v.x * R(0, 0) + v.y * R(0, 1) + v.z * R(0, 2),
          v.x * R(1, 0) + v.y * R(1, 1) + v.z * R(1, 2),
          v.x * R(2, 0) + v.y * R(2, 1) + v.z * R(2, 2)};
}

struct FaceAnswer {
  std::uint32_t face = 0;
  float separation_m = -1e30f;
};

/// The face of `hull` that the vertices are furthest in front of.
FaceAnswer best_face(const Hull& hull, std::uint32_t vertex_count,
                     const std::vector<Wide3>& vertices) {
  FaceAnswer best;
  const auto planes = hull.planes();
  for (std::uint32_t c = 0; c < planes.size(); ++c) {
    const Hull::PlaneChunk& plane = planes[c];
    Wide least = splat(1e30f);
    for (std::uint32_t i = 0; i < vertex_count; ++i) {
      const Wide3& v = vertices[i / kLanes];
      const std::uint32_t k = i % kLanes;
      least =
          min(least, plane.normal.x * v.x[k] + plane.normal.y * v.y[k] + plane.normal.z * v.z[k]);
    }
    least += plane.d;
    for (std::uint32_t k = 0; k < kLanes; ++k)
      if (least[k] > best.separation_m) best = {c * kLanes + k, least[k]};
  }
  return best;
}

/// Edge e of a against eight edges of b, already in A; keeps the better of `best` and the result.
/// Only pairs whose arcs cross on the Gauss map are faces of the Minkowski difference.
void try_edges(const Hull& a, std::uint32_t e, const Hull::EdgeChunk& edges_b,
               std::uint32_t first_b, std::uint32_t count_b, SeparatingAxis& best) {
  const Hull::EdgeChunk& chunk = a.edges()[e / kLanes];
  const std::uint32_t k = e % kLanes;
  const Vec3f direction = Hull::lane(chunk.direction, k);
  const Wide3 dir_a = splat3(direction);
  const Wide b_left = dot(edges_b.normal_left, dir_a), b_right = dot(edges_b.normal_right, dir_a);
  const Wide a_left = dot(edges_b.direction, splat3(Hull::lane(chunk.normal_left, k)));
  const Wide a_right = dot(edges_b.direction, splat3(Hull::lane(chunk.normal_right, k)));
  const Wide zero = splat(0);
  std::uint32_t crossing =
      bits((b_left * b_right < zero) & (a_left * a_right < zero) & (b_left * a_right < zero));
  if (first_b + kLanes > count_b) crossing &= (1u << (count_b - first_b)) - 1;
  for (; crossing != 0; crossing &= crossing - 1) {
    const auto lane = static_cast<std::uint32_t>(__builtin_ctz(crossing));
    const Vec3f direction_b = Hull::lane(edges_b.direction, lane);
    Vec3f axis = direction.cross(direction_b);
    const float square = axis.squaredNorm();
    if (square < 1e-6f * direction.squaredNorm() * direction_b.squaredNorm()) continue;
    axis /= std::sqrt(square);
    const Vec3f outward = Hull::lane(chunk.normal_left, k) + Hull::lane(chunk.normal_right, k);
    if (axis.dot(outward) < 0) axis = -axis;
    const float separation = axis.dot(Hull::lane(edges_b.point, lane) - Hull::lane(chunk.point, k));
    if (separation > best.separation_m)
      best = {SeparatingAxis::Kind::kEdges, axis, separation, e, first_b + lane};
  }
}

SeparatingAxis best_edges(const Hull& a, const Hull& b, const RelativePose& pose, float reach_m) {
  SeparatingAxis best;
  for (std::uint32_t c = 0; c < b.edges().size(); ++c) {
    const Hull::EdgeChunk& own = b.edges()[c];
    const Hull::EdgeChunk in_A = {turned(pose.R, own.point) + splat3(pose.p),
                                  turned(pose.R, own.direction), turned(pose.R, own.normal_left),
                                  turned(pose.R, own.normal_right)};
    for (std::uint32_t e = 0; e < a.edge_count(); ++e) {
      try_edges(a, e, in_A, c * kLanes, b.edge_count(), best);
      if (best.separation_m > reach_m) return best;
    }
  }
  return best;
}

}  // namespace

void place_in_each_other(const Hull& a, const Hull& b, const RelativePose& pose,
                         HullScratch& scratch) {
  scratch.b_in_A.resize(b.vertices().size());
  for (std::size_t c = 0; c < b.vertices().size(); ++c)
    scratch.b_in_A[c] = turned(pose.R, b.vertices()[c]) + splat3(pose.p);
  scratch.a_in_B.resize(a.vertices().size());
  const Mat3f back = pose.R.transpose();
  for (std::size_t c = 0; c < a.vertices().size(); ++c)
    scratch.a_in_B[c] = turned(back, a.vertices()[c] - splat3(pose.p));
}

SeparatingAxis separating_axis(const Hull& a, const Hull& b, const RelativePose& pose,
                               float reach_m, float tolerance_m, const HullScratch& scratch) {
  SeparatingAxis best;
  const FaceAnswer face_a = best_face(a, b.vertex_count(), scratch.b_in_A);
  best.index_a = std::min(face_a.face, a.face_count() - 1);
  best.normal_A = a.normal(best.index_a);
  best.separation_m = face_a.separation_m;
  if (best.separation_m > reach_m) return best;

  const FaceAnswer face_b = best_face(b, a.vertex_count(), scratch.a_in_B);
  if (face_b.separation_m > best.separation_m + tolerance_m || face_b.separation_m > reach_m) {
    const std::uint32_t face = std::min(face_b.face, b.face_count() - 1);
    best = {SeparatingAxis::Kind::kFaceB, -(pose.R * b.normal(face)), face_b.separation_m, 0, face};
    if (best.separation_m > reach_m) return best;
  }
  const SeparatingAxis edges = best_edges(a, b, pose, reach_m);
  return edges.separation_m > best.separation_m + tolerance_m ? edges : best;
}

float separation_along(const Vec3f& axis_A, const Hull& a, const HullScratch& scratch) {
  const Wide3 axis = splat3(axis_A);
  Wide most = splat(-1e30f), least = splat(1e30f);
  for (const Wide3& vertices : a.vertices()) most = max(most, dot(axis, vertices));
  for (const Wide3& vertices : scratch.b_in_A) least = min(least, dot(axis, vertices));
  float far_a = most[0], near_b = least[0];
  for (std::uint32_t i = 1; i < kLanes; ++i) {
    far_a = std::max(far_a, most[i]);
    near_b = std::min(near_b, least[i]);
  }
  return near_b - far_a;
}

}  // namespace sunder::solver
