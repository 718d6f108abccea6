#include "engine/geometry/triangulate.h"

#include <algorithm>
#include <numeric>

namespace sunder {
namespace {

/// Most corners of contours triangulated with least area, and by ear clipping.
constexpr std::size_t kMaxLeastAreaCorners = 64, kMaxEarClippingCorners = 2000;
/// Bound of the number of ear tests of a contour, for each of its corners.
constexpr std::size_t kMaxTriesPerCorner = 16;

/// Returns the area plus a small penalty for thin triangles, which decides between equal areas.
double cost(const Vec3& a, const Vec3& b, const Vec3& c) {
  const double area = 0.5 * (b - a).cross(c - a).norm();
  const double longest =
      std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  if (!(longest > 0)) return 0;
  return area + 1e-8 * longest * std::min(1e4, longest / std::max(area, 1e-300));
}

/// Returns the triangulation of least cost, by dynamic programming (Barequet and Sharir 1995).
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

/// Ear clipping of the contour projected to the plane that fits best.
class EarClipper {
 public:
  explicit EarClipper(std::span<const Vec3> contour) : remaining_(contour.size()) {
    std::iota(remaining_.begin(), remaining_.end(), 0u);
    Vec3 normal = Vec3::Zero();
    for (std::size_t i = 1; i < contour.size(); ++i) {
      normal += (contour[i - 1] - contour[0]).cross(contour[i] - contour[0]);
    }
    const Vec3 up = normal.norm() > 0 ? normal.normalized() : Vec3(Vec3::UnitZ());
    const Vec3 x = up.unitOrthogonal(), y = up.cross(x);
    for (const Vec3& p : contour) projected_.emplace_back(x.dot(p), y.dot(p));
  }

  std::vector<Triangle> clip() {
    std::vector<Triangle> triangles;
    std::size_t at = 0, rejected = 0, tries = kMaxTriesPerCorner * remaining_.size();
    while (remaining_.size() > 3) {
      const std::size_t n = remaining_.size();
      at %= n;
      const Triangle ear = {remaining_[(at + n - 1) % n], remaining_[at], remaining_[(at + 1) % n]};
      // If there is no ear (the contour crosses itself) any corner is cut: the result stays closed.
      if (rejected < n && tries > 0 && !is_ear(ear)) {
        ++at;
        ++rejected;
        --tries;
        continue;
      }
      triangles.push_back(ear);
      remaining_.erase(remaining_.begin() + static_cast<std::ptrdiff_t>(at));
      ++at;  // spreads the ears along the contour
      rejected = 0;
    }
    triangles.push_back({remaining_[0], remaining_[1], remaining_[2]});
    return triangles;
  }

 private:
  double orientation(std::uint32_t a, std::uint32_t b, std::uint32_t c) const {
    const Vec2 ab = projected_[b] - projected_[a], ac = projected_[c] - projected_[a];
    return ab.x() * ac.y() - ab.y() * ac.x();
  }
  bool is_ear(const Triangle& ear) const {
    if (!(orientation(ear[0], ear[1], ear[2]) > 0)) return false;
    return std::none_of(remaining_.begin(), remaining_.end(), [&](std::uint32_t v) {
      return v != ear[0] && v != ear[1] && v != ear[2] && orientation(ear[0], ear[1], v) >= 0 &&
             orientation(ear[1], ear[2], v) >= 0 && orientation(ear[2], ear[0], v) >= 0;
    });
  }

  std::vector<std::uint32_t> remaining_;
  std::vector<Vec2> projected_;
};

}  // namespace

std::vector<Triangle> triangulate(std::span<const Vec3> contour) {
  if (contour.size() < 3) return {};
  if (contour.size() <= kMaxLeastAreaCorners) return least_area(contour);
  if (contour.size() <= kMaxEarClippingCorners) return EarClipper(contour).clip();
  std::vector<Triangle> fan;
  for (std::uint32_t i = 2; i < contour.size(); ++i) fan.push_back({0, i - 1, i});
  return fan;
}

}  // namespace sunder
