// Collision of each pair of shape kinds, reuse of manifolds, and time of impact.
#include "solver/rigid/collide/narrow_phase.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "solver/base/lanes.h"
#include "solver/base/prefetch.h"
#include "solver/rigid/collide/facet.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

constexpr float kRounding = 5e-7f;  // relative error of a length in floats
constexpr float kNoPoint = -1e30f;  // a reach that no point is within
constexpr int kImpactRounds = 24;

using Kind = ShapeDesc::Kind;

/// Two shapes to be tested at several relative poses.
struct Probe {
  const Shape& a;
  const Shape& b;
  float size_m;
  NarrowScratch& scratch;

  SeparatingAxis axis(const RelativePose& pose, const AxisReach& reach) const {
    if (a.kind == Kind::kHull && b.kind == Kind::kHull) {
      place_in_each_other(a.hull, b.hull, pose, scratch.hulls);
      return separating_axis(a.hull, b.hull, pose, reach, 0.5f * kAxisPreference * size_m,
                             scratch.hulls);
    }
    const Vec3f center_b = pose.R * b.center + pose.p;
    SeparatingAxis axis;
    if (a.kind == Kind::kHull) {
      const HullDistance d = distance_to_hull(a.hull, center_b);
      axis.normal_A = d.normal, axis.separation_m = d.distance_m - b.radius_m;
    } else {
      const Vec3f gap = center_b - a.center;
      const float distance = gap.norm();
      if (distance > 0) axis.normal_A = gap / distance;
      axis.separation_m = distance - a.radius_m - b.radius_m;
    }
    return axis;
  }

  /// Returns the axis along which hulls in contact slide past each other, if there is one and they
  /// would collide along the best axis.
  std::optional<SeparatingAxis> passing(const RelativePose& pose, const SeparatingAxis& best,
                                        const Vec3f& displacement_A) const {
    if (a.kind != Kind::kHull || b.kind != Kind::kHull) return {};
    const float tolerance_m = kPassingOverlap * size_m;
    if (best.separation_m + best.normal_A.dot(displacement_A) >= -tolerance_m) return {};
    return passing_axis(a.hull, b.hull, pose, displacement_A, tolerance_m, scratch.hulls);
  }

  /// Finds the points within `reach_m`; also those of faces that an impact at an edge will swing
  /// together, if `swings`.
  void points(const RelativePose& pose, const SeparatingAxis& axis, float reach_m, float layer_m,
              bool swings) const {
    scratch.points.clear();
    if (a.kind == Kind::kHull && b.kind == Kind::kHull) {
      make_patch(a.hull, b.hull, pose, axis, reach_m, scratch.hulls, scratch.patch, scratch.points);
      if (swings && axis.kind == SeparatingAxis::Kind::kEdges)
        add_faces_at_edges(a.hull, b.hull, pose, axis, reach_m, scratch.hulls, scratch.patch,
                           scratch.points);
      reduce_patch(axis.normal_A, layer_m, scratch.points);
    } else {
      const Vec3f on_b = pose.R * b.center + pose.p - b.radius_m * axis.normal_A;
      scratch.points.push_back(
          {on_b - axis.separation_m * axis.normal_A, on_b, axis.separation_m, 0});
    }
  }
};

/// Motion of two shapes within a step at their present velocities.
struct Flight {
  const Probe& probe;
  const Pair& pair;
  const Bodies& bodies;
  const PairMotion& motion;
  bool turning;        ///< The shapes turn by an angle that counts.
  float spin_m_s = 0;  ///< Maximum speed of any point by rotation.
  float dt_s = 0;

  Moment at(float time_s) const { return moment_at(time_s, turning, pair, bodies, motion); }
  Vec3f velocity_A(const Moment& moment) const {
    return moment.R_WA.transpose() * motion.velocity_W;
  }
  /// Speed by which a gap along an axis can close.
  float closing_m_s(const Moment& moment, const Vec3f& normal_A) const {
    return spin_m_s - normal_A.dot(velocity_A(moment));
  }
  /// Moves `moment` on until the shapes come within `target_m`, or the step ends; returns false if
  /// they do not come within it. Conservative advancement: a step by the gap along a separating
  /// axis never overshoots. `axis` is the best axis at the moment, before and after.
  bool to_impact(float target_m, Moment& moment, SeparatingAxis& axis) const {
    for (int round = 0; round < kImpactRounds && axis.separation_m > target_m; ++round) {
      const float closing = closing_m_s(moment, axis.normal_A);
      if (closing <= 0) return false;
      const float time = moment.time_s + (axis.separation_m - 0.5f * target_m) / closing;
      if (time > dt_s) return false;
      moment = at(time);
      const float left_s = dt_s - time;
      axis = probe.axis(moment.pose, {target_m + left_s * spin_m_s, left_s * velocity_A(moment)});
    }
    return true;
  }
};

