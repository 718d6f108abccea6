// Frames without a simulation: boxes, balls and broken pieces at given positions.
#pragma once

#include "engine/base/random.h"
#include "engine/model/frame.h"

namespace sunder::render {

/// The materials of a SyntheticFrame, in order.
enum class Stuff : std::uint8_t { kBrick, kConcrete, kPlaster, kWood, kSteel, kGlass };

class SyntheticFrame {
 public:
  SyntheticFrame();

  /// Adds a box by its corners in the world; its rest frame is the world.
  void add_box(const Vec3& min, const Vec3& max, Stuff stuff);
  /// Adds a box by its corners in its rest frame, with the pose X_WB of its centre of mass.
  void add_box(const Vec3& min, const Vec3& max, Stuff stuff, const Pose& X_WB);
  void add_ball(const Vec3& center, double radius_m, Stuff stuff);
  /// Adds a random chunk, about `size_m` wide; most of its faces are broken ones.
  void add_chunk(const Vec3& center, double size_m, Stuff stuff, Random& random);

  Frame frame;

 private:
  void add(std::shared_ptr<const Mesh> mesh, const Vec3& com_R, const Pose& X_WB);

  std::shared_ptr<MeshStore> meshes_ = std::make_shared<MeshStore>();
};

/// Returns a two-storey house with a corner missing and `chunks` pieces of rubble in front of it,
/// seen as in a typical video.
Frame house_frame(int chunks);

}  // namespace sunder::render
