// Validation of glass, columns and walls that are struck at growing speeds: what breaks at one
// speed breaks at every higher one, and what was measured on plates of glass.
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bench/truths/strikes.h"

namespace sunder::truths {
namespace {

/// Damage to a target, and the speed of the ball behind it.
struct Damage {
  double cracks_m2 = 0, behind_m_s = 0;
};

/// Share of the speeds, of those above the least that breaks, at which less than half of the cracks
/// of a lower speed come about.
double falling(const std::vector<Damage>& damages) {
  double most = 0;
  int above = 0, less = 0;
  for (const Damage& damage : damages) {
    if (most > 0) ++above;
    if (damage.cracks_m2 < 0.5 * most) ++less;
    most = std::max(most, damage.cracks_m2);
  }
  return above > 0 ? static_cast<double>(less) / above : 1;
}

/// Shoots a ball along −z at a target at the origin, at a height.
Damage shoot(const std::string& target, double radius_m, double height_m, double front_z,
             double speed_m_s, const Preset& preset) {
  const Vec3 from(0.03, height_m, front_z + radius_m + 0.02 + 0.004 * speed_m_s);
  Damage damage;
  strike(target + ball("shot", radius_m, from, Vec3(0, 0, -speed_m_s)), 0.5, preset,
         [&](const Strike& now) {
           damage.cracks_m2 = now.cracks_m2();
           const FrameBody* shot = now.find("shot");
           if (shot != nullptr && shot->X_WB.position.z() < -radius_m - 0.1)
             damage.behind_m_s = std::max(damage.behind_m_s, -shot->velocity_W.z());
           return true;
         });
  return damage;
}

const std::vector<double> kSpeeds = {1, 3, 4.5, 6, 10, 20, 40, 80, 160};

std::string pane_of(double thickness_m) {
  return "[[solid]]\nstructure = \"pane\"\nthickness_m = " + std::to_string(thickness_m) + "\n";
}

Measure panes(double thickness_m, bool is_held) {
  return [=](const Preset& preset) {
    const std::string pane =
        pane_of(thickness_m) + (is_held ? "" : "frame_m = 0\nanchored = \"none\"\n");
    std::vector<Damage> damages;
    for (const double speed : kSpeeds)
      damages.push_back(shoot(pane, 0.03, 1.05, 0.5 * thickness_m, speed, preset));
    return falling(damages);
  };
}

/// Largest loss of speed behind a pane from one speed to the next higher, of the higher.
double behind_panes(const Preset& preset) {
  double most = 0;
  for (const double thickness_m : {0.004, 0.01, 0.02}) {
    double before_m_s = 0;
    for (const double speed : kSpeeds) {
      const double behind =
          shoot(pane_of(thickness_m), 0.03, 1.05, 0.5 * thickness_m, speed, preset).behind_m_s;
      most = std::max(most, (before_m_s - behind) / speed);
      before_m_s = std::max(before_m_s, behind);
    }
  }
  return most;
}

Measure struck(const std::string& target, double radius_m, double height_m, double front_z,
               const std::vector<double>& speeds_m_s) {
  return [=](const Preset& preset) {
    std::vector<Damage> damages;
    for (const double speed : speeds_m_s)
      damages.push_back(shoot(target, radius_m, height_m, front_z, speed, preset));
    return falling(damages);
  };
}

/// Number of verdicts of Bastie's that come out otherwise: a ball of bronze of 100 g that falls
/// onto a plate of glass of 158 × 120 × 6 mm in a frame.
double glass_of_1876(const Preset& preset) {
  constexpr double kRadius = 0.01395, kTop = 0.056;
  std::string frame;
  for (const double side : {-1., 1.}) {
    const std::string name = side < 0 ? "a" : "b", held = "anchored = \"all\"\n";
    frame += box("along" + name, Vec3(0.178, 0.05, 0.02), Vec3(0, 0, side * 0.06), "steel", held);
    frame += box("across" + name, Vec3(0.02, 0.05, 0.1), Vec3(side * 0.079, 0, 0), "steel", held);
  }
  frame += box("glass", Vec3(0.158, 0.006, 0.12), Vec3(0, 0.05, 0), "glass");
  int wrong = 0;
  for (const double height_m : {0.2, 0.3, 0.4, 0.5, 0.8, 1.2, 2., 4.}) {
    const double speed = std::sqrt(2 * 9.81 * height_m);
    const Vec3 from(0, kTop + kRadius + 0.01, 0);
    bool breaks = false;
    strike(frame + ball("shot", kRadius, from, Vec3(0, -speed, 0)), 0.3, preset,
           [&](const Strike& now) { return !(breaks = breaks || now.cracks_m2() > 0); });
    if (breaks != (height_m > 0.45)) ++wrong;
  }
  return wrong;
}

}  // namespace

Truths pane_truths() {
  const char* more = "what breaks at a speed breaks at a higher one";
  const std::string column = box("column", Vec3(0.4, 3, 0.4), Vec3(0, 0, 0), "concrete",
                                 "anchored = \"bottom\"\nblock_m = 0.5\n");
  const std::string low_wall =
      box("wall", Vec3(3, 2, 0.24), Vec3(0, 0, 0), "brick", "anchored = \"bottom\"\n");
  const std::vector<double> speeds = {1, 1.5, 2, 3, 5, 8, 12, 20, 30, 60, 120};
  return {
      truth(49, "held pane of 4 mm at 1 to 160 m/s: speeds that break less", "", more, 0,
            panes(0.004, true), {0, 0, 0, 0}),
      truth(49, "held pane of 10 mm at 1 to 160 m/s: speeds that break less", "", more, 0,
            panes(0.01, true), {0, 0, 0, 0}),
      truth(49, "held pane of 20 mm at 1 to 160 m/s: speeds that break less", "", more, 0,
            panes(0.02, true), {0, 0, 0, 0}),
      truth(49, "free pane of 6 mm at 1 to 160 m/s: speeds that break less", "", more, 0,
            panes(0.006, false), {0, 0, 0, 0}),
      truth(49, "free pane of 20 mm at 1 to 160 m/s: speeds that break less", "", more, 0,
            panes(0.02, false), {0, 0, 0, 0}),
      truth(49, "held panes of 4 to 20 mm: speed behind that falls", "",
            "energy left grows with energy", 0.02, behind_panes, {0.02, 0.02, 0.02, 0.02}),
      truth(49, "plate of glass under a falling ball of 100 g: wrong verdicts, of 8", "",
            "de la Bastie, about 1876", 0, glass_of_1876, {0, 0, 0, 0}),
      truth(50, "column of concrete, ball of 0.9 t at 1 to 120 m/s: speeds that break less", "",
            more, 0, struck(column, 0.3, 1.5, 0.2, speeds), {0, 0, 0, 0}),
      truth(50, "wall of brick, ball of 0.7 t at 1 to 120 m/s: speeds that break less", "", more, 0,
            struck(low_wall, 0.28, 1, 0.12, speeds), {0, 0, 0, 0}),
  };
}

}  // namespace sunder::truths