struct Reach {
  float margin_m;        ///< Margin at any motion.
  float spin_m;          ///< Maximum motion by rotation within the step.
  float displacement_m;  ///< Maximum motion by translation within the step.

  float all_m() const { return margin_m + spin_m + displacement_m; }
};

void half_space_contact(const Shape& a, const Shape& b, const Pair& pair, const Bodies& bodies,
                        const PairMotion& motion, const Reach& reach, Manifold& m,
                        NarrowScratch& scratch) {
  const Quat& q_a = bodies.rotation[pair.body_a];
  const Vec3 normal_W = q_a * a.normal.cast<double>();
  const Vec3 surface_W = bodies.position[pair.body_a] + q_a * a.center.cast<double>();
  const auto height = static_cast<float>(normal_W.dot(bodies.position[pair.body_b] - surface_W));
  const Vec3f normal_B = bodies.rotation_f[pair.body_b].transpose() * normal_W.cast<float>();
  auto& points = scratch.points;
  points.clear();
  auto add = [&](const Vec3f& point_B, std::uint32_t feature) {
    const float separation = height + normal_B.dot(point_B);
    if (separation > reach.all_m()) return;
    const Vec3f on_b = motion.pose.R * point_B + motion.pose.p;
    points.push_back({on_b - separation * a.normal, on_b, separation, feature});
  };
  if (b.kind == Kind::kHull) {
    for (std::uint32_t v = 0; v < b.hull.vertex_count(); ++v) add(b.hull.vertex(v), v);
    reduce_patch(a.normal, kDepthTolerance * m.size_m + reach.spin_m, points);
  } else {
    add(b.center - b.radius_m * normal_B, 0);
  }
  build_manifold(pair, bodies, motion, a.normal, points, present_moment(pair, bodies, motion),
                 kNoPoint, m);
}

/// Returns the distance of the farthest point of a shape from an axis through the body's centre.
float reach_from_axis(const Shape& shape, const Vec3f& axis_B) {
  if (shape.kind != Kind::kHull) return shape.reach_m;
  const Wide3 axis = splat3(axis_B);
  Wide most = splat(0);
  for (const Wide3& v : shape.hull.vertices()) {
    const Wide along = dot(axis, v);
    most = max(most, dot(v, v) - along * along);
  }
  return std::sqrt(max_lane(most));
}

/// Returns the maximum motion of any point of a shape by rotation, to within `tolerance_m` more.
float spin_reach(const Shape& shape, const Bodies& bodies, double dt_s, float tolerance_m) {
  const Vec3& spin_W = bodies.angular_velocity[shape.body];
  const double spin = spin_W.norm();
  const auto angle = static_cast<float>(std::min(1., spin * dt_s));
  if (shape.kind == Kind::kSphere) return angle * shape.center.norm();  // a ball is round
  const float most_m = angle * shape.reach_m;
  if (most_m <= tolerance_m) return most_m;
  const Vec3f axis_W = (spin_W / spin).cast<float>();
  return angle * reach_from_axis(shape, bodies.rotation_f[shape.body].transpose() * axis_W);
}

Reach reach_of(const Shape& a, const Shape& b, const Bodies& bodies, const PairMotion& motion,
               const StepContext& step, float size_m) {
  const auto dt = static_cast<float>(step.dt_s);
  const float tolerance_m = kDepthTolerance * size_m;
  return {
      kContactMargin * size_m + step.fall_m,
      spin_reach(a, bodies, step.dt_s, tolerance_m) + spin_reach(b, bodies, step.dt_s, tolerance_m),
      dt * motion.velocity_W.norm()};
}

/// Axis and time of a collision.
struct Collision {
  SeparatingAxis axis;
  float time_s = 0;  ///< Time of impact, if the shapes are tested there; negative: none.
};

