#include "render/framing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/trigonometry.h"

namespace sunder::render {
namespace {

constexpr double kGoalRate = 4, kFramingRate = 2.5;  // rates of the goal and of the spring, 1/s
constexpr double kHalfWeightSpeed_m_s = 0.5;  // speed at which a body has half of its full weight
// Moving share of the scene at which the goal has half its rate.
constexpr double kHalfRateShare = 0.02;
constexpr double kShownRadii = 1.8;  // radius that is shown, in radii of gyration of what moves
// Least and greatest distance to the target, as fractions of that in the frames' own view.
constexpr double kMinDistance = 0.4, kMaxDistance = 2.5;

}  // namespace

/// Computes the goal. The weight of a body is its size (sum of squared diagonals of its meshes)
/// times a factor that grows with its speed.
void FramingCamera::find_goal(const Frame& frame, double dt_s) {
  const View& view = frame.view;
  const double usual_m = (view.eye_W - view.target_W).norm();
  std::vector<double> size_m2(frame.bodies.size());
  for (const Instance& instance : frame.instances) {
    const double diagonal_m = sizes_.diagonal_m(frame, instance.mesh);
    size_m2[instance.body] += diagonal_m * diagonal_m;
  }
  double all = 0, moving = 0;
  Vec3 middle_W = Vec3::Zero();
  std::vector<double> weight(frame.bodies.size());
  for (std::size_t b = 0; b < frame.bodies.size(); ++b) {
    const FrameBody& body = frame.bodies[b];
    const double square = body.velocity_W.squaredNorm();
    weight[b] = size_m2[b] * square / (square + kHalfWeightSpeed_m_s * kHalfWeightSpeed_m_s);
    all += size_m2[b];
    moving += weight[b];
    middle_W += weight[b] * body.X_WB.position;
  }
  if (!(moving > 0)) return;
  middle_W /= moving;
  double spread_m2 = 0;
  for (std::size_t b = 0; b < frame.bodies.size(); ++b) {
    spread_m2 +=
        weight[b] * ((frame.bodies[b].X_WB.position - middle_W).squaredNorm() + 0.25 * size_m2[b]);
  }
  const double radius_m = kShownRadii * std::sqrt(spread_m2 / moving);
  const double far_m = std::clamp(radius_m / sin_cos(0.5 * view.fov_rad).sin,
                                  kMinDistance * usual_m, kMaxDistance * usual_m);
  Vec4 found;
  found << middle_W, std::log(far_m);
  const double x = kGoalRate * dt_s;
  goal_ += moving / (moving + kHalfRateShare * all) * x / (1 + x) * (found - goal_);
}

View FramingCamera::at(const Frame& frame) {
  View view = frame.view;
  const Vec3 arm = view.eye_W - view.target_W;
  if (!spring_) {
    goal_ << view.target_W, std::log(arm.norm());
    spring_ = DampedSpring<Vec4>{goal_, Vec4::Zero()};
  } else {
    const double dt_s = frame.time_s - time_s_;
    find_goal(frame, dt_s);
    spring_->advance(goal_, Vec4::Zero(), dt_s, kFramingRate);
  }
  time_s_ = frame.time_s;
  view.target_W = spring_->position.head<3>();
  view.eye_W = view.target_W + std::exp(spring_->position[3]) * arm.normalized();
  return above_ground(view);
}

}  // namespace sunder::render
