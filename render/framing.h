// A camera that frames moving bodies.
#pragma once

#include <optional>

#include "render/camera.h"
#include "render/damped_spring.h"
#include "render/mesh_sizes.h"

namespace sunder::render {

/// Looks at the centre of what moves, in the direction of the frames' own view and from a distance
/// that shows about all of it. The smaller the moving share of the scene, the slower the camera
/// turns to it. Starts with the frames' own view, and stays in place when nothing moves.
class FramingCamera final : public Camera {
 public:
  View at(const Frame& frame) override;
  bool depends_on_history() const override { return true; }

 private:
  /// State of the camera: target, and logarithm of the distance to it.
  using Vec4 = Eigen::Vector4d;
  void find_goal(const Frame& frame, double dt_s);

  Vec4 goal_ = Vec4::Zero();
  std::optional<DampedSpring<Vec4>> spring_;
  double time_s_ = 0;
  MeshSizes sizes_;
};

}  // namespace sunder::render
