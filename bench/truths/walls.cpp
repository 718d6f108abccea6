// Validation of strikes on walls that theory describes: at angles, at phases of the step, in blocks
// of other sizes, free walls, walls behind walls, and what stands loose before a wall.
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "bench/truths/strikes.h"

namespace sunder::truths {
namespace {

constexpr double kDegree = kPi / 180;

/// Relative errors of shots.
using Errors = std::vector<double>;
/// Returns the share of the shots that are off by more than `most`.
double share_off(const Errors& errors, double most = 0.1) {
  const auto off =
      std::ranges::count_if(errors, [&](double error) { return !(std::abs(error) <= most); });
  return static_cast<double>(off) / static_cast<double>(errors.size());
}

/// Returns a wall of brick with its middle at 1.5 m of height, its front at `front_z`.
std::string wall(const std::string& name, const Vec3& size, double front_z, double block_m,
                 bool is_free = false) {
  const Vec3 foot(0, 1.5 - 0.5 * size.y(), front_z - 0.5 * size.z());
  return box(name, size, foot, "brick",
             blocks(block_m) + (is_free ? "" : "anchored = \"bottom\"\n"));
}

/// A steel ball that flies towards the point at 1.5 m of height on the z axis.
struct Flying {
  double radius_m, speed_m_s;
  double angle = 0;  ///< Between its way and −z.

