#include "render/between.h"

#include <algorithm>
#include <cmath>

#include "engine/base/rotation.h"

namespace sunder::render {
namespace {

constexpr double kFrame_s = 1.0 / 60;

template <class V>
V mixed(const V& a, const V& b, double part) {
  using Real = typename V::Scalar;
  return a + static_cast<Real>(part) * (b - a);
}

/// The short way round; within a frame it makes no difference that it is no great circle.
template <class Q>
Q turned(const Q& a, const Q& b, double part) {
  Q q = b;
  if (a.dot(b) < 0) q.coeffs() = -q.coeffs();
  q.coeffs() = mixed(a.coeffs(), q.coeffs(), part);
  return q.normalized();
}

Pose pose_between(const FrameBody* first, const FrameBody& second, double part, double dt_s) {
  if (first && first->com_R == second.com_R) {
    return {mixed(first->X_WB.position, second.X_WB.position, part),
            turned(first->X_WB.rotation, second.X_WB.rotation, part)};
  }
  const double back_s = (1 - part) * dt_s;
  return {second.X_WB.position - back_s * second.velocity_W,
          (rotation_by(-back_s * second.angular_velocity_W) * second.X_WB.rotation).normalized()};
}

bool is_same(const FrameDebris& a, const FrameDebris& b) {
  return a.radius_m == b.radius_m && a.variant == b.variant && a.material == b.material;
}

}  // namespace

Frame between(const Frame* first, const Frame& second, double part) {
  Frame frame = second;
  const Frame none;
  const Frame& before = first ? *first : none;
  const double dt_s = first ? second.time_s - first->time_s : kFrame_s;
  auto at = before.bodies.begin();
  for (FrameBody& body : frame.bodies) {
    at = std::find_if(at, before.bodies.end(),
                      [&](const FrameBody& other) { return other.key >= body.key; });
    const bool known = at != before.bodies.end() && at->key == body.key;
    body.X_WB = pose_between(known ? &*at : nullptr, body, part, dt_s);
  }
  for (std::size_t i = 0; i < std::min(frame.debris.size(), before.debris.size()); ++i) {
    FrameDebris& chip = frame.debris[i];
    const FrameDebris& was = before.debris[i];
    if (!is_same(was, chip)) continue;
    chip.position_W = mixed(was.position_W, chip.position_W, part);
    chip.rotation_WD = turned(was.rotation_WD, chip.rotation_WD, part);
  }
  if (!first) return frame;
  frame.view.eye_W = mixed(first->view.eye_W, second.view.eye_W, part);
  frame.view.target_W = mixed(first->view.target_W, second.view.target_W, part);
  frame.view.fov_rad = std::lerp(first->view.fov_rad, second.view.fov_rad, part);
  return frame;
}

}  // namespace sunder::render
