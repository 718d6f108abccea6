// Validation of impact loads on beams: the speed at which a ball breaks a beam, and where.
//
// Theory of a ball that hits a beam and stays in contact, by Cox (1849): the beam moves in the
// shape that the ball's weight bends it to, with stiffness k and effective mass M in that shape; m
// v = (m + M) V, and ½ (m + M) V² = F² / 2k. For a heavy ball F follows from its energy (F² = 2k ·
// ½mv²), for a light one from its momentum (F = mv √(k/M)). The beam breaks where the moment of F
// is largest, if that exceeds its strength.
#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>
#include <vector>

#include "bench/truths/truth.h"
#include "scenes/file/make_compound.h"
#include "scenes/make_simulation.h"

namespace sunder::truths {
namespace {

constexpr double kStrength_Pa = 1e6, kYoungs_Pa = 3e10, kDensity = 2000;
constexpr double kWidth_m = 0.2, kLength_m = 2;
constexpr double kBendingStiffness_Nm2 =
    kYoungs_Pa * kWidth_m * kWidth_m * kWidth_m * kWidth_m / 12;
constexpr double kMomentStrength_Nm = kStrength_Pa * kWidth_m * kWidth_m * kWidth_m / 6;
constexpr double kMassPerLength_kg_m = kDensity * kWidth_m * kWidth_m;
constexpr MaterialIndex kBrittle{0}, kUnbreakable{1};
const Vec3 kClamp(0, kWidth_m / 2, kWidth_m / 2);  // middle of the clamped section

/// A structure that a ball hits, and its theoretical response to a force at the point of impact.
struct ImpactTarget {
  std::vector<Part> parts;
  Vec3 at, direction;
  double stiffness_N_m = 0, mass_kg = 0;
  double lever_m = 0;           ///< Largest bending moment divided by the force.
  std::vector<Vec3> bent = {};  ///< Points of the largest moment.

