#include "fracture/vacd/sweep_hull.h"

#include <algorithm>
#include <cmath>

#include "engine/base/hash.h"

namespace sunder::fracture {
namespace {

/// Distances, areas and volumes below this share of the size's power are rounding errors.
constexpr double kFlat = 1e-12;
/// Number of faces evaluated together.
constexpr std::size_t kBlock = 16;
/// Points are moved by up to this share of the size: many points of slices and of regular solids
/// are coplanar, and rounding would decide which faces are visible from them.
constexpr double kPerturbation = 1e-5;

/// Returns three pseudorandom numbers in [-1, 1) that depend only on `number`.
Vec3 pseudorandom(std::uint64_t number) {
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
  pending_.clear();
  faces_.clear();
  free_.clear();
  for (auto* column : {&x_, &y_, &z_, &d_, &gain_}) column->clear();
}

bool SweepHull::add(const Vec3& point, double least_m3) {
  const Vec3 moved = point - origin_ + kPerturbation * size_ * pseudorandom(++count_);
  return faces_.empty() ? start(moved) : grow(moved, least_m3);
}

/// Collects the first four points that span a volume, and then adds the points kept meanwhile.
bool SweepHull::start(const Vec3& point) {
  const auto apart = [&] {
    if (points_.empty()) return true;
    const Vec3 a = point - points_[0];
    if (points_.size() == 1) return a.norm() > kFlat * size_;
    const Vec3 ab = points_[1] - points_[0];
    if (points_.size() == 2) return ab.cross(a).norm() > kFlat * size_ * size_;
    return std::abs(ab.cross(points_[2] - points_[0]).dot(a)) > kFlat * size_ * size_ * size_;
  };
  if (!apart()) {
    pending_.push_back(point);
    return true;
  }
  points_.push_back(point);
  if (points_.size() < 4) return true;
  const Vec3 a = points_[0];
  const double volume6 = (points_[1] - a).cross(points_[2] - a).dot(point - a);
  if (volume6 > 0) std::swap(points_[1], points_[2]);
  constexpr std::array<std::uint32_t, 3> kVertices[4] = {
      {0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}};
  constexpr std::array<std::uint32_t, 3> kNeighbours[4] = {
      {2, 3, 1}, {0, 3, 2}, {1, 3, 0}, {2, 1, 0}};
  for (std::size_t f = 0; f < 4; ++f) {
    const auto [i, j, k] = kVertices[f];
    const std::uint32_t slot = new_slot();
    set_face(slot, i, j, k);
    faces_[slot].neighbours = kNeighbours[f];
  }
  volume_ = std::abs(volume6) / 6;
  for (const Vec3& late : pending_) grow(late, 0);
  return true;
}

bool SweepHull::grow(const Vec3& point, double least_m3) {
  const double gain = find_visible(point);
  if (!(gain > 6 * least_m3) || !find_border()) return false;
  volume_ += gain / 6;
  points_.push_back(point);
  build_fan();
  return true;
}

/// Sets visible_ to the visible faces; returns six times the volume that the point would add.
double SweepHull::find_visible(const Vec3& point) {
  const double px = point.x(), py = point.y(), pz = point.z();
  visible_.clear();
  double sum = 0;
  for (std::size_t block = 0; block < gain_.size(); block += kBlock) {
    int any = 0;
    for (std::size_t f = block; f < block + kBlock; ++f) {
      const double gain = x_[f] * px + y_[f] * py + z_[f] * pz + d_[f];
      gain_[f] = gain;
      any |= gain > 0;
    }
    if (!any) continue;
    for (std::size_t f = block; f < block + kBlock; ++f) {
      if (!(gain_[f] > 0)) continue;
      visible_.push_back(static_cast<std::uint32_t>(f));
      sum += gain_[f];
    }
  }
  return sum;
}

/// Sets border_; returns false unless it is one loop, which rounding on a flat hull may prevent.
bool SweepHull::find_border() {
  border_.clear();
  border_at_.resize(points_.size());
  for (const std::uint32_t f : visible_) {
    const Face& face = faces_[f];
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t beyond = face.neighbours[i];
      if (gain_[beyond] > 0) continue;
      border_at_[face.vertices[i]] = static_cast<std::uint32_t>(border_.size());
      border_.push_back({face.vertices[i], face.vertices[(i + 1) % 3], beyond, 0});
    }
  }
  if (border_.size() < 3) return false;
  std::uint32_t edge = 0;
  std::size_t steps = 0;
  do {
    const std::uint32_t next = border_at_[border_[edge].to];
    if (next >= border_.size() || border_[next].from != border_[edge].to) return false;
    edge = next;
  } while (edge != 0 && ++steps <= border_.size());
  return steps + 1 == border_.size();
}

/// Replaces the visible faces by triangles from the border to the last point.
void SweepHull::build_fan() {
  for (const std::uint32_t f : visible_) {
    x_[f] = y_[f] = z_[f] = 0;
    d_[f] = -1;
    free_.push_back(f);
  }
  const auto apex = static_cast<std::uint32_t>(points_.size() - 1);
  for (Border& edge : border_) {
    edge.face = new_slot();
    set_face(edge.face, edge.from, edge.to, apex);
  }
  for (const Border& edge : border_) {
    const std::uint32_t next = border_[border_at_[edge.to]].face;
    faces_[edge.face].neighbours[0] = edge.beyond;
    faces_[edge.face].neighbours[1] = next;
    faces_[next].neighbours[2] = edge.face;
    Face& beyond = faces_[edge.beyond];
    const std::size_t side = beyond.vertices[0] == edge.to   ? 0
                             : beyond.vertices[1] == edge.to ? 1
                                                             : 2;
    beyond.neighbours[side] = edge.face;
  }
}

std::uint32_t SweepHull::new_slot() {
  if (!free_.empty()) {
    const std::uint32_t slot = free_.back();
    free_.pop_back();
    return slot;
  }
  const auto slot = static_cast<std::uint32_t>(faces_.size());
  faces_.emplace_back();
  if (slot == gain_.size()) {
    for (auto* column : {&x_, &y_, &z_, &gain_}) column->resize(slot + kBlock, 0);
    d_.resize(slot + kBlock, -1);
  }
  return slot;
}

void SweepHull::set_face(std::uint32_t slot, std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  const Vec3& apex = points_[a];
  const Vec3 normal = (points_[b] - apex).cross(points_[c] - apex);
  faces_[slot].vertices = {a, b, c};
  x_[slot] = normal.x();
  y_[slot] = normal.y();
  z_[slot] = normal.z();
  d_[slot] = -normal.dot(apex);
}

}  // namespace sunder::fracture
