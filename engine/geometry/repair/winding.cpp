#include "engine/geometry/repair/winding.h"

#include <algorithm>
#include <cmath>

namespace sunder {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr std::uint32_t kLeafSize = 8;
/// Distance of a node in radii beyond which it is approximated by a dipole.
constexpr double kDipoleDistance = 2.2;

Vec3 centroid(const std::array<Vec3, 3>& t) { return (t[0] + t[1] + t[2]) / 3; }

/// Returns the angle of (x, y) in rad with an error of at most 2e-5, which suffices to tell inside
/// from outside, several times faster than arc_tangent().
double approximate_angle(double y, double x) {
  const double abs_y = std::abs(y), abs_x = std::abs(x);
  const double longer = std::max(abs_y, abs_x);
  if (!(longer > 0)) return 0;
  const double t = std::min(abs_y, abs_x) / longer, z = t * t;
  // Minimax polynomial (Hastings 1955).
  const double slope =
      (((0.0208351 * z - 0.0851330) * z + 0.1801410) * z - 0.3302995) * z + 0.9998660;
  const double angle = abs_y > abs_x ? kPi / 2 - slope * t : slope * t;
  const double upper = x < 0 ? kPi - angle : angle;
  return y < 0 ? -upper : upper;
}

/// Returns the signed solid angle of a triangle in sr (van Oosterom and Strackee 1983).
double solid_angle(const std::array<Vec3, 3>& t, const Vec3& point) {
  const Vec3 a = t[0] - point, b = t[1] - point, c = t[2] - point;
  const double la = a.norm(), lb = b.norm(), lc = c.norm();
  const double sine_part = a.dot(b.cross(c));
  const double cosine_part = la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb;
  return 2 * approximate_angle(sine_part, cosine_part);
}

}  // namespace

WindingField::WindingField(std::vector<std::array<Vec3, 3>> triangles)
    : triangles_(std::move(triangles)) {
  if (!triangles_.empty()) build(0, static_cast<std::uint32_t>(triangles_.size()));
}

void WindingField::build(std::uint32_t first, std::uint32_t count) {
  const std::size_t index = nodes_.size();
  Node node;
  node.first = first;
  node.count = count;
  node.leaf = count <= kLeafSize;
  compute_dipole(node);
  nodes_.push_back(node);
  if (!node.leaf) {
    Box box;
    for (std::uint32_t i = first; i < first + count; ++i) box.extend(centroid(triangles_[i]));
    Eigen::Index axis = 0;
    box.extent().maxCoeff(&axis);
    const auto begin = triangles_.begin() + first;
    const std::uint32_t half = count / 2;
    std::nth_element(begin, begin + half, begin + count, [axis](const auto& a, const auto& b) {
      return centroid(a)[axis] < centroid(b)[axis];
    });
    build(first, half);
    build(first + half, count - half);
  }
  nodes_[index].next = static_cast<std::uint32_t>(nodes_.size());
}

void WindingField::compute_dipole(Node& node) const {
  double total = 0;
  Vec3 mean = Vec3::Zero();
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    const auto& t = triangles_[i];
    const Vec3 area = 0.5 * (t[1] - t[0]).cross(t[2] - t[0]);
    node.area += area;
    node.center += area.norm() * centroid(t);
    mean += centroid(t) / node.count;
    total += area.norm();
  }
  node.center = total > 0 ? Vec3(node.center / total) : mean;
  for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
    for (const Vec3& p : triangles_[i]) {
      node.radius = std::max(node.radius, (p - node.center).norm());
    }
  }
}

/// Calls `far(node)` for nodes approximated by a dipole, and `near(leaf)` for other leaves.
template <class Far, class Near>
void WindingField::visit_nodes(const Vec3& point, const Far& far, const Near& near) const {
  for (std::size_t n = 0; n < nodes_.size();) {
    const Node& node = nodes_[n];
    const double reach = kDipoleDistance * node.radius;
    const bool is_far = (node.center - point).squaredNorm() > reach * reach;
    if (is_far) {
      far(node);
    } else if (node.leaf) {
      near(node);
    }
    n = is_far || node.leaf ? node.next : n + 1;
  }
}

double WindingField::at(const Vec3& point) const {
  double angle = 0;
  const auto dipole = [&](const Node& node) {
    const Vec3 away = node.center - point;
    const double square = away.squaredNorm();
    angle += away.dot(node.area) / (square * std::sqrt(square));
  };
  const auto triangles = [&](const Node& leaf) {
    for (std::uint32_t i = leaf.first; i < leaf.first + leaf.count; ++i) {
      angle += solid_angle(triangles_[i], point);
    }
  };
  visit_nodes(point, dipole, triangles);
  return angle / (4 * kPi);
}

std::size_t WindingField::work_at(const Vec3& point) const {
  std::size_t work = 0;
  visit_nodes(
      point, [&](const Node&) { ++work; }, [&](const Node& leaf) { work += leaf.count; });
  return work;
}

}  // namespace sunder
