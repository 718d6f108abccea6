#include "render/camera.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/trigonometry.h"
#include "engine/model/view_path.h"
#include "render/follow.h"
#include "render/framing.h"

namespace sunder::render {
namespace {

class FixedCamera final : public Camera {
 public:
  View at(const Frame& frame) override { return frame.view; }
};

/// Orbits about the vertical through the target.
class OrbitCamera final : public Camera {
 public:
  explicit OrbitCamera(double period_s) : period_s_(period_s) {}
  View at(const Frame& frame) override {
    View view = frame.view;
    const double turns = frame.time_s / period_s_;
    const SinCos turn = sin_cos(2 * std::numbers::pi * (turns - std::floor(turns)));
    const Vec3 arm = view.eye_W - view.target_W;
    view.eye_W = view.target_W + Vec3(turn.cos * arm.x() + turn.sin * arm.z(), arm.y(),
                                      turn.cos * arm.z() - turn.sin * arm.x());
    return view;
  }

 private:
  double period_s_;
};

class PathCamera final : public Camera {
 public:
  explicit PathCamera(std::vector<ViewKey> keys) : keys_(std::move(keys)) {}
  View at(const Frame& frame) override { return along(keys_, frame.view, frame.time_s); }

 private:
  std::vector<ViewKey> keys_;
};

double parse_period(const std::string& spec, const std::string& text) {
  constexpr double kShortest_s = 0.01, kLongest_s = 1e6;
  double period_s = 0;
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), period_s);
  if (error != std::errc() || stop != text.data() + text.size() ||
      !(std::abs(period_s) >= kShortest_s && std::abs(period_s) <= kLongest_s)) {
    throw InputError("--view " + spec +
                     ": expected orbit:SECONDS, a number from 0.01 to 1e6 of seconds that once "
                     "round takes; less than 0: the other way round");
  }
  return period_s;
}

}  // namespace

View above_ground(View view) {
  constexpr double kClear = 0.02;  // height above the ground / distance to the target
  const double lowest_m = view.ground_m + kClear * (view.eye_W - view.target_W).norm();
  view.eye_W.y() = std::max(view.eye_W.y(), lowest_m);
  return view;
}

std::unique_ptr<Camera> make_camera(const std::string& spec) {
  const std::size_t colon = spec.find(':');
  const std::string kind = spec.substr(0, colon);
  const bool any = colon != std::string::npos;
  const std::string rest = any ? spec.substr(colon + 1) : "";
  if (spec == "fixed") return std::make_unique<FixedCamera>();
  if (kind == "orbit") {
    constexpr double kUsual_s = 20;
    return std::make_unique<OrbitCamera>(any ? parse_period(spec, rest) : kUsual_s);
  }
  if (kind == "follow" && !rest.empty()) return std::make_unique<FollowCamera>(rest);
  if (spec == "auto") return std::make_unique<FramingCamera>();
  throw InputError("--view " + spec + ": expected " + kCameras + " | FILE.toml, a path by keys");
}

std::unique_ptr<Camera> make_camera(std::vector<ViewKey> keys) {
  return std::make_unique<PathCamera>(std::move(keys));
}

}  // namespace sunder::render
