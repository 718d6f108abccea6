// A camera that finds what moves.
#pragma once

#include <optional>

#include "render/camera.h"
#include "render/glide.h"
#include "render/mesh_sizes.h"

namespace sunder::render {

/// Looks at the middle of what moves, from the side of the frames' own view and from so far that
/// all of that about shows; the less of all there is moves, the less it is drawn there. It begins
/// with that view, and stays where it is when nothing moves any longer.
class FramingCamera final : public Camera {
 public:
  View at(const Frame& frame) override;
  bool remembers() const override { return true; }

 private:
  /// Of the camera: what it looks at, and the logarithm of how far off that is.
  using Vec4 = Eigen::Vector4d;
  void find_goal(const Frame& frame, double dt_s);

  Vec4 goal_ = Vec4::Zero();
  std::optional<Glide<Vec4>> glide_;
  double time_s_ = 0;
  MeshSizes sizes_;
};

}  // namespace sunder::render
