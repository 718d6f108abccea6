// Separating axes, eight planes or eight edges at a time.
#include "solver/rigid/collide/separation.h"

#include <cmath>

#include "solver/base/lanes.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

constexpr float kTried = -2e30f;  // less than any separation: the face is tried

Wide3 turned(const Mat3f& R, const Wide3& v) {
  return {v.x * R(0, 0) + v.y * R(0, 1) + v.z * R(0, 2),
          v.x * R(1, 0) + v.y * R(1, 1) + v.z * R(1, 2),
          v.x * R(2, 0) + v.y * R(2, 1) + v.z * R(2, 2)};
}

/// The vertex least far along a direction, and its distance along that.
struct Deepest {
  Vec3f vertex;
  float along_m = 1e30f;
};

Deepest deepest(const Vec3f& direction, const std::vector<Wide3>& vertices) {
  const Wide3 down = splat3(direction);
  Wide3 at = vertices[0];
  Wide least = dot(down, at);
  for (std::size_t c = 1; c < vertices.size(); ++c) {
    const Wide3& v = vertices[c];
    const Wide along = dot(down, v);
    const auto deeper = along < least;
    at = {deeper ? v.x : at.x, deeper ? v.y : at.y, deeper ? v.z : at.z};
    least = min(least, along);
  }
  const float along_m = min_lane(least);
  const std::uint32_t set = bits(least == splat(along_m));  // empty if it is not a number
  const auto lane = static_cast<std::uint32_t>(set != 0 ? __builtin_ctz(set) : 0);
  return {Hull::lane(at, lane), along_m};
}

struct FaceAnswer {
  std::uint32_t face = 0;
  float separation_m = -1e30f;
  Vec3f witness = Vec3f::Zero();  ///< The vertex of the other hull that is nearest to the face.
};

/// Returns the distances of a point in front of eight faces.
Wide ahead_of(const Hull::PlaneChunk& planes, const Wide3& point) {
  return dot(planes.normal, point) + planes.d;
}

/// Returns the index of the first equal number; 0 if none is, as for NaN.
std::uint32_t first_of(float number, const std::vector<Wide>& among) {
  for (std::uint32_t c = 0; c < among.size(); ++c)
    if (const std::uint32_t set = bits(among[c] == splat(number)))
      return c * kLanes + static_cast<std::uint32_t>(__builtin_ctz(set));
  return 0;
}

/// Returns the face of `hull` that has all vertices furthest in front of it. The distance of one
/// point among the vertices, such as `within`, is an upper bound for each face: the face with the
/// largest bound is tried first, and its deepest vertex excludes most others.
FaceAnswer best_face(const Hull& hull, const Vec3f& within, const std::vector<Wide3>& vertices,
                     std::vector<Wide>& at_most) {
  const auto planes = hull.planes();
  FaceAnswer best;
  const auto try_face = [&](std::uint32_t face) {
    const Deepest nearest = deepest(hull.normal(face), vertices);
    const float separation_m = nearest.along_m + hull.plane_d(face);
    if (separation_m > best.separation_m || (separation_m == best.separation_m && face < best.face))
      best = {face, separation_m, nearest.vertex};
    const Wide3 vertex = splat3(nearest.vertex);
    for (std::size_t c = 0; c < planes.size(); ++c)
      at_most[c] = min(at_most[c], ahead_of(planes[c], vertex));
    at_most[face / kLanes][face % kLanes] = kTried;
  };
  at_most.resize(planes.size());
  Wide most = splat(kTried);
  for (std::size_t c = 0; c < planes.size(); ++c) {
    at_most[c] = ahead_of(planes[c], splat3(within));
    most = max(most, at_most[c]);
  }
  const std::uint32_t first = first_of(max_lane(most), at_most);
  for (std::uint32_t f = hull.face_count(); f < planes.size() * kLanes; ++f)
    at_most[f / kLanes][f % kLanes] = kTried;
  try_face(first);
  for (std::uint32_t c = 0; c < planes.size(); ++c)
    while (const std::uint32_t open = bits(at_most[c] >= splat(best.separation_m)))
      try_face(c * kLanes + static_cast<std::uint32_t>(__builtin_ctz(open)));
  return best;
}

/// Returns the least distances of the vertices in front of eight faces.
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

/// The hull on the other side of a pair of edges: the direction `toward` its centre, and a point of
/// it.
struct Opposite {
  Vec3f toward;
  Vec3f witness;
};

