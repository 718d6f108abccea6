#include "engine/model/view_path.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "engine/base/cubic.h"

namespace sunder {
namespace {

using Vec7 = Eigen::Matrix<double, 7, 1>;

struct Knot {
  /// Camera at a key, with all members set.
  double time_s = 0;
  Vec7 camera;  ///< Eye, target, field of view.
};

std::vector<Knot> knots_of(std::span<const ViewKey> keys, const View& view) {
  std::vector<Knot> knots;
  Vec7 camera;
  camera << view.eye_W, view.target_W, view.fov_rad;
  for (const ViewKey& key : keys) {
    if (key.eye_W) camera.head<3>() = *key.eye_W;
    if (key.target_W) camera.segment<3>(3) = *key.target_W;
    if (key.fov_rad) camera[6] = *key.fov_rad;
    knots.push_back({key.time_s, camera});
  }
  return knots;
}

double length_s(std::span<const Knot> knots, std::size_t i) {
  return knots[i].time_s - knots[i - 1].time_s;
}

/// Returns the slope of the straight line to a knot.
Vec7 line_to(std::span<const Knot> knots, std::size_t i) {
  return (knots[i].camera - knots[i - 1].camera) / length_s(knots, i);
}

Vec7 slope_at(std::span<const Knot> knots, std::size_t i) {
  if (i == 0 || i + 1 == knots.size()) return Vec7::Zero();
  return monotone_slope<Vec7>(line_to(knots, i), length_s(knots, i), line_to(knots, i + 1),
                              length_s(knots, i + 1));
}

Vec7 camera_at(std::span<const Knot> knots, double time_s) {
  const auto next =
      std::ranges::find_if(knots, [&](const Knot& knot) { return knot.time_s > time_s; });
  if (next == knots.begin()) return knots.front().camera;
  if (next == knots.end()) return knots.back().camera;
  const auto n = static_cast<std::size_t>(next - knots.begin());
  const double h = length_s(knots, n), s = (time_s - knots[n - 1].time_s) / h;
  const Vec7 line = line_to(knots, n);
  return knots[n - 1].camera + h * s * line +
         h * cubic_offset<Vec7>(s, line, slope_at(knots, n - 1), slope_at(knots, n));
}

}  // namespace

View along(std::span<const ViewKey> keys, const View& view, double time_s) {
  if (keys.empty()) return view;
  const Vec7 camera = camera_at(knots_of(keys, view), time_s);
  View there = view;
  there.eye_W = camera.head<3>();
  there.target_W = camera.segment<3>(3);
  there.fov_rad = camera[6];
  return there;
}

}  // namespace sunder
