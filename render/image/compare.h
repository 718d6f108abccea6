// Comparison of two images (golden tests).
#pragma once

#include "render/image/image.h"

namespace sunder::render {

struct Thresholds {
  double flip_mean = 0.01;
  int window_pixels = 24;  ///< Pixels that differ by more than 8 levels in any 32x32 window.
};

struct Difference {
  bool same_bytes = false;
  bool same_size = false;
  double flip_mean = 0;         ///< Mean LDR-FLIP error (Andersson et al. 2020).
  int worst_window_pixels = 0;  ///< Differing pixels in the 32x32 window that has most of them.
  int worst_window_x = 0;       ///< Left of that window.
  int worst_window_y = 0;       ///< Top of that window.
  Image heat_map;               ///< Map of the FLIP error; empty if same_bytes or not same_size.

  bool passes(const Thresholds& thresholds) const {
    return same_bytes || (same_size && flip_mean <= thresholds.flip_mean &&
                          worst_window_pixels <= thresholds.window_pixels);
  }
  /// Returns the larger one of the two figures as a fraction of its threshold, 0 for equal images;
  /// at most 1 if the difference passes, infinite for another size.
  double share_of(const Thresholds& thresholds) const;
};

/// Compares two images. Those with transparent pixels are compared before black and before white,
/// and the larger one of each figure counts.
Difference compare(const Image& reference, const Image& actual);

}  // namespace sunder::render
