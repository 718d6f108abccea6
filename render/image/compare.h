// Whether two images look the same (golden tests).
#pragma once

#include "render/image/image.h"

namespace sunder::render {

struct Thresholds {
  double flip_mean = 0.01;
  int window_pixels = 24;  ///< Pixels off by more than 8 levels in any 32x32 window.
};

struct Difference {
  bool same_bytes = false;
  bool same_size = false;
  double flip_mean = 0;  ///< FLIP (Andersson et al. 2020), LDR, mean error.
  int worst_window_pixels = 0;
  int worst_window_x = 0;  ///< Its left and top.
  int worst_window_y = 0;
  Image heat_map;  ///< Of the FLIP error; empty if same_bytes or not same_size.

  bool passes(const Thresholds& thresholds) const {
    return same_bytes || (same_size && flip_mean <= thresholds.flip_mean &&
                          worst_window_pixels <= thresholds.window_pixels);
  }
};

Difference compare(const Image& reference, const Image& actual);

}  // namespace sunder::render