/// Returns the collision with the front of a facet as a plane, for use where its surface continues:
/// edges within the surface then have no effect. Shapes behind the back do not collide.
Collision collide_with_front(const Shape& a, const Shape& b, const RelativePose& start,
                             const Vec3f& velocity_A, float margin_m, float dt_s) {
  const Vec3f center_A = start.R * b.center + start.p;
  if (!before_back(a.hull, center_A)) return {{}, -1};
  const Vec3f normal = a.hull.normal(0);
  const float separation_m = b.kind == Kind::kHull
                                 ? separation_along(normal, a.hull, b.hull, start)
                                 : normal.dot(center_A) + a.hull.plane_d(0) - b.radius_m;
  const float closing = -normal.dot(velocity_A);
  Collision collision{front_axis(a.hull, separation_m)};
  if (separation_m <= margin_m) return collision;
  collision.time_s = closing > 0 ? (separation_m - 0.5f * margin_m) / closing : dt_s;
  if (!(collision.time_s < dt_s)) return {{}, -1};
  collision.axis.separation_m -= collision.time_s * closing;
  return collision;
}

/// Keeps those points against a facet's front that are on the facet. A fast shape may slide onto it
/// within the step, over a neighbour that it touches first.
void keep_on_front(const Shape& facet, float size_m, bool fast, std::vector<PatchPoint>& points) {
  const float tolerance_m = kFacetTolerance * size_m, deepest_m = -depth_m(facet.hull);
  std::erase_if(points, [&](const PatchPoint& point) {
    return point.separation_m < deepest_m || !over_triangle(facet, point.on_a, tolerance_m, fast);
  });
}

void make_contact(const Shape& a, const Shape& b, const Bodies& bodies, const PairMotion& motion,
                  const Reach& reach, double dt_s, Pair& pair, Manifold& m,
                  NarrowScratch& scratch) {
  const Probe probe{a, b, m.size_m, scratch};
  const auto dt = static_cast<float>(dt_s);
  Flight flight{probe, pair, bodies, motion, false, reach.spin_m / dt, dt};
  Moment moment = present_moment(pair, bodies, motion);
  const Vec3f velocity_A = flight.velocity_A(moment);
  const AxisReach axis_reach{reach.margin_m + reach.spin_m, dt * velocity_A};
  SeparatingAxis axis = probe.axis(moment.pose, axis_reach);
  const bool may_touch = axis.separation_m <= axis_reach.along(axis.normal_A);
  // The normal of balls depends on where they touch.
  const float casting_motion = b.kind == Kind::kSphere ? kBallCastingMotion : kCastingMotion;
  const bool fast = may_touch && reach.displacement_m > casting_motion * m.size_m;
  const std::optional<SeparatingAxis> passing =
      fast ? probe.passing(moment.pose, axis, dt * velocity_A) : std::nullopt;
  bool meet = may_touch;
  if (passing) {
    axis = *passing;
  } else if (fast) {
    flight.turning = !a.facet && reach.spin_m > kTurningMotion * m.size_m;
    meet = flight.to_impact(reach.margin_m, moment, axis);
    // The normal of a ball turns until it touches, or is past an edge.
    if (meet && b.kind == Kind::kSphere) {
      SeparatingAxis touching = axis;
      Moment touch = moment;
      const bool touches = flight.to_impact(kBallImpactGap * m.size_m, touch, touching);
      if (!touches || moment.time_s > 0) axis = touching, moment = touch;
    }
  }
  const bool by_front = meet && a.facet && !normal_to_surface(a, axis.normal_A);
  if (by_front) {
    const Collision front =
        collide_with_front(a, b, motion.pose, velocity_A, reach.margin_m + reach.spin_m, dt);
    axis = front.axis, meet = front.time_s >= 0;
    moment = flight.at(std::max(0.f, front.time_s));
    if (meet && b.kind == Kind::kHull) place_in_A(b.hull, moment.pose, scratch.hulls);
  }
  const bool swings = fast && !passing;
  const float left_s = dt - moment.time_s, spin_m = left_s * flight.spin_m_s;
  const float closing_m = left_s * std::max(0.f, -axis.normal_A.dot(flight.velocity_A(moment)));
  const float swing_m = swings ? kSwing * closing_m : 0;
  const float limit = reach.margin_m + spin_m + std::max(closing_m, swing_m);
  scratch.points.clear();
  if (meet && axis.separation_m <= limit) {
    probe.points(moment.pose, axis, limit, kDepthTolerance * m.size_m + spin_m + swing_m, swings);
    if (by_front) keep_on_front(a, m.size_m, moment.time_s > 0, scratch.points);
  }
  const bool now = moment.time_s == 0;
  pair.clearance_m = now && scratch.points.empty() ? axis.separation_m : -1;
  pair.axis_A = pair.clearance_m > 0 ? axis.normal_A : Vec3f(Vec3f::Zero());
  m.normal_on_b = axis.kind == SeparatingAxis::Kind::kFaceB;
  m.reusable = a.kind == Kind::kHull && b.kind == Kind::kHull && now;
  build_manifold(
      pair, bodies, motion, axis.normal_A, scratch.points, moment,
      reach.spin_m + reach.displacement_m < kKeptPointMotion * m.size_m ? limit : kNoPoint, m);
}