/// Lists the edges of a hull that may separate it from the other hull by more than `least_m` with a
/// normal n between those of their faces. The separation is at most n·toward less `cores_m`, the
/// sum of the inner balls' radii, and at most n·(witness − edge): an edge that does not face the
/// other hull, or its deepest vertex, cannot give a better axis than the one known.
void facing_edges(const Hull& hull, const Opposite& other, float least_m, float cores_m,
                  HullScratch& scratch, std::vector<std::uint16_t>& facing) {
  const auto planes = hull.planes();
  const float least_toward_m = least_m + cores_m > 0 ? least_m + cores_m : -1e30f;
  scratch.ahead.resize(planes.size()), scratch.toward.resize(planes.size());
  for (std::size_t c = 0; c < planes.size(); ++c) {
    scratch.ahead[c] = ahead_of(planes[c], splat3(other.witness));
    scratch.toward[c] = dot(planes[c].normal, splat3(other.toward));
  }
  const auto more = [](const std::vector<Wide>& of, const Hull::Edge& edge) {
    return std::max(of[edge.left / kLanes][edge.left % kLanes],
                    of[edge.right / kLanes][edge.right % kLanes]);
  };
  facing.resize(hull.edge_count());
  std::size_t count = 0;
  for (std::uint32_t e = 0; e < hull.edge_count(); ++e) {
    const Hull::Edge& edge = hull.edges()[e];
    const float ahead_m = more(scratch.ahead, edge);
    facing[count] = static_cast<std::uint16_t>(e);
    count += (std::max(ahead_m, ahead_m * edge.bulge) > least_m) &
             (more(scratch.toward, edge) * edge.bulge > least_toward_m);
  }
  facing.resize(count);
}

/// Up to eight edges, and the normals of their faces.
struct WideEdges {
  Wide3 point, direction, left, right;
};

/// Returns up to eight listed edges of b, in A.
WideEdges edges_in_A(const Hull& b, const RelativePose& pose, const std::uint16_t* list,
                     std::uint32_t count) {
  WideEdges own{};
  for (std::uint32_t i = 0; i < count; ++i) {
    const Hull::Edge& edge = b.edges()[list[i]];
    const Vec3f from = b.vertex(edge.from);
    set_lane(own.point, i, from);
    set_lane(own.direction, i, b.vertex(edge.to) - from);
    set_lane(own.left, i, b.normal(edge.left));
    set_lane(own.right, i, b.normal(edge.right));
  }
  return {turned(pose.R, own.point) + splat3(pose.p), turned(pose.R, own.direction),
          turned(pose.R, own.left), turned(pose.R, own.right)};
}

/// Tests edge e of a against `count` edges of b, given in A, and updates `best`. Only pairs whose
/// arcs cross on the Gauss map are faces of the Minkowski difference.
void try_edges(const Hull& a, std::uint16_t e, const WideEdges& edges_b,
               const std::uint16_t* list_b, std::uint32_t count, SeparatingAxis& best) {
  const Hull::Edge& edge = a.edges()[e];
  const Vec3f point = a.vertex(edge.from), direction = a.vertex(edge.to) - point;
  const Vec3f left = a.normal(edge.left), right = a.normal(edge.right);
  const Wide3 dir_a = splat3(direction);
  const Wide b_left = dot(edges_b.left, dir_a), b_right = dot(edges_b.right, dir_a);
  const Wide a_left = dot(edges_b.direction, splat3(left));
  const Wide a_right = dot(edges_b.direction, splat3(right));
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
    if (axis.dot(left + right) < 0) axis = -axis;
    const float separation = axis.dot(Hull::lane(edges_b.point, lane) - point);
    if (separation > best.separation_m)
      best = {SeparatingAxis::Kind::kEdges, axis, separation, e, list_b[lane]};
  }
}

