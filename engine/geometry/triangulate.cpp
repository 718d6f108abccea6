#include "engine/geometry/triangulate.h"

#include <algorithm>
#include <numeric>

namespace sunder {
namespace {

constexpr std::size_t kMostForLeastArea = 64, kMostForEars = 2000;
/// Corners tried as ears, for each corner.
constexpr std::size_t kMostTries = 16;

/// Area, plus a little for needles, so that equal areas are divided well.
double cost(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double area = 0.5 * (b - a).cross(c - a).norm();
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  if (!(longest > 0)) return 0;
  return area + 1e-8 * longest * std::min(1e4, longest / std::max(area, 1e-300));
}

/// Dynamic programming over chords (Barequet and Sharir 1995).
std::vector<Triangle> least_area(std::span<const Vec3> contour) {
  const std::size_t n = contour.size();
  std::vector<double> best(n * n, 0);
  std::vector<std::uint32_t> apex(n * n, 0);
  for (std::size_t span = 2; span < n; ++span) {
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t k = i + span;
      double least = 1e300;
      for (std::size_t j = i + 1; j < k; ++j) {
        const double sum =
            best[i * n + j] + best[j * n + k] + cost(contour[i], contour[j], contour[k]);
        if (sum >= least) continue;
        least = sum;
        apex[i * n + k] = static_cast<std::uint32_t>(j);
      }
      best[i * n + k] = least;
    }
  }
  std::vector<Triangle> triangles;
  std::vector<std::pair<std::uint32_t, std::uint32_t>> chords = {
      {0, static_cast<std::uint32_t>(n - 1)}};
  while (!chords.empty()) {
    const auto [i, k] = chords.back();
    chords.pop_back();
    if (k - i < 2) continue;
    const std::uint32_t j = apex[i * n + k];
    triangles.push_back({i, j, k});
    chords.emplace_back(i, j);
    chords.emplace_back(j, k);
  }
  return triangles;
}

/// Ear clipping in the plane that fits best.
class EarClipper {
 public:
  explicit EarClipper(std::span<const Vec3> contour) : left_(contour.size()) {
    std::iota(left_.begin(), left_.end(), 0u);
    Vec3 normal = Vec3::Zero();
    for (std::size_t i = 1; i < contour.size(); ++i) {
      normal += (contour[i - 1] - contour[0]).cross(contour[i] - contour[0]);
    }
    const Vec3 up = normal.norm() > 0 ? normal.normalized() : Vec3(Vec3::UnitZ());
    const Vec3 x = up.unitOrthogonal(), y = up.cross(x);
    for (const Vec3& p : contour) flat_.emplace_back(x.dot(p), y.dot(p));
  }

  std::vector<Triangle> clip() {
    std::vector<Triangle> triangles;
    std::size_t at = 0, refused = 0, tries = kMostTries * left_.size();
    while (left_.size() > 3) {
      const std::size_t n = left_.size();
      at %= n;
      const Triangle ear = {left_[(at + n - 1) % n], left_[at], left_[(at + 1) % n]};
      // Where no ear is left (the contour crosses itself) any will do: the result stays closed.
      if (refused < n && tries > 0 && !is_ear(ear)) {
        ++at;
        ++refused;
        --tries;
        continue;
      }
      triangles.push_back(ear);
      left_.erase(left_.begin() + static_cast<std::ptrdiff_t>(at));
      ++at;  // spreads the ears around
      refused = 0;
    }
    triangles.push_back({left_[0], left_[1], left_[2]});
    return triangles;
  }

 private:
  double orientation(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Vec2 ab = flat_[b] - flat_[a], ac = flat_[c] - flat_[a];
    return ab.x() * ac.y() - ab.y() * ac.x();
  }
  bool is_ear(const Triangle& ear) const {
    if (!(orientation(ear[0], ear[1], ear[2]) > 0)) return false;
    return std::none_of(left_.begin(), left_.end(), [&](std::uint32_t v) {
      return v != ear[0] && v != ear[1] && v != ear[2] && orientation(ear[0], ear[1], v) >= 0 &&
             orientation(ear[1], ear[2], v) >= 0 && orientation(ear[2], ear[0], v) >= 0;
    });
  }

  std::vector<std::uint32_t> left_;
  std::vector<Vec2> flat_;
};

}  // namespace

std::vector<Triangle> triangulate(std::span<const Vec3> contour) {
  if (contour.size() < 3) return {};
  if (contour.size() <= kMostForLeastArea) return least_area(contour);
  if (contour.size() <= kMostForEars) return EarClipper(contour).clip();
  std::vector<Triangle> fan;
  for (std::uint32_t i = 2; i < contour.size(); ++i) fan.push_back({0, i - 1, i});
  return fan;
}

}  // namespace sunder
