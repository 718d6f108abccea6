#include "render/follow.h"

#include <algorithm>
#include <ranges>

#include "engine/base/check.h"

namespace sunder::render {
namespace {

constexpr double kFollowRate = 5;

}  // namespace

/// Finds the names that match name_; "wall" matches "wall.0", "wall.1" and so on, as in scenes.
void FollowCamera::find_names(const Frame& frame) {
  std::string there;
  const std::vector<std::string> none;
  const std::vector<std::string>& names = frame.names ? *frame.names : none;
  for (std::uint32_t i = 0; i < names.size(); ++i) {
    if (names[i] == name_ || names[i].substr(0, names[i].rfind('.')) == name_) names_.push_back(i);
    if (i < 20 && !names[i].empty()) there += (there.empty() ? "" : ", ") + names[i];
  }
  if (!names_.empty()) return;
  throw InputError("--view follow:" + name_ +
                   (there.empty() ? ": nothing has a name here; record the take again, or give the "
                                    "solids of the scene names"
                                  : ": nothing is named so; there are: " + there +
                                        (names.size() > 20 ? " and more" : "")));
}

/// Returns the largest body with a matching name or, with `of_followed`, the largest that came off
/// the body followed; null if there is none.
const FrameBody* FollowCamera::largest_body(const Frame& frame, bool of_followed) {
  std::vector<double> size_m3(frame.bodies.size());
  for (const Instance& instance : frame.instances) {
    const double diagonal_m = sizes_.diagonal_m(frame, instance.mesh);
    size_m3[instance.body] += diagonal_m * diagonal_m * diagonal_m;
  }
  const FrameBody* found = nullptr;
  double most_m3 = -1;
  for (std::size_t b = 0; b < frame.bodies.size(); ++b) {
    const FrameBody& body = frame.bodies[b];
    const bool is_one =
        of_followed ? body.previous_key == *key_ : std::ranges::count(names_, body.name) > 0;
    if (!is_one || size_m3[b] <= most_m3) continue;
    most_m3 = size_m3[b];
    found = &body;
  }
  return found;
}

/// Returns the body to follow in a frame, or null.
const FrameBody* FollowCamera::body_in(const Frame& frame) {
  if (!key_) return largest_body(frame, false);
  const auto same = std::ranges::lower_bound(frame.bodies, *key_, {}, &FrameBody::key);
  if (same != frame.bodies.end() && same->key == *key_) return &*same;
  const FrameBody* const piece = largest_body(frame, true);
  return piece ? piece : largest_body(frame, false);
}

View FollowCamera::at(const Frame& frame) {
  const bool is_first = names_.empty();
  if (is_first) find_names(frame);
  const double dt_s = is_first ? 0 : frame.time_s - time_s_;
  time_s_ = frame.time_s;
  View view = frame.view;
  const Vec3 arm = view.eye_W - view.target_W;
  const FrameBody* const body = body_in(frame);
  if (!body && !key_) return view;
  Vec3 goal_velocity = Vec3::Zero();
  if (body) {
    const bool goes_on = key_ == body->key && dt_s > 0;
    goal_velocity = goes_on ? Vec3((body->X_WB.position - goal_W_) / dt_s) : body->velocity_W;
    if (is_first) {
      spring_ = {body->X_WB.position, goal_velocity};
    } else if (!key_) {
      spring_ = {view.target_W, Vec3::Zero()};
    }
    key_ = body->key;
    goal_W_ = body->X_WB.position;
  }
  spring_.advance(goal_W_, goal_velocity, dt_s, kFollowRate);
  view.target_W = spring_.position;
  view.eye_W = spring_.position + arm;
  return above_ground(view);
}

}  // namespace sunder::render
