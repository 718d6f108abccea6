// Builds, matches and updates manifolds.
#include "solver/rigid/collide/manifold_build.h"

#include <algorithm>

#include "engine/base/rotation.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

Quatf relative_rotation(const Manifold& m, const Bodies& bodies) {
  return (bodies.rotation[m.body_a].conjugate() * bodies.rotation[m.body_b]).cast<float>();
}

/// Copies impulses of old points to new ones: to the same feature, else to the nearest point
/// without one. The same feature keeps its rest separation, or a sliding body would sink in each
/// time its points are built.
void inherit_impulses(std::span<const ManifoldPoint> old, float size_m,
                      std::span<ManifoldPoint> points) {
  std::uint32_t taken = 0, served = 0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    for (std::size_t j = 0; j < old.size(); ++j) {
      if ((taken >> j & 1) || old[j].feature != points[i].feature) continue;
      points[i].impulse_Ns = old[j].impulse_Ns;
      points[i].rest_m = old[j].rest_m;
      taken |= 1u << j, served |= 1u << i;
      break;
    }
  }
  const float limit = kPointMatchDistance * size_m;
  for (std::size_t i = 0; i < points.size(); ++i) {
    if (served >> i & 1) continue;
    float nearest = limit * limit;
    std::size_t match = old.size();
    for (std::size_t j = 0; j < old.size(); ++j) {
      const float square = (old[j].anchor_A - points[i].anchor_A).squaredNorm();
      if (!(taken >> j & 1) && square < nearest) nearest = square, match = j;
    }
    if (match == old.size()) continue;
    points[i].impulse_Ns = old[match].impulse_Ns;
    taken |= 1u << match;
  }
}

/// Adds old points that are still near, unless the manifold has a point there.
void keep_points(std::span<const ManifoldPoint> old, const PairMotion& motion,
                 const Vec3f& normal_A, float reach_m, Manifold& m) {
  const float slide_m = kKeptPointSlide * m.size_m, apart_m = 2 * slide_m;
  for (const ManifoldPoint& was : old) {
    if (m.count == m.points.size()) return;
    const Vec3f gap = motion.pose.R * was.anchor_B + motion.pose.p - was.anchor_A;
    const float separation_m = normal_A.dot(gap);
    if (separation_m > reach_m) continue;
    if ((gap - separation_m * normal_A).squaredNorm() > slide_m * slide_m) continue;
    const auto same = [&](const ManifoldPoint& point) {
      return point.feature == was.feature ||
             (point.anchor_A - was.anchor_A).squaredNorm() < apart_m * apart_m;
    };
    if (std::any_of(m.points.begin(), m.points.begin() + m.count, same)) continue;
    ManifoldPoint& kept = m.points[m.count++];
    kept = ManifoldPoint();
    kept.anchor_A = was.anchor_A, kept.anchor_B = was.anchor_B;
    kept.separation_m = separation_m;
    kept.feature = was.feature;
  }
}

/// Returns a bit for each point that is hardly farther than the first to touch.
std::uint32_t touching_of(std::span<const PatchPoint> points, float size_m) {
  const auto separation = [](const PatchPoint& point) { return point.separation_m; };
  const float most_m =
      std::ranges::min(points, {}, separation).separation_m + kContactMargin * size_m;
  std::uint32_t touching = 0;
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i].separation_m <= most_m) touching |= 1u << i;
  return touching;
}

/// Computes lever arms from anchors, and puts friction at the mean of the points, without those
/// that only the swing after an impact may bring together: `touching` has a bit for each of the
/// others.
void place_points(const Mat3f& R_WA, const Mat3f& R_WB, std::uint32_t touching, Manifold& m) {
  m.friction_anchor_A.setZero(), m.friction_anchor_B.setZero();
  float count = 0;
  for (std::size_t i = 0; i < m.count; ++i) {
    ManifoldPoint& point = m.points[i];
    point.arm_A = R_WA * point.anchor_A;
    point.arm_B = R_WB * point.anchor_B;
    if (!(touching >> i & 1)) continue;
    m.friction_anchor_A += point.anchor_A;
    m.friction_anchor_B += point.anchor_B;
    ++count;
  }
  m.friction_anchor_A /= count;
  m.friction_anchor_B /= count;
  m.friction_arm_A = R_WA * m.friction_anchor_A;
  m.friction_arm_B = R_WB * m.friction_anchor_B;
}

}  // namespace

PairMotion pair_motion(const Pair& pair, const Bodies& bodies) {
  const BodySlot a = pair.body_a, b = pair.body_b;
  PairMotion motion;
  motion.offset_W = (bodies.position[b] - bodies.position[a]).cast<float>();
  motion.velocity_W = (bodies.velocity[b] - bodies.velocity[a]).cast<float>();
  const Mat3f back = bodies.rotation_f[a].transpose();
  motion.pose = {back * bodies.rotation_f[b], back * motion.offset_W};
  return motion;
}