/// True if the last separating axis of the pair still separates it; sets the clearance.
bool still_separated(const Shape& a, const Shape& b, const PairMotion& motion,
                     const AxisReach& reach, Pair& pair) {
  if (pair.axis_A.isZero(0) || b.kind != Kind::kHull || a.kind != Kind::kHull) return false;
  const float separation_m = separation_along(pair.axis_A, a.hull, b.hull, motion.pose);
  if (separation_m <= reach.along(pair.axis_A)) return false;
  pair.clearance_m = separation_m;
  return true;
}

/// True if the pair is new, hardly moves and touches only at an edge, as most neighbours in a grid
/// do: it gets no contact until it has moved by kEdgeOverlap.
bool edges_at_rest(const Shape& a, const Shape& b, const PairMotion& motion, const Reach& reach,
                   float size_m, Pair& pair, NarrowScratch& scratch) {
  const float sliver_m = kEdgeOverlap * size_m;
  if (a.kind != Kind::kHull || b.kind != Kind::kHull ||
      reach.spin_m + reach.displacement_m > sliver_m)
    return false;
  place_in_each_other(a.hull, b.hull, motion.pose, scratch.hulls);
  if (!touch_without_area(a.hull, b.hull, motion.pose, sliver_m, scratch.hulls)) return false;
  pair.axis_A.setZero();
  pair.clearance_m = reach.margin_m + sliver_m;
  return true;
}

}  // namespace

bool same_as_before(const Bodies& bodies, SpanByBody<const StepReach> reach, const Pair& pair,
                    const Manifold* m) {
  if (pair.needs_test || (m && !(m->reusable && m->sticking)) || (!m && pair.clearance_m < 0))
    return false;
  const BodySlot a = pair.body_a, b = pair.body_b;
  const Vec3f offset_W = (bodies.position[b] - bodies.position[a]).cast<float>();
  const auto rotation_path_m = static_cast<float>(bodies.rotation_path_m[a] +
                                                  bodies.rotation_path_m[b] - pair.rotation_path_m);
  const float moved_m = (offset_W - pair.offset_W).norm() + rotation_path_m;
  if (m) return moved_m < kStillMotion * m->size_m;
  const Vec3f displacement_W = reach[b].displacement_W - reach[a].displacement_W;
  const float closing_m =
      pair.axis_A.isZero(0)
          ? displacement_W.norm()
          : std::max(0.f, -displacement_W.dot(bodies.rotation_f[a] * pair.axis_A));
  const float blur_m = kRounding * offset_W.norm();
  return pair.clearance_m - moved_m - blur_m >
         pair.margin_m + closing_m + reach[a].spin_m + reach[b].spin_m;
}

void prefetch_pairs(PairSlot at, PairSlot end, const Contacts& contacts, const Shapes& shapes,
                    const Bodies& bodies) {
  constexpr std::uint32_t kFirst = 8, kThen = 3;  // number of pairs ahead
  const auto ahead = [&](std::uint32_t by) -> const Pair* {
    if (at.value + by >= end.value) return nullptr;
    const Pair& pair = contacts.pairs[PairSlot(at.value + by)];
    if (!pair.present()) return nullptr;
    return bodies.changed[pair.body_a] || bodies.changed[pair.body_b] ? &pair : nullptr;
  };
  if (const Pair* const pair = ahead(kFirst)) {
    if (pair->touching()) prefetch(contacts.manifolds[pair->manifold]);
    prefetch(shapes[pair->shape_a]), prefetch(shapes[pair->shape_b]);
  }
  const Pair* const pair = ahead(kThen);
  if (!pair || !pair->touching()) return;
  shapes[pair->shape_a].hull.prefetch(), shapes[pair->shape_b].hull.prefetch();
}

