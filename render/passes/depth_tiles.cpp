#include "render/passes/depth_tiles.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "engine/base/parallel.h"

namespace sunder::render {
namespace {

// Tolerances for rounding here and in the driver.
constexpr float kPixelTolerance = 1;
constexpr float kDepthTolerance = 4e-6f;

Eigen::Matrix4f matrix_of(const float (&columns)[16]) {
  return Eigen::Map<const Eigen::Matrix4f>(columns);
}

}  // namespace

CullingView view_of_light(const float (&picture_of_eye)[16], int texels) {
  const Eigen::Matrix4f to = matrix_of(picture_of_eye);
  return {to, to.block<1, 3>(2, 0).transpose().normalized(), texels, texels, 16};
}

CullingView view_of_camera(const float (&clip_of_eye)[16], int width, int height) {
  Eigen::Matrix4f to = matrix_of(clip_of_eye);
  to.topRows<3>() = (0.5f * (to.topRows<3>() + to.row(3).replicate<3, 1>())).eval();
  return {to, to.block<1, 3>(3, 0).transpose().normalized(), width, height, 24};
}

void DepthTiles::start(const CullingView& view) {
  view_ = view;
  columns_ = (view.width + kSide - 1) / kSide;
  rows_ = (view.height + kSide - 1) / kSide;
  farthest_.assign(static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_), 1.0f);
}

void DepthTiles::read() {
  if (view_.depth_bits == 16) {
    find_farthest(depths16_, GL_UNSIGNED_SHORT);
  } else {
    find_farthest(depths32_, GL_UNSIGNED_INT);
  }
}

template <class Depth>
void DepthTiles::find_farthest(std::vector<Depth>& depths, GLenum type) {
  const auto width = static_cast<std::size_t>(view_.width);
  const auto height = static_cast<std::size_t>(view_.height);
  depths.resize(width * height);
  gl_.ReadPixels(0, 0, view_.width, view_.height, GL_DEPTH_COMPONENT, type, depths.data());
  for_chunks(height, kSide, [&](std::size_t begin, std::size_t end, std::size_t row) {
    for (std::size_t column = 0; column < static_cast<std::size_t>(columns_); ++column) {
      const std::size_t first = column * kSide;
      const std::size_t last = std::min(first + kSide, width);
      Depth farthest = 0;
      for (std::size_t y = begin; y < end; ++y) {
        for (std::size_t x = first; x < last; ++x) {
          farthest = std::max(farthest, depths[y * width + x]);
        }
      }
      farthest_[row * static_cast<std::size_t>(columns_) + column] =
          static_cast<float>(farthest) / static_cast<float>(std::numeric_limits<Depth>::max());
    }
  });
}

bool DepthTiles::hides(const OrientedBox& box) const {
  // Conservative bounds: each homogeneous coordinate is bounded independently of the others.
  const auto& to = view_.picture_of_eye;
  const Eigen::Vector4f middle = to.leftCols<3>() * box.center + to.col(3);
  const Eigen::Vector4f reach = (to.leftCols<3>() * box.half_axes).cwiseAbs().rowwise().sum();
  const Eigen::Vector4f least = middle - reach, most = middle + reach;
  if (!(least.w() > 0)) return false;
  const auto lowest = [&](int i) { return least[i] / (least[i] < 0 ? least.w() : most.w()); };
  const auto highest = [&](int i) { return most[i] / (most[i] > 0 ? least.w() : most.w()); };
  const Eigen::Vector2f low(lowest(0), lowest(1)), high(highest(0), highest(1));
  const float near = least.z() / least.w();  // depth of the nearest point
  if (near < 0) return false;                // the box crosses the near plane
  const auto tile = [](float at, float slack, int pixels, int tiles) {
    const float pixel = at * static_cast<float>(pixels) + slack;
    return static_cast<int>(std::clamp(std::floor(pixel / kSide), -1.f, static_cast<float>(tiles)));
  };
  const int left = std::max(tile(low.x(), -kPixelTolerance, view_.width, columns_), 0);
  const int right = std::min(tile(high.x(), kPixelTolerance, view_.width, columns_), columns_ - 1);
  const int bottom = std::max(tile(low.y(), -kPixelTolerance, view_.height, rows_), 0);
  const int top = std::min(tile(high.y(), kPixelTolerance, view_.height, rows_), rows_ - 1);
  for (int row = bottom; row <= top; ++row) {
    const float* farthest =
        farthest_.data() + static_cast<std::size_t>(row) * static_cast<std::size_t>(columns_);
    float most_far = 0;
    for (int column = left; column <= right; ++column) {
      most_far = std::max(most_far, farthest[column]);
    }
    if (near < most_far + kDepthTolerance) return false;
  }
  return true;
}

}  // namespace sunder::render
