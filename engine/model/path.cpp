#include "engine/model/path.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "engine/base/cubic.h"

namespace sunder {
namespace {

using Vec6 = Eigen::Matrix<double, 6, 1>;

Vec6 pose_of(const PathKey& key) {
  Vec6 pose;
  pose << key.shift_W, key.rotation_W;
  return pose;
}

}  // namespace

PathKey Path::at(double time_s) const {
  if (keys.empty()) return {time_s};
  const double end_s = keys.back().time_s;
  const double now_s = loops ? std::fmod(time_s, end_s) : std::clamp(time_s, 0.0, end_s);
  const auto next = std::ranges::find_if(keys, [&](const PathKey& k) { return k.time_s >= now_s; });
  const auto count = static_cast<std::ptrdiff_t>(keys.size());
  const std::ptrdiff_t n = next - keys.begin();
  const auto key = [&](std::ptrdiff_t i) {
    return i < 0 ? PathKey{} : keys[static_cast<std::size_t>(i)];
  };
  const auto length_s = [&](std::ptrdiff_t i) { return key(i).time_s - key(i - 1).time_s; };
  const auto line = [&](std::ptrdiff_t i) -> Vec6 {  // to key i
    return (pose_of(key(i)) - pose_of(key(i - 1))) / length_s(i);
  };
  const auto slope = [&](std::ptrdiff_t i) -> Vec6 {  // at key i
    const std::ptrdiff_t before = i < 0 ? count - 1 : i, after = i + 1 == count ? 0 : i + 1;
    if (!loops && (i < 0 || i + 1 == count)) return Vec6::Zero();
    return monotone_slope(line(before), length_s(before), line(after), length_s(after));
  };
  const double h = length_s(n), s = (now_s - key(n - 1).time_s) / h;
  Vec6 pose = pose_of(key(n - 1)) + h * s * line(n);
  if (smooth) {
    pose += h * cubic_offset<Vec6>(s, line(n), slope(n - 1), slope(n));
  }
  return {time_s, pose.head<3>(), pose.tail<3>()};
}

}  // namespace sunder
