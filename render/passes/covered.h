// What lies behind what is drawn already need not be drawn: the picture stays the same, bit for
// bit.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/types.h"
#include "render/gl/table.h"

namespace sunder::render {

/// A box in eye space.
struct TurnedBox {
  Vec3f center;
  Mat3f half_axes;  ///< Columns.
};

/// A camera, or a light as its shadow map has it: takes eye space to a picture whose width, height
/// and depth run from 0 to 1.
struct SeenFrom {
  Eigen::Matrix4f picture_of_eye;
  Vec3f ahead;
  int width;
  int height;
  int depth_bits;  ///< 16 or 24.
};

/// By the matrices of FrameUniforms.
SeenFrom seen_by_light(const float (&picture_of_eye)[16], int texels);
SeenFrom seen_by_camera(const float (&clip_of_eye)[16], int width, int height);

/// The farthest depth that a picture has so far, in each of its tiles.
class CoveredTiles {
 public:
  static constexpr int kSide = 8;  // pixels

  explicit CoveredTiles(const GlTable& gl) : gl_(gl) {}

  /// A picture in which nothing is yet.
  void start(const SeenFrom& seen);
  /// Takes the depths of the bound framebuffer, once all is drawn.
  void read();
  /// Whether nothing of what is in the box would be seen: it is out of the picture, or covered.
  bool hides(const TurnedBox& box) const;
  const SeenFrom& seen_from() const { return seen_; }

 private:
  template <class Depth>
  void find_farthest(std::vector<Depth>& depths, GLenum type);

  const GlTable& gl_;
  SeenFrom seen_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> farthest_;
  std::vector<std::uint16_t> depths16_;
  std::vector<std::uint32_t> depths32_;
};

}  // namespace sunder::render
