// Separating axes, eight planes or eight edges at a time.
#include "solver/rigid/collide/separation.h"

#include <cmath>

#include "solver/rigid/tolerances.h"

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

/// How far the vertices are in front of each of eight faces, at least.
Wide in_front(const Hull::PlaneChunk& plane, std::uint32_t vertex_count,
              const std::vector<Wide3>& vertices) {
  Wide least = splat(1e30f);
  for (std::uint32_t i = 0; i < vertex_count; ++i) {
    const Wide3& v = vertices[i / kLanes];
    const std::uint32_t k = i % kLanes;
    least = min(least, plane.normal.x * v.x[k] + plane.normal.y * v.y[k] + plane.normal.z * v.z[k]);
  }
  return least + plane.d;
}

/// The face of `hull` that the vertices are furthest in front of.
FaceAnswer best_face(const Hull& hull, std::uint32_t vertex_count,
                     const std::vector<Wide3>& vertices) {
  FaceAnswer best;
  const auto planes = hull.planes();
  for (std::uint32_t c = 0; c < planes.size(); ++c) {
    const Wide least = in_front(planes[c], vertex_count, vertices);
    for (std::uint32_t k = 0; k < kLanes; ++k)
      if (least[k] > best.separation_m) best = {c * kLanes + k, least[k]};
  }
  return best;
}

/// Lists the edges of a hull with a normal between their faces' that may have n·toward above
/// `least`. An axis n parts two hulls by no more than n·(distance of centres) less the balls
/// within, so edges that do not face the other hull cannot give a better axis than one known
/// already.
void facing_edges(const Hull& hull, const Vec3f& toward, float least,
                  std::vector<std::uint16_t>& facing) {
  facing.clear();
  const Wide3 direction = splat3(toward);
  for (std::uint32_t c = 0; c < hull.edges().size(); ++c) {
    const Hull::EdgeChunk& edges = hull.edges()[c];
    const Wide most = max(dot(edges.normal_left, direction), dot(edges.normal_right, direction));
    for (std::uint32_t set = bits(most * edges.bulge > splat(least)); set != 0; set &= set - 1) {
      const std::uint32_t e = c * kLanes + static_cast<std::uint32_t>(__builtin_ctz(set));
      if (e < hull.edge_count()) facing.push_back(static_cast<std::uint16_t>(e));
    }
  }
}

/// Up to eight of b's listed edges, in A.
Hull::EdgeChunk edges_in_A(const Hull& b, const RelativePose& pose, const std::uint16_t* list,
                           std::uint32_t count) {
  Hull::EdgeChunk own{};
  for (std::uint32_t i = 0; i < kLanes; ++i) {
    const std::uint32_t e = list[std::min(i, count - 1)], k = e % kLanes;
    const Hull::EdgeChunk& from = b.edges()[e / kLanes];
    auto copy = [&](Wide3& to, const Wide3& v) {
      to.x[i] = v.x[k], to.y[i] = v.y[k], to.z[i] = v.z[k];
    };
    copy(own.point, from.point);
    copy(own.direction, from.direction);
    copy(own.normal_left, from.normal_left);
    copy(own.normal_right, from.normal_right);
  }
  return {turned(pose.R, own.point) + splat3(pose.p), turned(pose.R, own.direction),
          turned(pose.R, own.normal_left), turned(pose.R, own.normal_right), own.bulge};
}

/// Edge e of a against `count` edges of b, already in A; keeps the better of `best` and the result.
/// Only pairs whose arcs cross on the Gauss map are faces of the Minkowski difference.
void try_edges(const Hull& a, std::uint16_t e, const Hull::EdgeChunk& edges_b,
               const std::uint16_t* list_b, std::uint32_t count, SeparatingAxis& best) {
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
  if (count < kLanes) crossing &= (1u << count) - 1;
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
      best = {SeparatingAxis::Kind::kEdges, axis, separation, e, list_b[lane]};
  }
}

