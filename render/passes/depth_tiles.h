// Occlusion culling by the depths drawn so far; the image stays bit-identical.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/base/types.h"
#include "render/gl/table.h"

namespace sunder::render {

/// An oriented box in eye space.
struct OrientedBox {
  Vec3f center;
  Mat3f half_axes;  ///< Half axes in columns.
};

/// View of a camera or shadow map: maps eye space to an image with coordinates and depth in [0, 1].
struct CullingView {
  Eigen::Matrix4f picture_of_eye;
  Vec3f ahead;     ///< Unit direction of view.
  int width;       ///< In pixels.
  int height;      ///< In pixels.
  int depth_bits;  ///< 16 or 24.
};

// Views by the matrices of FrameUniforms.
CullingView view_of_light(const float (&picture_of_eye)[16], int texels);
CullingView view_of_camera(const float (&clip_of_eye)[16], int width, int height);

/// The greatest depth drawn so far in each tile of an image.
class DepthTiles {
 public:
  static constexpr int kSide = 8;  // pixels

  explicit DepthTiles(const GlTable& gl) : gl_(gl) {}

  /// Starts an empty image.
  void start(const CullingView& view);
  /// Reads the depths of the bound framebuffer.
  void read();
  /// Returns true if nothing in the box is visible: it is outside the image or behind drawn depths.
  bool hides(const OrientedBox& box) const;
  const CullingView& view() const { return view_; }

 private:
  template <class Depth>
  void find_farthest(std::vector<Depth>& depths, GLenum type);

  const GlTable& gl_;
  CullingView view_;
  int columns_ = 0;
  int rows_ = 0;
  std::vector<float> farthest_;
  std::vector<std::uint16_t> depths16_;
  std::vector<std::uint32_t> depths32_;
};

}  // namespace sunder::render