/// Returns the best pair of edges if its separation exceeds `least_m`. The witnesses are points of
/// the other hull, in the frame of each.
SeparatingAxis best_edges(const Hull& a, const Hull& b, const RelativePose& pose,
                          const AxisReach& reach, const Vec3f& witness_A, const Vec3f& witness_B,
                          float least_m, HullScratch& scratch) {
  SeparatingAxis best;
  best.separation_m = least_m;
  const Vec3f toward = pose.R * b.center() + pose.p - a.center();
  const float cores_m = a.core_radius_m() + b.core_radius_m();
  facing_edges(a, {toward, witness_A}, least_m, cores_m, scratch, scratch.edges_a);
  if (scratch.edges_a.empty()) return best;
  const Vec3f back = -(pose.R.transpose() * toward);
  facing_edges(b, {back, witness_B}, least_m, cores_m, scratch, scratch.edges_b);
  for (std::size_t first = 0; first < scratch.edges_b.size(); first += kLanes) {
    const auto count =
        static_cast<std::uint32_t>(std::min<std::size_t>(kLanes, scratch.edges_b.size() - first));
    const std::uint16_t* list = scratch.edges_b.data() + first;
    const WideEdges edges_b = edges_in_A(b, pose, list, count);
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
  const FaceAnswer face_a =
      best_face(a, pose.R * b.center() + pose.p, scratch.b_in_A, scratch.at_most);
  best.index_a = face_a.face;
  best.normal_A = a.normal(best.index_a);
  best.separation_m = face_a.separation_m;
  if (best.separation_m > reach.along(best.normal_A)) return best;

  const FaceAnswer face_b =
      best_face(b, pose.R.transpose() * (a.center() - pose.p), scratch.a_in_B, scratch.at_most);
  const Vec3f normal = -(pose.R * b.normal(face_b.face));
  const bool separated = face_b.separation_m > reach.along(normal);
  if (separated || face_b.separation_m > best.separation_m + tolerance_m)
    best = {SeparatingAxis::Kind::kFaceB, normal, face_b.separation_m, 0, face_b.face};
  if (separated) return best;
  const SeparatingAxis edges = best_edges(a, b, pose, reach, face_a.witness, face_b.witness,
                                          best.separation_m + tolerance_m, scratch);
  return edges.separation_m > best.separation_m + tolerance_m ? edges : best;
}

bool touch_without_area(const Hull& a, const Hull& b, const RelativePose& pose, float sliver_m,
                        const HullScratch& scratch) {
  Vec3f first = Vec3f::Zero();
  const auto two_faces_separate = [&](const Hull& hull, std::uint32_t vertex_count,
                                      const std::vector<Wide3>& vertices, const Mat3f& to_A) {
    for (std::uint32_t c = 0; c < hull.planes().size(); ++c) {
      const Wide least = in_front(hull.planes()[c], vertex_count, vertices);
      for (std::uint32_t set = bits(least > splat(-sliver_m)); set != 0; set &= set - 1) {
        const auto k = static_cast<std::uint32_t>(__builtin_ctz(set));
        const Vec3f normal_A = to_A * Hull::lane(hull.planes()[c].normal, k);
        if (first.isZero(0)) first = normal_A;
        if (first.dot(normal_A) < kMaxEdgeCosine) return true;
      }
    }
    return false;
  };
  return two_faces_separate(a, b.vertex_count(), scratch.b_in_A, Mat3f::Identity()) ||
         two_faces_separate(b, a.vertex_count(), scratch.a_in_B, -pose.R);
}

std::optional<SeparatingAxis> passing_axis(const Hull& a, const Hull& b, const RelativePose& pose,
                                           const Vec3f& displacement_A, float tolerance_m,
                                           const HullScratch& scratch) {
  std::optional<SeparatingAxis> best;
  float best_end_m = -tolerance_m;
  const auto test_faces = [&](const Hull& hull, std::uint32_t vertex_count,
                              const std::vector<Wide3>& vertices, const Vec3f& displacement,
                              SeparatingAxis::Kind kind) {
    const Wide3 along = splat3(displacement);
    for (std::uint32_t c = 0; c < hull.planes().size(); ++c) {
      const Hull::PlaneChunk& planes = hull.planes()[c];
      const Wide least = in_front(planes, vertex_count, vertices);
      const Wide end = least + dot(planes.normal, along);
      for (std::uint32_t set = bits((least >= splat(-tolerance_m)) & (end > splat(best_end_m)));
           set != 0; set &= set - 1) {
        const auto k = static_cast<std::uint32_t>(__builtin_ctz(set));
        const std::uint32_t face = c * kLanes + k;
        if (face >= hull.face_count() || !(end[k] > best_end_m)) continue;
        best_end_m = end[k];
        best = SeparatingAxis{kind, hull.normal(face), least[k], face, face};
      }
    }
  };
  test_faces(a, b.vertex_count(), scratch.b_in_A, displacement_A, SeparatingAxis::Kind::kFaceA);
  test_faces(b, a.vertex_count(), scratch.a_in_B, pose.R.transpose() * -displacement_A,
             SeparatingAxis::Kind::kFaceB);
  if (!best) return {};
  if (best->kind == SeparatingAxis::Kind::kFaceA) best->index_b = 0;
  if (best->kind == SeparatingAxis::Kind::kFaceB)
    best->index_a = 0, best->normal_A = -(pose.R * best->normal_A);
  return best;
}

float separation_along(const Vec3f& axis_A, const Hull& a, const Hull& b,
                       const RelativePose& pose) {
  const Wide3 axis_a = splat3(axis_A), axis_b = splat3(pose.R.transpose() * axis_A);
  Wide most = splat(-1e30f), least = splat(1e30f);
  for (const Wide3& vertices : a.vertices()) most = max(most, dot(axis_a, vertices));
  for (const Wide3& vertices : b.vertices()) least = min(least, dot(axis_b, vertices));
  return min_lane(least) + axis_A.dot(pose.p) - max_lane(most);
}

}  // namespace sunder::solver
