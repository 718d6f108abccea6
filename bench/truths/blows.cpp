// Blows against the theory of beams: which speed breaks, and where.
//
// A ball that meets a beam and stays on it, as seen by Cox (1849): the beam swings as it would bend
// under the ball's weight, with the stiffness k and the share M of its mass that it has in that
// shape; m v = (m + M) V, and ½ (m + M) V² = F² / 2k. A heavy ball loads it as its energy would at
// rest (F² = 2k · ½mv²), a light one by its momentum (F = mv √(k/M)). It breaks where F bends it
// most, if that is more than it stands.
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
constexpr double kWide = 0.2, kLong = 2;  // m
constexpr double kBending = kYoungs_Pa * kWide * kWide * kWide * kWide / 12;
constexpr double kStands_Nm = kStrength_Pa * kWide * kWide * kWide / 6;
constexpr double kPerLength_kg_m = kDensity * kWide * kWide;
constexpr MaterialIndex kBrittle{0}, kHard{1};
const Vec3 kHeld(0, kWide / 2, kWide / 2);  // middle of the section there

/// What is struck, and what theory says of it there.
struct Struck {
  std::vector<Part> parts;
  Vec3 at, direction;
  double stiffness_N_m = 0, mass_kg = 0;
  double lever_m = 0;           ///< The largest moment over the force.
  std::vector<Vec3> bent = {};  ///< Where that is.

  double speed_m_s(double ball_kg) const {
    return kStands_Nm / lever_m * std::sqrt((ball_kg + mass_kg) / stiffness_N_m) / ball_kg;
  }
};

/// The box in cubes, so many of them across.
void add(const Vec3& low, const Vec3& high, int across, bool anchored, std::vector<Part>& parts) {
  const Vec3 size = high - low;
  const Eigen::Vector3i n = (size * across / kWide).array().round().max(1).cast<int>();
  const Vec3 cell = size.cwiseQuotient(n.cast<double>());
  for (int i = 0; i < n.prod(); ++i) {
    const Vec3 corner =
        low + cell.cwiseProduct(Vec3(i % n.x(), i / n.x() % n.y(), i / (n.x() * n.y())));
    parts.push_back({make_box(corner, corner + cell), anchored ? kHard : kBrittle, anchored});
  }
}

/// Along x; held at its left end, or at both.
std::vector<Part> beam(int across, bool held_twice) {
  std::vector<Part> parts;
  add(Vec3(-kWide / across, 0, 0), Vec3(0, kWide, kWide), across, true, parts);
  add(Vec3::Zero(), Vec3(kLong, kWide, kWide), across, false, parts);
  if (held_twice)
    add(Vec3(kLong, 0, 0), Vec3(kLong + kWide / across, kWide, kWide), across, true, parts);
  return parts;
}

Struck at_tip(int across) {
  return {beam(across, false),
          Vec3(kLong, kWide, kWide / 2),
          -Vec3::UnitY(),
          3 * kBending / std::pow(kLong, 3),
          kPerLength_kg_m * kLong * 33 / 140,
          kLong,
          {kHeld}};
}

Struck at_midspan(int across) {
  return {beam(across, true),
          Vec3(kLong / 2, kWide, kWide / 2),
          -Vec3::UnitY(),
          192 * kBending / std::pow(kLong, 3),
          kPerLength_kg_m * kLong * 13 / 35,
          kLong / 8,
          {kHeld, kHeld + Vec3(kLong / 2, 0, 0), kHeld + Vec3(kLong, 0, 0)}};
}

/// Built in twice, F at a from one end and b from the other: M = F a b²/L² at the nearer end, and
/// it bends by F a³b³/3EIL³.
Struck at_third(int across) {
  const double a = kLong / 3, b = kLong - a;
  Struck struck{beam(across, true), Vec3(a, kWide, kWide / 2), -Vec3::UnitY()};
  struck.stiffness_N_m = 3 * kBending * std::pow(kLong / (a * b), 3);
  struck.lever_m = a * b * b / (kLong * kLong);
  struck.bent = {kHeld};
  const auto bends = [&](double x) {  // over that at the force
    const double from = x < a ? x : kLong - x, near = x < a ? a : b, far = kLong - near;
    return far * far * from * from * (3 * near * kLong - (3 * near + far) * from) /
           (2 * std::pow(a * b, 3));
  };
  constexpr int kSlices = 1000;
  for (int i = 0; i < kSlices; ++i) {
    const double at = bends(kLong * (i + 0.5) / kSlices);
    struck.mass_kg += kPerLength_kg_m * kLong / kSlices * at * at;
  }
  return struck;
}

