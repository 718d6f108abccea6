// A camera that follows a body.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/damped_spring.h"
#include "render/mesh_sizes.h"

namespace sunder::render {

/// Follows a solid or ball by name; when that breaks, its largest piece, and so on. Distance and
/// direction to the target are those of the frames' own view, which is used until the body exists.
class FollowCamera final : public Camera {
 public:
  explicit FollowCamera(std::string name) : name_(std::move(name)) {}
  View at(const Frame& frame) override;
  bool depends_on_history() const override { return true; }

 private:
  void find_names(const Frame& frame);
  const FrameBody* body_in(const Frame& frame);
  const FrameBody* largest_body(const Frame& frame, bool of_followed);

  std::string name_;
  std::vector<std::uint32_t> names_;  ///< Indices of the matching names in Frame::names.
  std::optional<std::uint64_t> key_;  ///< Key of the body followed, once it has existed.
  Vec3 goal_W_ = Vec3::Zero();        ///< Last position of that body.
  DampedSpring<Vec3> spring_{Vec3::Zero(), Vec3::Zero()};
  double time_s_ = 0;
  MeshSizes sizes_;
};

}  // namespace sunder::render