/// The best pair of edges, if one is better than `least_m`.
SeparatingAxis best_edges(const Hull& a, const Hull& b, const RelativePose& pose,
                          const AxisReach& reach, float least_m, HullScratch& scratch) {
  SeparatingAxis best;
  best.separation_m = least_m;
  const Vec3f toward = pose.R * b.center() + pose.p - a.center();
  float least = least_m + a.core_radius_m() + b.core_radius_m();
  if (least <= 0) least = -1e30f;
  facing_edges(a, toward, least, scratch.edges_a);
  if (scratch.edges_a.empty()) return best;
  facing_edges(b, -(pose.R.transpose() * toward), least, scratch.edges_b);
  for (std::size_t first = 0; first < scratch.edges_b.size(); first += kLanes) {
    const auto count =
        static_cast<std::uint32_t>(std::min<std::size_t>(kLanes, scratch.edges_b.size() - first));
    const std::uint16_t* list = scratch.edges_b.data() + first;
    const Hull::EdgeChunk edges_b = edges_in_A(b, pose, list, count);
    for (const std::uint16_t e : scratch.edges_a) try_edges(a, e, edges_b, list, count, best);
    if (best.separation_m > reach.along(best.normal_A)) return best;
  }
  return best;
}

}  // namespace

void place_in_A(const Hull& b, const RelativePose& pose, HullScratch& scratch) {
  scratch.b_in_A.resize(b.vertices().size());
  for (std::size_t c = 0; c < b.vertices().size(); ++c)
    scratch.b_in_A[c] = turned(pose.R, b.vertices()[c]) + splat3(pose.p);
}

void place_in_each_other(const Hull& a, const Hull& b, const RelativePose& pose,
                         HullScratch& scratch) {
  place_in_A(b, pose, scratch);
  scratch.a_in_B.resize(a.vertices().size());
  const Mat3f back = pose.R.transpose();
  for (std::size_t c = 0; c < a.vertices().size(); ++c)
    scratch.a_in_B[c] = turned(back, a.vertices()[c] - splat3(pose.p));
}

SeparatingAxis separating_axis(const Hull& a, const Hull& b, const RelativePose& pose,
                               const AxisReach& reach, float tolerance_m, HullScratch& scratch) {
  SeparatingAxis best;
  const FaceAnswer face_a = best_face(a, b.vertex_count(), scratch.b_in_A);
  best.index_a = std::min(face_a.face, a.face_count() - 1);
  best.normal_A = a.normal(best.index_a);
  best.separation_m = face_a.separation_m;
  if (best.separation_m > reach.along(best.normal_A)) return best;

  const FaceAnswer face_b = best_face(b, a.vertex_count(), scratch.a_in_B);
  const std::uint32_t face = std::min(face_b.face, b.face_count() - 1);
  const Vec3f normal = -(pose.R * b.normal(face));
  const bool parted = face_b.separation_m > reach.along(normal);
  if (parted || face_b.separation_m > best.separation_m + tolerance_m)
    best = {SeparatingAxis::Kind::kFaceB, normal, face_b.separation_m, 0, face};
  if (parted) return best;
  const SeparatingAxis edges =
      best_edges(a, b, pose, reach, best.separation_m + tolerance_m, scratch);
  return edges.separation_m > best.separation_m + tolerance_m ? edges : best;
}

bool touch_without_area(const Hull& a, const Hull& b, const RelativePose& pose, float sliver_m,
                        const HullScratch& scratch) {
  Vec3f first = Vec3f::Zero();
  const auto two_part = [&](const Hull& hull, std::uint32_t vertex_count,
                            const std::vector<Wide3>& vertices, const Mat3f& to_A) {
    for (std::uint32_t c = 0; c < hull.planes().size(); ++c) {
      const Wide least = in_front(hull.planes()[c], vertex_count, vertices);
      for (std::uint32_t set = bits(least > splat(-sliver_m)); set != 0; set &= set - 1) {
        const auto k = static_cast<std::uint32_t>(__builtin_ctz(set));
        const Vec3f normal_A = to_A * Hull::lane(hull.planes()[c].normal, k);
        if (first.isZero(0)) first = normal_A;
        if (first.dot(normal_A) < kApart) return true;
      }
    }
    return false;
  };
  return two_part(a, b.vertex_count(), scratch.b_in_A, Mat3f::Identity()) ||
         two_part(b, a.vertex_count(), scratch.a_in_B, -pose.R);
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