  double breaking_speed_m_s(double ball_kg) const {
    /// Returns the least speed of the ball that breaks the structure.
    return kMomentStrength_Nm / lever_m * std::sqrt((ball_kg + mass_kg) / stiffness_N_m) / ball_kg;
  }
};

/// Appends a box of cubes, `across` of them per beam width.
void add(const Vec3& low, const Vec3& high, int across, bool anchored, std::vector<Part>& parts) {
  const Vec3 size = high - low;
  const Eigen::Vector3i n = (size * across / kWidth_m).array().round().max(1).cast<int>();
  const Vec3 cell = size.cwiseQuotient(n.cast<double>());
  for (int i = 0; i < n.prod(); ++i) {
    const Vec3 corner =
        low + cell.cwiseProduct(Vec3(i % n.x(), i / n.x() % n.y(), i / (n.x() * n.y())));
    parts.push_back(
        {make_box(corner, corner + cell), anchored ? kUnbreakable : kBrittle, anchored});
  }
}

/// Returns a beam along x, clamped at its left end, or at both.
std::vector<Part> beam(int across, bool both_ends) {
  std::vector<Part> parts;
  add(Vec3(-kWidth_m / across, 0, 0), Vec3(0, kWidth_m, kWidth_m), across, true, parts);
  add(Vec3::Zero(), Vec3(kLength_m, kWidth_m, kWidth_m), across, false, parts);
  if (both_ends)
    add(Vec3(kLength_m, 0, 0), Vec3(kLength_m + kWidth_m / across, kWidth_m, kWidth_m), across,
        true, parts);
  return parts;
}

ImpactTarget at_tip(int across) {
  return {beam(across, false),
          Vec3(kLength_m, kWidth_m, kWidth_m / 2),
          -Vec3::UnitY(),
          3 * kBendingStiffness_Nm2 / std::pow(kLength_m, 3),
          kMassPerLength_kg_m * kLength_m * 33 / 140,
          kLength_m,
          {kClamp}};
}

ImpactTarget at_midspan(int across) {
  return {beam(across, true),
          Vec3(kLength_m / 2, kWidth_m, kWidth_m / 2),
          -Vec3::UnitY(),
          192 * kBendingStiffness_Nm2 / std::pow(kLength_m, 3),
          kMassPerLength_kg_m * kLength_m * 13 / 35,
          kLength_m / 8,
          {kClamp, kClamp + Vec3(kLength_m / 2, 0, 0), kClamp + Vec3(kLength_m, 0, 0)}};
}

/// Clamped at both ends, with F at distance a from one end and b from the other: M = F a b²/L² at
/// the nearer end, and deflection F a³b³/3EIL³ at F.
ImpactTarget at_third(int across) {
  const double a = kLength_m / 3, b = kLength_m - a;
  ImpactTarget target{beam(across, true), Vec3(a, kWidth_m, kWidth_m / 2), -Vec3::UnitY()};
  target.stiffness_N_m = 3 * kBendingStiffness_Nm2 * std::pow(kLength_m / (a * b), 3);
  target.lever_m = a * b * b / (kLength_m * kLength_m);
  target.bent = {kClamp};
  const auto deflection = [&](double x) {  // divided by the deflection at the force
    const double from = x < a ? x : kLength_m - x, near = x < a ? a : b, far = kLength_m - near;
    return far * far * from * from * (3 * near * kLength_m - (3 * near + far) * from) /
           (2 * std::pow(a * b, 3));
  };
  constexpr int kSlices = 1000;
  for (int i = 0; i < kSlices; ++i) {
    const double at = deflection(kLength_m * (i + 0.5) / kSlices);
    target.mass_kg += kMassPerLength_kg_m * kLength_m / kSlices * at * at;
  }
  return target;
}

/// A portal frame of one section on two clamped feet, hit along its beam; k = h/L of the centre
/// lines. Kleinlogel: M = F h/2 · (3k + 1)/(6k + 1) at the feet, and deflection F h³/12EI · (3k +
/// 2)/(6k + 1) of the corner.
ImpactTarget at_corner(int across) {
  const double high = 2, wide = 3, half = kWidth_m / 2, k = high / wide;
  ImpactTarget target;
  for (const double x : {0.0, wide}) {
    add(Vec3(x - half, -kWidth_m / across, 0), Vec3(x + half, 0, kWidth_m), across, true,
        target.parts);
    add(Vec3(x - half, 0, 0), Vec3(x + half, high - half, kWidth_m), across, false, target.parts);
  }
  add(Vec3(-half, high - half, 0), Vec3(wide + half, high + half, kWidth_m), across, false,
      target.parts);
  target.at = Vec3(-half, high, half), target.direction = Vec3::UnitX();
  target.stiffness_N_m = 12 * kBendingStiffness_Nm2 / std::pow(high, 3) * (6 * k + 1) / (3 * k + 2);
  target.lever_m = high / 2 * (3 * k + 1) / (6 * k + 1);
  target.bent = {Vec3(0, 0, half), Vec3(wide, 0, half)};
  target.mass_kg = kMassPerLength_kg_m * (wide + 2 * 13.0 / 35 * high);
  return target;
}

/// Returns the point of the first break, if any.
std::optional<Vec3> find_break(const Preset& preset, const ImpactTarget& target, double ball_kg,
                               double speed_m_s) {
  constexpr double kRadius_m = 0.04, kFlight_s = 0.03;
  Scene scene;
  scene.materials.resize(3);
  for (Material& material : scene.materials)
    material.density_kg_m3 = kDensity, material.youngs_Pa = kYoungs_Pa;
  scene.materials[0].tensile_Pa = kStrength_Pa;
  scene.materials[2].density_kg_m3 = ball_kg / (4 * kPi / 3 * std::pow(kRadius_m, 3));
  scene.accuracy = {preset.dt_s, preset.substeps};
  scene.solver.sweeps = preset.sweeps;
  scene.gravity_W.setZero();
  scene.ground.height_m = -1000;
  scene.limits.load_work_a_frame = 1000000000;
  scene.duration_s = 0.15;
  scene.solids = {{"struck", scenes::make_compound(target.parts), {}}};
  Ball ball;
  ball.radius_m = kRadius_m;
  ball.material = MaterialIndex(2);
  ball.center_W = target.at - (kRadius_m + kFlight_s * speed_m_s) * target.direction;
  ball.velocity_W = speed_m_s * target.direction;
  scene.balls = {ball};
  const auto simulation = scenes::make_simulation(std::move(scene));
  while (const FramePtr frame = simulation->next())
    if (!frame->breaks.empty()) return frame->breaks[0].point_W;
  return {};
}

/// Measures the breaking speed divided by theory, less 1: the worst of three meshes.
Measure breaking_speed(ImpactTarget (*make)(int across), double ball_kg) {
  return [=](const Preset& preset) {
    double worst = 0;
    for (const int across : {2, 4, 6}) {
      const ImpactTarget target = make(across);
      const double speed_m_s = target.breaking_speed_m_s(ball_kg);
      const double ratio = threshold(0.5, 1.5, 6, [&](double ratio_to_theory) {
        return find_break(preset, target, ball_kg, ratio_to_theory * speed_m_s).has_value();
      });
      if (std::abs(ratio - 1) > std::abs(worst)) worst = ratio - 1;
    }
    return worst;
  };
}

/// Measures the distance of the break from the nearest point of the largest moment at 1.2 times the
/// breaking speed, divided by the length: the worst of three meshes.
Measure break_location(ImpactTarget (*make)(int across), double ball_kg) {
  return [=](const Preset& preset) {
    double worst_m = 0;
    for (const int across : {2, 4, 6}) {
      const ImpactTarget target = make(across);
      const std::optional<Vec3> at =
          find_break(preset, target, ball_kg, 1.2 * target.breaking_speed_m_s(ball_kg));
      double nearest_m = kLength_m;
      for (const Vec3& bent : target.bent)
        if (at) nearest_m = std::min(nearest_m, (*at - bent).norm());
      worst_m = std::max(worst_m, nearest_m);
    }
    return worst_m / kLength_m;
  };
}

}  // namespace

Truths blow_truths() {
  const char* cox = "Cox: F² = 2k · ½mv² · m/(m + M)";
  const char* bent = "largest moment";
  const auto same_bound = [](double bound) { return Bounds{bound, bound, bound, bound}; };
  return {
      truth(36, "cantilever struck at its tip by a heavy ball: speed", "", cox, 0.1,
            breaking_speed(at_tip, 2000), same_bound(0.015)),
      truth(36, "cantilever struck at its tip by a light ball: speed", "", cox, 0.1,
            breaking_speed(at_tip, 1), same_bound(0.015)),
      truth(36, "beam built in twice, struck at midspan: speed", "", cox, 0.1,
            breaking_speed(at_midspan, 500), same_bound(0.085)),
      truth(36, "beam built in twice, struck at a third: speed", "", cox, 0.1,
            breaking_speed(at_third, 500), same_bound(0.1)),
      truth(36, "portal struck at its corner: speed", "", cox, 0.1, breaking_speed(at_corner, 5000),
            same_bound(0.06)),
      truth(36, "cantilever struck at its tip: place of the break", "", bent, 0.1,
            break_location(at_tip, 30), same_bound(0.09)),
      truth(36, "beam built in twice, struck at midspan: place", "", bent, 0.1,
            break_location(at_midspan, 30), same_bound(0.09)),
      truth(36, "beam built in twice, struck at a third: place", "", bent, 0.1,
            break_location(at_third, 30), same_bound(0.09)),
      truth(36, "portal struck at its corner: place", "", bent, 0.1, break_location(at_corner, 100),
            same_bound(0.09)),
  };
}

}  // namespace sunder::truths
