// A camera that goes with something.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "render/camera.h"
#include "render/glide.h"
#include "render/mesh_sizes.h"

namespace sunder::render {

/// Looks at a solid or ball by name; once that breaks, at the largest of its pieces, and of theirs
/// in turn. From as far, and from the same side, as the frames' own view looks at its target. Until
/// it is there the view is that.
class FollowCamera final : public Camera {
 public:
  explicit FollowCamera(std::string name) : name_(std::move(name)) {}
  View at(const Frame& frame) override;
  bool remembers() const override { return true; }

 private:
  void look_up(const Frame& frame);
  const FrameBody* body_in(const Frame& frame);
  const FrameBody* largest(const Frame& frame, bool of_followed);

  std::string name_;
  std::vector<std::uint32_t> names_;  ///< Those in Frame::names that are meant.
  std::optional<std::uint64_t> key_;  ///< Of what is followed, once it has been there.
  Vec3 goal_W_ = Vec3::Zero();        ///< Where that was.
  Glide<Vec3> glide_{Vec3::Zero(), Vec3::Zero()};
  double time_s_ = 0;
  MeshSizes sizes_;
};

}  // namespace sunder::render
