// Where a film is shot from: one frame after the other gets its view.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"

namespace sunder::render {

class Camera {
 public:
  virtual ~Camera() = default;
  /// How a frame is seen, whose own view is where the camera stands, or stood. Frames come in order
  /// of time.
  virtual View at(const Frame& frame) = 0;
  /// Whether what it shows of a frame depends on those before, back to the first.
  virtual bool remembers() const { return false; }
};

/// What make_camera() understands.
inline constexpr const char* kCameras = "fixed | orbit[:SECONDS] | follow:NAME | auto";
/// fixed: as the frames say. orbit: about what they look at, once round in so many seconds of the
/// run (20); less than 0: the other way round. follow: with a solid or ball of that name, or the
/// largest piece of it. auto: turned to what moves, as near as shows it. The latter two move
/// without a jerk. Throws InputError for anything else; at() does for a name that no frame knows.
std::unique_ptr<Camera> make_camera(const std::string& spec);
/// One that goes through keys.
std::unique_ptr<Camera> make_camera(std::vector<ViewKey> keys);

/// The view from a little above the ground where it would be from below.
View above_ground(View view);

}  // namespace sunder::render