/// A frame of one section on two feet that are built in, struck along its beam: k = h/L of the
/// centre lines; Kleinlogel: M = F h/2 · (3k + 1)/(6k + 1) at the feet, and the corner moves by
/// F h³/12EI · (3k + 2)/(6k + 1).
Struck at_corner(int across) {
  const double high = 2, wide = 3, half = kWide / 2, k = high / wide;
  Struck struck;
  for (const double x : {0.0, wide}) {
    add(Vec3(x - half, -kWide / across, 0), Vec3(x + half, 0, kWide), across, true, struck.parts);
    add(Vec3(x - half, 0, 0), Vec3(x + half, high - half, kWide), across, false, struck.parts);
  }
  add(Vec3(-half, high - half, 0), Vec3(wide + half, high + half, kWide), across, false,
      struck.parts);
  struck.at = Vec3(-half, high, half), struck.direction = Vec3::UnitX();
  struck.stiffness_N_m = 12 * kBending / std::pow(high, 3) * (6 * k + 1) / (3 * k + 2);
  struck.lever_m = high / 2 * (3 * k + 1) / (6 * k + 1);
  struck.bent = {Vec3(0, 0, half), Vec3(wide, 0, half)};
  struck.mass_kg = kPerLength_kg_m * (wide + 2 * 13.0 / 35 * high);
  return struck;
}

/// Where it breaks first; nowhere if it holds.
std::optional<Vec3> breaks_at(const Preset& preset, const Struck& struck, double ball_kg,
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
  scene.solids = {{"struck", scenes::make_compound(struck.parts), {}}};
  Ball ball;
  ball.radius_m = kRadius_m;
  ball.material = MaterialIndex(2);
  ball.center_W = struck.at - (kRadius_m + kFlight_s * speed_m_s) * struck.direction;
  ball.velocity_W = speed_m_s * struck.direction;
  scene.balls = {ball};
  const auto simulation = scenes::make_simulation(std::move(scene));
  while (const FramePtr frame = simulation->next())
    if (!frame->breaks.empty()) return frame->breaks[0].point_W;
  return {};
}

/// The speed that breaks, over that of theory, less 1: the worst of several depths.
Measure limit(Struck (*make)(int across), double ball_kg) {
  return [=](const Preset& preset) {
    double worst = 0;
    for (const int across : {2, 4, 6}) {
      const Struck struck = make(across);
      const double speed_m_s = struck.speed_m_s(ball_kg);
      const double part = threshold(0.5, 1.5, 6, [&](double of_theory) {
        return breaks_at(preset, struck, ball_kg, of_theory * speed_m_s).has_value();
      });
      if (std::abs(part - 1) > std::abs(worst)) worst = part - 1;
    }
    return worst;
  };
}

/// How far from where it is bent most it breaks, at 1.2 times the speed: the worst of several
/// depths, over its length.
Measure place(Struck (*make)(int across), double ball_kg) {
  return [=](const Preset& preset) {
    double worst_m = 0;
    for (const int across : {2, 4, 6}) {
      const Struck struck = make(across);
      const std::optional<Vec3> at =
          breaks_at(preset, struck, ball_kg, 1.2 * struck.speed_m_s(ball_kg));
      double nearest_m = kLong;
      for (const Vec3& bent : struck.bent)
        if (at) nearest_m = std::min(nearest_m, (*at - bent).norm());
      worst_m = std::max(worst_m, nearest_m);
    }
    return worst_m / kLong;
  };
}

}  // namespace

Truths blow_truths() {
  const char* cox = "Cox: F² = 2k · ½mv² · m/(m + M)";
  const char* bent = "largest moment";
  const auto alike = [](double bound) { return Bounds{bound, bound, bound, bound}; };
  return {
      truth(36, "cantilever struck at its tip by a heavy ball: speed", "", cox, 0.1,
            limit(at_tip, 2000), alike(0.015)),
      truth(36, "cantilever struck at its tip by a light ball: speed", "", cox, 0.1,
            limit(at_tip, 1), alike(0.015)),
      truth(36, "beam built in twice, struck at midspan: speed", "", cox, 0.1,
            limit(at_midspan, 500), alike(0.085)),
      truth(36, "beam built in twice, struck at a third: speed", "", cox, 0.1, limit(at_third, 500),
            alike(0.1)),
      truth(36, "portal struck at its corner: speed", "", cox, 0.1, limit(at_corner, 5000),
            alike(0.06)),
      truth(36, "cantilever struck at its tip: place of the break", "", bent, 0.1,
            place(at_tip, 30), alike(0.09)),
      truth(36, "beam built in twice, struck at midspan: place", "", bent, 0.1,
            place(at_midspan, 30), alike(0.09)),
      truth(36, "beam built in twice, struck at a third: place", "", bent, 0.1, place(at_third, 30),
            alike(0.09)),
      truth(36, "portal struck at its corner: place", "", bent, 0.1, place(at_corner, 100),
            alike(0.09)),
  };
}

}  // namespace sunder::truths
