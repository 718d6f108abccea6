#include "fracture/plug.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/base/roots.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

// Minimum thickness of a plate in the range of the formula of perforation_energy_J(), as a fraction
// of the striker's width.
constexpr double kMinPlugThickness = 1 / 4.17;

/// Returns the area (positive if counter-clockwise in x and z) and the centroid of a polygon.
std::pair<double, Vec2> measure(const std::vector<Vec2>& polygon) {
  double twice_m2 = 0;
  Vec2 moment = Vec2::Zero();
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
    const double part = a.x() * b.y() - a.y() * b.x();
    twice_m2 += part;
    moment += part * (a + b);
  }
  return {twice_m2 / 2, moment / (3 * twice_m2)};
}

double perimeter_m(const std::vector<Vec2>& polygon) {
  double sum_m = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
    sum_m += (polygon[(i + 1) % polygon.size()] - polygon[i]).norm();
  return sum_m;
}

/// Returns a rotation with second column `y` and the first as close as possible to `near_x`.
Mat3 axes_along(const Vec3& y, const Vec3& near_x) {
  const Vec3 x = (near_x - near_x.dot(y) * y).normalized();
  Mat3 axes;
  axes << x, y, x.cross(y);
  return axes;
}

/// Returns the length of the cracks of a web of `rings` rings, seen along the axis.
double crack_length_m(const Plug& plug, double radius_m, int rings) {
  double length_m = static_cast<double>(plug.section_m.size()) * (plug.reach_m - radius_m);
  for (int ring = 0; ring <= rings; ++ring)
    length_m +=
        2 * std::numbers::pi * radius_m *
        positive_power(plug.reach_m / radius_m, static_cast<double>(ring) / std::max(1, rings));
  return length_m;
}

/// Adds as many rings as the remaining energy pays for: to a web, as far as cracks run while the
/// striker passes; to other patterns one ring, if the far face spalls.
void add_rings(const Material& material, const StructureImpact& hit, double radius_m, Plug& plug) {
  const double left_J = kCrackShare * (hit.energy_J - plug.energy_J);
  const double affordable_m = left_J / (material.toughness_J_m2 * plug.depth_m);
  const bool is_web = cracks_run_out(material.pattern);
  const double run_m =
      kCrackSpeed * material.shear_wave_m_s() * (plug.depth_m + 2 * radius_m) / hit.speed_m_s;
  const double most_m = is_web ? material.impact_radius_m : kSpallRingWidth * radius_m;
  plug.reach_m = std::min({radius_m + run_m, material.impact_radius_m, most_m});
  const int most = is_web ? kMaxPlugRings : hit.energy_J > kMinSpallEnergy * plug.energy_J ? 1 : 0;
  if (!(plug.reach_m > kMinCrackReach * radius_m)) return;
  while (plug.rings < most && crack_length_m(plug, radius_m, plug.rings + 1) < affordable_m)
    ++plug.rings;
}

/// Shortens a plug that the striker cannot drive out to a crater of the impact's energy, and
/// narrows its section to that of a round nose; updates `width_m` and `area_m2`. Returns false if
/// the solid is too narrow there and breaks as a whole.
bool become_crater(const StructureImpact& hit, double& width_m, double& area_m2, Plug& plug) {
  const double share = kMaxPerforationShare * hit.energy_J / plug.energy_J;
  plug.energy_J *= share;
  plug.depth_m *=
      std::sqrt(std::sqrt(std::sqrt(share * share * share)));  // The energy grows as depth^(8/3).
  if (!hit.confined && plug.depth_m > kMaxShallowCraterDepth * width_m) return false;
  const double part = std::min(1.0, 2 * plug.depth_m / width_m);
  const double scale = std::sqrt(part * (2 - part));
  for (Vec2& corner : plug.section_m) corner *= scale;
  width_m *= scale, area_m2 *= scale * scale;
  const double size_m = cube_root(hit.volume_m3);
  return hit.confined || !(area_m2 > kMaxCraterShare * size_m * size_m);
}

}  // namespace

double perforation_energy_J(const Material& material, double width_m, double thickness_m,
                            double mass_kg) {
  if (!(material.compressive_Pa > 0) || thickness_m < kMinPlugThickness * width_m) return 0;
  const double slenderness = width_m * thickness_m * thickness_m / mass_kg;
  const double squared_m2_s2 = 1.7 * (material.reinforcement_percent + 0.3) *
                               material.compressive_Pa * cube_root(material.density_kg_m3) *
                               slenderness * cube_root(slenderness);
  return 0.5 * mass_kg * squared_m2_s2;
}

std::optional<Plug> make_plug(const Material& material, const StructureImpact& hit, Pose& X_RP) {
  Plug plug;
  plug.depth_m = hit.thickness_m;
  if (hit.section_R.empty() || !hit.narrow || !(plug.depth_m > 0)) return {};
  const Mat3 axes = axes_along(hit.direction_R, hit.section_R[0] - hit.point_R);
  for (const Vec3& corner : hit.section_R) {
    const Vec3 at_P = axes.transpose() * (corner - hit.point_R);
    plug.section_m.emplace_back(at_P.x(), at_P.z());
  }
  auto [area_m2, middle_m] = measure(plug.section_m);
  if (area_m2 < 0) std::ranges::reverse(plug.section_m);
  area_m2 = std::abs(area_m2);
  if (area_m2 * plug.depth_m > kMaxPlugShare * hit.volume_m3) return {};
  for (Vec2& corner : plug.section_m) corner -= middle_m;
  X_RP = {hit.point_R + axes * Vec3(middle_m.x(), 0, middle_m.y()), Quat(axes).normalized()};
  plug.solid_m = hit.path_m > 0 ? hit.path_m : plug.depth_m;
  double width_m = 2 * std::sqrt(area_m2 / std::numbers::pi);
  // The strength is that of the thickness across the struck face. The sheared sides are longer by
  // the slant.
  plug.energy_J =
      perforation_energy_J(material, width_m, hit.cosine * plug.solid_m, hit.striker_kg) /
      hit.cosine;
  plug.through = plug.energy_J <= kMaxPerforationShare * hit.energy_J;
  // A solid without a pattern cannot break as a whole, so it lets a striker through near an edge.
  const bool confined = hit.confined || material.pattern.kind == PatternSpec::Kind::kNone;
  if (plug.through ? !confined : !hit.held) return {};
  if (!plug.through && !become_crater(hit, width_m, area_m2, plug)) return {};
  plug.mass_kg = material.density_kg_m3 * area_m2 * (plug.through ? plug.solid_m : plug.depth_m);
  if (plug.through) plug.clearance = kHoleClearance;
  plug.sides_m2 = plug.clearance * perimeter_m(plug.section_m) * plug.depth_m;
  const double smaller_m3 = area_m2 * std::min(plug.depth_m, width_m);
  if (!plug.through) {  // A crater is one piece; several would jam in it.
    if (smaller_m3 < material.min_breakable_volume_m3()) plug.section_m.clear();
    return plug;
  }
  const auto parts = static_cast<double>(plug.section_m.size() + 1);
  plug.split = smaller_m3 > parts * material.smallest_piece_m3;
  plug.slice_m = kPlugSliceThickness * width_m;
  add_rings(material, hit, width_m / 2, plug);
  return plug;
}

}  // namespace sunder::fracture