  Vec3 way() const { return Vec3(std::sin(angle), 0, -std::cos(angle)); }
  double kg() const { return steel_ball_kg(radius_m); }
  /// Returns the table of the ball, which meets z = 0 at x after 0.02 s and a phase of a frame.
  std::string at(double x, double phase, const std::string& name = "shot") const {
    const double before_m = radius_m / std::cos(angle) + speed_m_s * (0.02 + phase / 60);
    return ball(name, radius_m, Vec3(x, 1.5, 0) - before_m * way(), speed_m_s * way());
  }
};

/// Exit speeds of the ball of 110 kg at 52.9 m/s behind a wall of 0.25 m, at phases and in blocks.
std::vector<double> exits_at(double angle, const Preset& preset) {
  const Flying shot{0.15, 52.9, angle};
  std::vector<double> exits;
  for (const double block_m : {0., 0.4}) {
    for (int k = 0; k < 6; ++k) {
      const std::string scene = wall("wall", Vec3(6, 3, 0.25), 0, block_m) + shot.at(0, phase(k));
      // The path within the wall is followed along the way that the ball came.
      exits.push_back(
          exit_m_s(scene, "shot", shot.way(), 0.25 / std::cos(angle) + 0.5, 0.3, preset));
    }
  }
  return exits;
}

Measure exit_at(double angle, double theory_m_s, double most = 0.1) {
  return [=](const Preset& preset) {
    Errors errors;
    for (const double exit : exits_at(angle, preset)) errors.push_back(exit / theory_m_s - 1);
    return share_off(errors, most);
  };
}

/// Largest difference of exit speeds by phase and blocks, of the speed at which the ball came.
double spread(const Preset& preset) {
  double most = 0;
  for (const double degrees : {5., 25.}) {
    const std::vector<double> exits = exits_at(degrees * kDegree, preset);
    const auto [least, largest] = std::ranges::minmax(exits);
    most = std::max(most, (largest - least) / 52.9);
  }
  return most;
}

/// A free plate of 5 × 3 × 0.3 m that is struck beside its middle.
double free_plate(const Preset& preset) {
  const Flying shot{0.3, 40};
  const Vec3 size(5, 3, 0.3);
  const double mass_kg = 1900 * size.prod();
  Errors errors;
  for (const double beside_m : {0., 0.12, 0.25, 0.6, 1.6}) {
    const double turning = beside_m * beside_m * 12 / (size.x() * size.x() + size.z() * size.z());
    const auto theory =
        passed(shot.kg(), 40, 0.6, {.thickness_m = 0.3, .free_kg = mass_kg / (1 + turning)});
    const std::string scene = wall("wall", size, 0, 0, true) + shot.at(beside_m, phase(1));
    const double exit = exit_m_s(scene, "shot", shot.way(), 1.2, 0.3, preset);
    errors.push_back(exit / theory.value().speed_m_s - 1);
  }
  return share_off(errors);
}

/// Walls of 0.2 m one behind the other; each plug goes on with the ball.
Measure walls_in_a_row(int walls, double speed_m_s) {
  return [=](const Preset& preset) {
    const Flying shot{0.2, speed_m_s};
    double kg = shot.kg(), theory_m_s = speed_m_s;
    for (int i = 0; i < walls; ++i) {
      const auto on = passed(kg, theory_m_s, 0.4, {.thickness_m = 0.2});
      kg += on.value().plug_kg, theory_m_s = on.value().speed_m_s;
    }
    Errors errors;
    for (const double gap_m : {0.1, 0.5, 2.5, 5.}) {
      std::string scene;
      for (int i = 0; i < walls; ++i)
        scene += wall("wall" + std::to_string(i), Vec3(4, 3, 0.2), -i * (0.2 + gap_m), 0);
      const double end_m = walls * 0.2 + (walls - 1) * gap_m;
      for (const int k : {0, 1, 2}) {
        const double exit =
            exit_m_s(scene + shot.at(0, phase(k)), "shot", shot.way(), end_m + 0.6, 1, preset);
        errors.push_back(exit / theory_m_s - 1);
      }
    }
    return share_off(errors);
  };
}

/// Two balls that strike a free wall at once, from one side or from both.
double two_strikers(const Preset& preset) {
  const Flying shot{0.15, 52.9};
  const auto theory = passed(shot.kg(), 52.9, 0.3, {.thickness_m = 0.25, .free_kg = 2 * 1900.});
  Errors errors;
  for (const bool both : {false, true}) {
    std::string scene = wall("wall", Vec3(4, 3, 0.25), 0, 0, true) + shot.at(-0.8, 0);
    scene += both
                 ? ball("other", 0.15, Vec3(0.8, 1.5, -0.25 - 0.15 - 52.9 * 0.02), Vec3(0, 0, 52.9))
                 : shot.at(0.8, 0, "other");
    for (const auto& [name, way] :
         {std::pair("shot", Vec3(0, 0, -1)), std::pair("other", Vec3(0, 0, both ? 1 : -1))}) {
      const double exit = exit_m_s(scene, name, way, way.z() < 0 ? 0.8 : 0.55, 0.3, preset);
      errors.push_back(exit / theory.value().speed_m_s - 1);
    }
  }
  return share_off(errors);
}

/// Unbreakable boxes of the section of the ball that are loose before a wall of 0.25 m: what the
/// ball drives on strikes the wall together with it.
struct Loose {
  int boxes;
  double box_kg, speed_m_s;
  double gap_m = 0;
};
Measure behind_boxes(const std::vector<Loose>& cases) {
  return [=](const Preset& preset) {
    Errors errors;
    for (const Loose& loose : cases) {
      constexpr double kSide = 0.266, kLength = 0.1;  // the section is that of the ball
      const Flying shot{0.15, loose.speed_m_s};
      const double boxes_kg = loose.boxes * loose.box_kg;
      const double together = loose.speed_m_s * shot.kg() / (shot.kg() + boxes_kg);
      const auto theory = passed(shot.kg() + boxes_kg, together, 0.3, {.thickness_m = 0.25});
      const double pitch = kLength + loose.gap_m;
      const double density = loose.box_kg / (kSide * kSide * kLength);
      std::string scene = material("dense", "foundation",
                                   "friction = 0\ndensity_kg_m3 = " + std::to_string(density));
      for (int i = 0; i < loose.boxes; ++i)  // in the air, where nothing has the time to fall
        scene += box("box" + std::to_string(i), Vec3(kSide, kSide, kLength),
                     Vec3(0, 1.5 - 0.5 * kSide, loose.gap_m + 0.5 * kLength + i * pitch), "dense");
      scene += wall("wall", Vec3(4, 3, 0.25), 0, 0);
      const double front = loose.boxes * pitch;
      scene += ball("shot", 0.15, Vec3(0, 1.5, front + 0.151), Vec3(0, 0, -loose.speed_m_s));
      const double exit = exit_m_s(scene, "shot", Vec3(0, 0, -1), 0.6, 0.5, preset);
      errors.push_back(exit / theory.value().speed_m_s - 1);
    }
    return share_off(errors);
  };
}

}  // namespace

Truths wall_truths() {
  const char* source = "Recht and Ipson 1963, CEA-EDF, UKAEA";
  // Two models of the oblique: the tangential force bounded by friction and by what the striker has
  // cut, and a path longer by 1/cos. Their mean, which both are within a tenth of.
  const char* oblique = "Recht and Ipson 1963, CEA-EDF, two models of the oblique";
  return {
      truth(46, "ball of 110 kg at 52.9 m/s through 0.25 m of brick: share off by a tenth", "",
            source, 0, exit_at(0, 36.8), {0, 0, 0, 0}),
      truth(46, "the same at 10°: share off by a tenth", "", oblique, 0,
            exit_at(10 * kDegree, 36.6), {0, 0, 0, 0}),
      truth(46, "the same at 20°: share off by a tenth", "", oblique, 0,
            exit_at(20 * kDegree, 35.9), {0, 0, 0, 0}),
      truth(46, "the same at 30°: share off by a tenth", "", oblique, 0,
            exit_at(30 * kDegree, 34.7), {0, 0, 0, 0}),
      truth(46, "the same at 45°: share off by 15 %", "", oblique, 0,
            exit_at(45 * kDegree, 30.6, 0.15), {0, 0, 0, 0}),
      truth(46, "the same at 50°: share off by 15 %", "", oblique, 0,
            exit_at(50 * kDegree, 27.8, 0.15), {0, 0, 0, 0}),
      truth(46, "the same at 5° and 25°, by phase of the step and size of blocks: spread", "",
            "one value", 0.03, spread, {0.03, 0.03, 0.03, 0.03}),
      truth(47, "ball of 882 kg through a free plate: share off by a tenth", "", source, 0,
            free_plate, {0, 0, 0, 0}),
      truth(47, "ball through two walls at 50 m/s, 0.1 to 5 m apart: share off by a tenth", "",
            source, 0, walls_in_a_row(2, 50), {0, 0, 0, 0}),
      truth(47, "ball through two walls at 85 m/s, 0.1 to 5 m apart: share off by a tenth", "",
            source, 0, walls_in_a_row(2, 85), {0, 0, 0, 0.09}),
      truth(47, "ball through three walls at 85 m/s, 0.1 to 5 m apart: share off by a tenth", "",
            source, 0, walls_in_a_row(3, 85), {0, 0, 0, 0.09}),
      truth(47, "two balls through a free wall, from one side and from both: share off by a tenth",
            "", source, 0, two_strikers, {0, 0, 0, 0}),
      truth(48, "boxes of 5 and 50 kg loose before a wall: share off by a tenth", "", source, 0,
            behind_boxes({{1, 5, 40}, {1, 50, 28}, {1, 5, 40, 0.05}, {1, 50, 28, 0.05}}),
            {0.55, 0.55, 0.55, 0.55}),
      truth(48, "five boxes of 20 kg loose before a wall: share off by a tenth", "", source, 0,
            behind_boxes({{5, 20, 60}, {5, 20, 60, 0.05}}), {0, 0, 0, 0}),
      truth(48, "block of 250 kg loose before a wall: share off by a tenth", "", source, 0,
            behind_boxes({{1, 250, 90}, {1, 250, 90, 0.05}, {1, 250, 90, 0.3}}), {0, 0, 0, 0}),
  };
}

}  // namespace sunder::truths
