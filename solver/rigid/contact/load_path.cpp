// Read first: distribute_loads().
#include "solver/rigid/contact/load_path.h"

#include <algorithm>

#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

/// A body and a manifold that supports it.
struct Support {
  double height_m;  ///< Height of the body.
  BodySlot body, below;
  ManifoldSlot manifold;
};

std::vector<Support> find_supports(const Vec3& up, std::span<const ManifoldSlot> manifolds,
                                   const Bodies& bodies, const Contacts& contacts) {
  std::vector<Support> supports;
  for (const ManifoldSlot i : manifolds) {
    const Manifold& m = contacts.manifolds[i];
    const float slope = m.normal_W.dot(up.cast<float>());
    if (std::abs(slope) < kMinSupportCosine) continue;
    const BodySlot body = slope > 0 ? m.body_b : m.body_a;
    const BodySlot below = slope > 0 ? m.body_a : m.body_b;
    if (bodies.awake(body)) supports.push_back({up.dot(bodies.position[body]), body, below, i});
  }
  std::sort(supports.begin(), supports.end(), [](const Support& s, const Support& t) {
    if (s.height_m != t.height_m) return s.height_m > t.height_m;
    return s.body != t.body ? s.body < t.body : s.manifold < t.manifold;
  });
  return supports;
}

struct Share {
  Manifold* manifold;
  std::size_t point;
  BodySlot below;
  Vec3f arm, arm_below;
  float vertical = 0;
};

/// Finds the vertical impulses at `shares` that have the sum `weight` and a `moment` about the two
/// horizontal axes, with least squares; negative ones are set to 0.
void find_vertical_impulses(const Vec3f& up, const Vec3f& across_1, const Vec3f& across_2,
                            float weight, const Vec3f& moment, std::vector<Share>& shares) {
  float longest = 0;  // unit of the arms
  for (const Share& s : shares) longest = std::max(longest, s.arm.norm());
  const float inverse = longest > 0 ? 1 / longest : 0;
  auto row = [&](const Share& s) {
    return Vec3f(1, inverse * s.arm.dot(across_1), inverse * s.arm.dot(across_2));
  };
  // An impulse along `up` at x·across_1 + y·across_2 has the moment x·(across_1 × up) + y·(across_2
  // × up).
  const Vec3f wanted(weight, inverse * moment.dot(across_1.cross(up)),
                     inverse * moment.dot(across_2.cross(up)));
  Mat3f normal = Mat3f::Zero();
  for (const Share& s : shares) normal += row(s) * row(s).transpose();
  const float arms = normal(1, 1) + normal(2, 2);
  normal(1, 1) += 1e-3f * arms + 1e-12f, normal(2, 2) += 1e-3f * arms + 1e-12f;
  const Vec3f plane = normal.inverse() * wanted;
  float sum = 0;
  for (Share& s : shares) sum += s.vertical = std::max(0.f, plane.dot(row(s)));
  for (Share& s : shares) s.vertical = sum > 0 ? s.vertical * weight / sum : 0;
}

}  // namespace

void distribute_loads(const Vec3& gravity_W, std::span<const ManifoldSlot> manifolds,
                      const Bodies& bodies, ByBody<BodyImpulse>& loads, Contacts& contacts) {
  if (gravity_W.isZero(0)) return;
  const Vec3 up_W = -gravity_W.normalized();
  const Vec3f up = up_W.cast<float>();
  const Vec3f across_1 = up.unitOrthogonal(), across_2 = up.cross(across_1);
  const std::vector<Support> supports = find_supports(up_W, manifolds, bodies, contacts);
  for (std::size_t i = supports.size(); i-- > 0;) {
    const Support& s = supports[i];
    if (!bodies.awake(s.below) || loads[s.below].supported) loads[s.body].supported = true;
  }
  std::vector<Share> shares;
  for (std::size_t begin = 0, end = 0; begin < supports.size(); begin = end) {
    const BodySlot body = supports[begin].body;
    shares.clear();
    for (; end < supports.size() && supports[end].body == body; ++end) {
      const Support& s = supports[end];
      if (bodies.awake(s.below) && !loads[s.below].supported) continue;
      Manifold& m = contacts.manifolds[s.manifold];
      const bool on_b = m.body_b == body;
      for (std::size_t i = 0; i < m.count; ++i) {
        const ManifoldPoint& p = m.points[i];
        shares.push_back({&m, i, s.below, on_b ? p.arm_B : p.arm_A, on_b ? p.arm_A : p.arm_B});
      }
    }
    const float weight = -loads[body].impulse_W.dot(up);
    if (shares.empty() || weight <= 0) continue;
    find_vertical_impulses(up, across_1, across_2, weight, -loads[body].angular_impulse_W, shares);
    for (const Share& s : shares) {
      const float slope = std::abs(s.manifold->normal_W.dot(up));
      s.manifold->points[s.point].impulse_Ns = s.vertical / slope;
      loads[s.below].impulse_W -= s.vertical * up;
      loads[s.below].angular_impulse_W -= s.arm_below.cross(s.vertical * up);
    }
  }
}

void mark_unsupported_above(const Vec3& gravity_W, std::span<const ManifoldSlot> manifolds,
                            const Bodies& bodies, const Contacts& contacts,
                            ByBody<BodyImpulse>& loads) {
  if (gravity_W.isZero(0)) return;
  const std::vector<Support> supports =
      find_supports(-gravity_W.normalized(), manifolds, bodies, contacts);
  for (std::size_t i = supports.size(); i-- > 0;) {
    const Support& s = supports[i];
    if (bodies.awake(s.below) && !loads[s.below].supported) loads[s.body].supported = false;
  }
}

}  // namespace sunder::solver
