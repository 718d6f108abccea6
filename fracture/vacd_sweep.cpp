#include "fracture/vacd_sweep.h"

#include <algorithm>
#include <cmath>

#include "engine/base/hash.h"

namespace sunder::fracture {
namespace {

/// Volumes below this share of the size's cube are rounding.
constexpr double kNothing = 1e-12;
/// Points are moved by up to this share of the size: of slices and of well-made solids many lie in
/// one plane, and rounding would decide which faces each of them sees.
constexpr double kJoggle = 1e-5;

/// Of a number, three of its own in [-1, 1).
Vec3 scattered(std::uint64_t number) {
  const std::uint64_t bits = mix(number);
  constexpr std::uint64_t kMask = (1u << 21) - 1;
  const Vec3 parts(static_cast<double>(bits & kMask), static_cast<double>((bits >> 21) & kMask),
                   static_cast<double>((bits >> 42) & kMask));
  return parts * 0x1p-20 - Vec3::Ones();
}

}  // namespace

void SweepHull::restart(const Vec3& origin, double size_m) {
  origin_ = origin;
  size_ = size_m;
  volume_ = 0;
  count_ = 0;
  points_.clear();
  waiting_.clear();
  faces_.clear();
  for (auto* column : {&x_, &y_, &z_, &d_}) column->clear();
}

bool SweepHull::add(const Vec3& point, double least_m3) {
  const Vec3 moved = point - origin_ + kJoggle * size_ * scattered(++count_);
  return faces_.empty() ? start(moved) : grow(moved, least_m3);
}

/// Collects the first four points that span a volume, and then adds those that had to wait.
bool SweepHull::start(const Vec3& point) {
  const auto apart = [&] {
    if (points_.empty()) return true;
    const Vec3 a = point - points_[0];
    if (points_.size() == 1) return a.norm() > kNothing * size_;
    const Vec3 ab = points_[1] - points_[0];
    if (points_.size() == 2) return ab.cross(a).norm() > kNothing * size_ * size_;
    return std::abs(ab.cross(points_[2] - points_[0]).dot(a)) > kNothing * size_ * size_ * size_;
  };
  if (!apart()) {
    waiting_.push_back(point);
    return true;
  }
  points_.push_back(point);
  if (points_.size() < 4) return true;
  const Vec3 a = points_[0];
  const double volume6 = (points_[1] - a).cross(points_[2] - a).dot(point - a);
  if (volume6 > 0) std::swap(points_[1], points_[2]);
  add_face(0, 1, 2);
  add_face(0, 2, 3);
  add_face(0, 3, 1);
  add_face(1, 3, 2);
  volume_ = std::abs(volume6) / 6;
  for (const Vec3& late : waiting_) grow(late, 0);
  return true;
}

bool SweepHull::grow(const Vec3& point, double least_m3) {
  const std::size_t count = faces_.size();
  gain_.resize(count);
  const double px = point.x(), py = point.y(), pz = point.z();
  for (std::size_t f = 0; f < count; ++f) {
    gain_[f] = x_[f] * px + y_[f] * py + z_[f] * pz + d_[f];
  }
  seen_.clear();
  double gain = 0;
  for (std::size_t f = 0; f < count; ++f) {
    if (!(gain_[f] > 0)) continue;
    seen_.push_back(static_cast<std::uint32_t>(f));
    gain += gain_[f];
  }
  if (!(gain > 6 * least_m3)) return false;
  horizon_.clear();
  for (const std::uint32_t f : seen_) {
    const auto [a, b, c] = faces_[f];
    toggle(a, b);
    toggle(b, c);
    toggle(c, a);
  }
  // The border of a disc of triangles is no longer; rounding on a flat hull may see more than one.
  if (horizon_.size() > seen_.size() + 2) return false;
  volume_ += gain / 6;
  for (auto f = seen_.rbegin(); f != seen_.rend(); ++f) drop_face(*f);
  const auto apex = static_cast<std::uint32_t>(points_.size());
  points_.push_back(point);
  for (const auto& [from, to] : horizon_) add_face(from, to, apex);
  return true;
}

/// Keeps an edge unless its opposite is there, which then goes: what is left at the end is the
/// border of the faces seen.
void SweepHull::toggle(std::uint32_t from, std::uint32_t to) {
  for (Edge& edge : horizon_) {
    if (edge.first != to || edge.second != from) continue;
    edge = horizon_.back();
    horizon_.pop_back();
    return;
  }
  horizon_.emplace_back(from, to);
}

void SweepHull::add_face(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Vec3& apex = points_[a];
  const Vec3 normal = (points_[b] - apex).cross(points_[c] - apex);
  faces_.push_back({a, b, c});
  x_.push_back(normal.x());
  y_.push_back(normal.y());
  z_.push_back(normal.z());
  d_.push_back(-normal.dot(apex));
}

void SweepHull::drop_face(std::size_t face) {
  faces_[face] = faces_.back();
  faces_.pop_back();
  for (auto* column : {&x_, &y_, &z_, &d_}) {
    (*column)[face] = column->back();
    column->pop_back();
  }
}

}  // namespace sunder::fracture