void update_contact(const StepContext& step, const Shapes& shapes, const Bodies& bodies, Pair& pair,
                    Manifold& m, NarrowScratch& scratch) {
  const Shape &a = shapes[pair.shape_a], &b = shapes[pair.shape_b];
  const PairMotion motion = pair_motion(pair, bodies);
  // A facet may be a sliver, but counts as large as its surface.
  const float size_m = a.facet ? b.inner_radius_m : std::min(a.inner_radius_m, b.inner_radius_m);
  pair.rotation_path_m = bodies.rotation_path_m[pair.body_a] + bodies.rotation_path_m[pair.body_b];
  pair.offset_W = motion.offset_W;
  if (m.count > 0 && m.reusable && barely_moved(m, bodies, motion)) {
    refresh_manifold(bodies, motion, m);
    return;
  }
  const Reach reach = reach_of(a, b, bodies, motion, step, size_m);
  pair.margin_m = reach.margin_m;
  const Vec3f displacement_A = static_cast<float>(step.dt_s) *
                               (bodies.rotation_f[pair.body_a].transpose() * motion.velocity_W);
  const AxisReach axis_reach{reach.margin_m + reach.spin_m, displacement_A};
  if (m.count == 0 && still_separated(a, b, motion, axis_reach, pair)) return;
  if (m.count == 0 && edges_at_rest(a, b, motion, reach, size_m, pair, scratch)) return;
  m.size_m = size_m;
  m.is_ball_pair = a.kind == Kind::kSphere && b.kind == Kind::kSphere;
  m.friction = std::sqrt(a.friction * b.friction);
  m.rolling_m = std::max(a.rolling, b.rolling) * size_m;
  m.restitution = std::max(a.restitution, b.restitution);
  if (a.kind == Kind::kHalfSpace) {
    m.normal_on_b = false;
    m.reusable = b.kind == Kind::kHull;
    half_space_contact(a, b, pair, bodies, motion, reach, m, scratch);
  } else {
    make_contact(a, b, bodies, motion, reach, step.dt_s, pair, m, scratch);
  }
}

float separation_m(const Shape& a, const Shape& b, const RelativePose& pose,
                   NarrowScratch& scratch) {
  if (a.kind != Kind::kHalfSpace)
    return Probe{a, b, std::min(a.inner_radius_m, b.inner_radius_m), scratch}
        .axis(pose, {})
        .separation_m;
  if (b.kind == Kind::kSphere)
    return a.normal.dot(pose.R * b.center + pose.p - a.center) - b.radius_m;
  float least = 1e30f;
  for (std::uint32_t v = 0; v < b.hull.vertex_count(); ++v)
    least = std::min(least, a.normal.dot(pose.R * b.hull.vertex(v) + pose.p - a.center));
  return least;
}

HullDistance distance_to_hull(const Hull& hull, const Vec3f& point) {
  std::uint32_t nearest_face = 0;
  float most = -1e30f;
  for (std::uint32_t f = 0; f < hull.face_count(); ++f) {
    const float distance = hull.normal(f).dot(point) + hull.plane_d(f);
    if (distance > most) most = distance, nearest_face = f;
    if (distance <= 0) continue;
    const auto corners = hull.face_corners(f);
    bool above = true;
    for (std::size_t i = 0; i < corners.size() && above; ++i) {
      const Vec3f from = hull.vertex(corners[i]);
      const Vec3f to = hull.vertex(corners[i + 1 < corners.size() ? i + 1 : 0]);
      above = (to - from).cross(hull.normal(f)).dot(point - from) <= 0;
    }
    if (above) return {hull.normal(f), distance};
  }
  if (most <= 0) return {hull.normal(nearest_face), most};
  Vec3f gap = Vec3f::Zero();
  float least = 1e30f;
  for (std::uint32_t e = 0; e < hull.edge_count(); ++e) {
    const auto [from, to] = hull.edge_vertices(e);
    const Vec3f start = hull.vertex(from), along = hull.vertex(to) - start;
    const float t = std::clamp((point - start).dot(along) / along.squaredNorm(), 0.f, 1.f);
    const Vec3f apart = point - (start + t * along);
    if (const float square = apart.squaredNorm(); square < least) least = square, gap = apart;
  }
  const float distance = std::sqrt(least);
  return {distance > 0 ? Vec3f(gap / distance) : hull.normal(nearest_face), distance};
}

}  // namespace sunder::solver
