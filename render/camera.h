// Cameras: they give each frame its view.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"

namespace sunder::render {

/// Gives views to frames, which must come in order of time.
class Camera {
 public:
  virtual ~Camera() = default;
  /// Returns the view of a frame. The frame's own view is the starting point of the camera.
  virtual View at(const Frame& frame) = 0;
  /// Returns true if the view of a frame depends on all frames before it.
  virtual bool depends_on_history() const { return false; }
};

/// Specifications of make_camera(), for help and messages.
inline constexpr const char* kCameras = "fixed | orbit[:SECONDS] | follow:NAME | auto";
/// Makes a camera. fixed: the view of the frames. orbit: a circle about their target with a period
/// in seconds of the run (default 20); negative: in the opposite direction. follow: with a solid or
/// ball of that name, or its largest piece. auto: towards what moves, at a distance that shows it.
/// The latter two move smoothly. Throws InputError for any other specification; at() throws
/// InputError for a name that is in no frame.
std::unique_ptr<Camera> make_camera(const std::string& spec);
/// Makes a camera that follows a path of keys.
std::unique_ptr<Camera> make_camera(std::vector<ViewKey> keys);

/// Returns the view with its eye raised to a little above the ground if it is below.
View above_ground(View view);

}  // namespace sunder::render
