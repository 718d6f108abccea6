#include "render/framing.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "engine/base/trigonometry.h"

namespace sunder::render {
namespace {

constexpr double kGoalRate = 4, kFramingRate = 2.5;  // a second
constexpr double kMoves_m_s = 0.5;  // half of the full interest is in what goes so fast
constexpr double kLittle = 0.02;    // of all there is: half turned to it when so much moves
constexpr double kReach = 1.8;      // radii of gyration around the middle that are to be seen
constexpr double kNearest = 0.4, kFarthest = 2.5;  // of the distance that the frames look from

}  // namespace

/// Interest is in surface times how far it moves; a body is as large as its meshes together.
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
  std::vector<double> interest(frame.bodies.size());
  for (std::size_t b = 0; b < frame.bodies.size(); ++b) {
    const FrameBody& body = frame.bodies[b];
    const double square = body.velocity_W.squaredNorm();
    interest[b] = size_m2[b] * square / (square + kMoves_m_s * kMoves_m_s);
    all += size_m2[b];
    moving += interest[b];
    middle_W += interest[b] * body.X_WB.position;
  }
  if (!(moving > 0)) return;
  middle_W /= moving;
  double spread_m2 = 0;
  for (std::size_t b = 0; b < frame.bodies.size(); ++b) {
    spread_m2 += interest[b] *
                 ((frame.bodies[b].X_WB.position - middle_W).squaredNorm() + 0.25 * size_m2[b]);
  }
  const double radius_m = kReach * std::sqrt(spread_m2 / moving);
  const double far_m = std::clamp(radius_m / sin_cos(0.5 * view.fov_rad).sin, kNearest * usual_m,
                                  kFarthest * usual_m);
  Vec4 found;
  found << middle_W, std::log(far_m);
  const double x = kGoalRate * dt_s;
  goal_ += moving / (moving + kLittle * all) * x / (1 + x) * (found - goal_);
}

View FramingCamera::at(const Frame& frame) {
  View view = frame.view;
  const Vec3 arm = view.eye_W - view.target_W;
  if (!glide_) {
    goal_ << view.target_W, std::log(arm.norm());
    glide_ = Glide<Vec4>{goal_, Vec4::Zero()};
  } else {
    const double dt_s = frame.time_s - time_s_;
    find_goal(frame, dt_s);
    glide_->on(goal_, Vec4::Zero(), dt_s, kFramingRate);
  }
  time_s_ = frame.time_s;
  view.target_W = glide_->at.head<3>();
  view.eye_W = view.target_W + std::exp(glide_->at[3]) * arm.normalized();
  return above_ground(view);
}

}  // namespace sunder::render
