#include "solver/rigid/collide/facet.h"

namespace sunder::solver {
namespace {

constexpr float kDirectionRounding = 1e-4f;  // between triangles in one plane
// number of side faces, which follow the front; the back is last
constexpr std::uint32_t kSides = 3;

}  // namespace

SeparatingAxis front_axis(const Hull& facet, float separation_m) {
  return {SeparatingAxis::Kind::kFaceA, facet.normal(0), separation_m, 0, 0};
}

/// Tests the edge that the direction leans over most.
bool normal_to_surface(const Shape& facet, const Vec3f& normal_A) {
  const float up = facet.hull.normal(0).dot(normal_A);
  if (up < -kDirectionRounding) return false;
  std::uint32_t side = 0;
  float most = -1;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    const float over = facet.hull.normal(1 + i).dot(normal_A);
    if (over > most) most = over, side = i;
  }
  const Eigen::Vector2f& bend = facet.bends[side];
  return bend.x() * most - bend.y() * up <= kDirectionRounding;
}

bool before_back(const Hull& facet, const Vec3f& point_A) {
  return facet.normal(kSides + 1).dot(point_A) + facet.plane_d(kSides + 1) < 0;
}

bool over_triangle(const Shape& facet, const Vec3f& point_A, float tolerance_m, bool on_the_way) {
  const Hull& hull = facet.hull;
  for (std::uint32_t i = 0; i < kSides; ++i) {
    if (on_the_way && facet.bends[i].y() <= 0) continue;
    if (hull.normal(1 + i).dot(point_A) + hull.plane_d(1 + i) > tolerance_m) return false;
  }
  return true;
}

float depth_m(const Hull& facet) { return -facet.plane_d(0) - facet.plane_d(kSides + 1); }

}  // namespace sunder::solver