Moment present_moment(const Pair& pair, const Bodies& bodies, const PairMotion& motion) {
  return {0, false, bodies.rotation_f[pair.body_a], bodies.rotation_f[pair.body_b], motion.pose};
}

Moment moment_at(float time_s, bool turning, const Pair& pair, const Bodies& bodies,
                 const PairMotion& motion) {
  const auto turned = [&](BodySlot body) -> Mat3f {
    if (!turning) return bodies.rotation_f[body];
    const Quat turn = rotation_by(double{time_s} * bodies.angular_velocity[body]);
    return turn.toRotationMatrix().cast<float>() * bodies.rotation_f[body];
  };
  Moment moment{time_s, turning, turned(pair.body_a), turned(pair.body_b), {}};
  const Mat3f back = moment.R_WA.transpose();
  moment.pose = {back * moment.R_WB, back * (motion.offset_W + time_s * motion.velocity_W)};
  return moment;
}

void build_manifold(const Pair& pair, const Bodies& bodies, const PairMotion& motion,
                    const Vec3f& normal_A, std::span<const PatchPoint> points, const Moment& moment,
                    float reach_m, Manifold& m) {
  const Mat3f &R_WA = moment.R_WA, &R_WB = moment.R_WB;
  const std::array<ManifoldPoint, 4> old = m.points;
  const std::size_t old_count = m.count;
  m.body_a = pair.body_a, m.body_b = pair.body_b;
  m.count = static_cast<std::uint8_t>(points.size());
  m.normal_W = (R_WA * normal_A).normalized();
  m.normal_body = m.normal_on_b ? Vec3f(R_WB.transpose() * m.normal_W) : normal_A;
  m.built_position = motion.pose.p;
  m.built_rotation = relative_rotation(m, bodies);
  const Vec3f spin_a_W = bodies.angular_velocity[pair.body_a].cast<float>(),
              spin_b_W = bodies.angular_velocity[pair.body_b].cast<float>();
  // A point that is to be where it is at the moment starts where straight motion leads there.
  const auto closed_m = [&](const ManifoldPoint& point) {
    Vec3f velocity_W = motion.velocity_W;
    if (moment.turned) {
      velocity_W += spin_b_W.cross(R_WB * point.anchor_B) - spin_a_W.cross(R_WA * point.anchor_A);
    }
    return moment.time_s * m.normal_W.dot(velocity_W);
  };
  for (std::size_t i = 0; i < points.size(); ++i) {
    ManifoldPoint& point = m.points[i];
    point = ManifoldPoint();
    point.anchor_A = points[i].on_a;
    point.anchor_B = moment.pose.R.transpose() * (points[i].on_b - moment.pose.p);
    point.separation_m = points[i].separation_m - closed_m(point);
    point.feature = points[i].feature;
  }
  if (points.empty()) {
    m.friction_impulse_W.setZero();
    m.twist_impulse = 0;
    return;
  }
  const std::span<const ManifoldPoint> before = std::span(old).first(old_count);
  if (points.size() == 1 && m.reusable) keep_points(before, motion, normal_A, reach_m, m);
  place_points(R_WA, R_WB, moment.time_s > 0 ? touching_of(points, m.size_m) : ~0u, m);
  m.drift_W.setZero();
  m.sticking = true;
  inherit_impulses(before, m.size_m, std::span(m.points).first(m.count));
}

bool barely_moved(const Manifold& m, const Bodies& bodies, const PairMotion& motion) {
  const float limit = kMaxReuseMotion * m.size_m;
  if ((motion.pose.p - m.built_position).squaredNorm() > limit * limit) return false;
  const Quatf rotation = m.built_rotation.conjugate() * relative_rotation(m, bodies);
  const float half_angle = kMaxReuseMotion / 6;
  return rotation.vec().squaredNorm() < half_angle * half_angle;
}

void refresh_manifold(const Bodies& bodies, const PairMotion& motion, Manifold& m) {
  const Mat3f &R_WA = bodies.rotation_f[m.body_a], &R_WB = bodies.rotation_f[m.body_b];
  m.normal_W = (m.normal_on_b ? R_WB : R_WA) * m.normal_body;
  for (int i = 0; i < m.count; ++i) {
    ManifoldPoint& point = m.points[i];
    point.arm_A = R_WA * point.anchor_A;
    point.arm_B = R_WB * point.anchor_B;
    point.separation_m = m.normal_W.dot(motion.offset_W + point.arm_B - point.arm_A);
  }
  m.friction_arm_A = R_WA * m.friction_anchor_A;
  if (!m.sticking) {
    const float apart =
        m.normal_W.dot(motion.offset_W + R_WB * m.friction_anchor_B - m.friction_arm_A);
    m.friction_arm_B = m.friction_arm_A + apart * m.normal_W - motion.offset_W;
    m.friction_anchor_B = R_WB.transpose() * m.friction_arm_B;
    m.sticking = true;
  }
  m.friction_arm_B = R_WB * m.friction_anchor_B;
  m.drift_W = motion.offset_W + m.friction_arm_B - m.friction_arm_A;
}

}  // namespace sunder::solver
