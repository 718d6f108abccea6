#include "scenes/app/run_notes.h"

#include <algorithm>
#include <cstdio>

namespace sunder::app {
namespace {

/// Fraction of the speed, and speed in m/s, by which the velocity of a ball in flight may differ
/// from that of a parabola: rounding, and steps that begin within a frame.
constexpr double kSpeedTolerance = 1e-3, kSpeedTolerance_m_s = 0.02;
/// Distance to the ground plane, as a fraction of the radius, at which a ball touches it.
constexpr double kGroundTolerance = 0.2;

}  // namespace

RunNotes::RunNotes(const Scene& scene, double start_s)
    : gravity_W_(scene.gravity_W),
      ground_m_(scene.ground.height_m),
      has_ground_meshes_(!scene.ground.meshes.empty()),
      last_s_(start_s) {
  auto index = static_cast<std::uint32_t>(scene.solids.size() + scene.balls.size());
  for (const Shot& shot : scene.shots) {
    const std::uint32_t name = index++;
    if (!shot.hangs_from_W && shot.time_s >= start_s)
      shots_.push_back({name, shot.time_s, shot.ball.velocity_W, shot.ball.radius_m});
  }
}

void RunNotes::watch(Watched& shot, const FrameBody& ball, double since_s) const {
  const Vec3 fall = gravity_W_ * since_s;
  // A ball that has just appeared has fallen for an unknown part of the time between frames.
  const double unknown = shot.state == Watched::State::kToCome ? fall.norm() : 0;
  const Vec3 expected = shot.velocity_W + (unknown > 0 ? Vec3::Zero() : fall);
  const double allowed = kSpeedTolerance * shot.velocity_W.norm() + kSpeedTolerance_m_s + unknown;
  shot.velocity_W = ball.velocity_W;
  shot.state = Watched::State::kFlying;
  if ((ball.velocity_W - expected).norm() <= allowed) return;
  const double height_m = ball.X_WB.position.y() - ground_m_;
  const bool at_ground = !has_ground_meshes_ && height_m < (1 + kGroundTolerance) * shot.radius_m;
  shot.state = at_ground ? Watched::State::kGroundFirst : Watched::State::kHit;
}

void RunNotes::take(const FramePtr& frame) {
  breaks_ += static_cast<std::int64_t>(frame->breaks.size());
  const double since_s = frame->time_s - last_s_;
  last_s_ = frame->time_s;
  names_ = frame->names;
  for (Watched& shot : shots_) {
    if (shot.state != Watched::State::kToCome && shot.state != Watched::State::kFlying) continue;
    const auto ball = std::ranges::find(frame->bodies, shot.name, &FrameBody::name);
    if (ball != frame->bodies.end()) {
      watch(shot, *ball, since_s);
    } else if (shot.state == Watched::State::kFlying) {
      shot.state = Watched::State::kHit;  // the ball is gone
    }
  }
}

std::string RunNotes::text() const {
  std::string text;
  for (const Watched& shot : shots_) {
    char title[100];
    std::snprintf(title, sizeof title, "shot '%.60s' at %.4g s",
                  names_ ? (*names_)[shot.name].c_str() : "", shot.time_s);
    if (shot.state == Watched::State::kFlying)
      text += title + std::string(" hit nothing; check its keys from, at and velocity\n");
    if (shot.state == Watched::State::kGroundFirst)
      text += title + std::string(" hit the ground before anything else\n");
  }
  return text + (breaks_ == 0 ? "nothing broke\n" : "");
}

}  // namespace sunder::app
