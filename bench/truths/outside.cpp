// Validation of strikes that others measured, or computed with codes of finite and discrete
// elements: rams and balls on walls, timber on brick, a storey on a storey, steel plates.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench/truths/strikes.h"
#include "tests/fixtures/standing.h"

namespace sunder::truths {
namespace {

const Vec3 kForwards(0, 0, -1);

/// Returns by how much a value is outside of a range, of the range's middle; 0 within.
double outside(double value, double low, double high) {
  const double by = value < low ? value - low : std::max(0., value - high);
  return by / (0.5 * (low + high));
}

/// Returns a ram of steel whose face of 0.4 × 0.5 m meets z = 0.1 at 1 m of height.
std::string ram(double kg, double speed_m_s) {
  const Vec3 size(0.4, 0.5, kg / (0.4 * 0.5 * 7800));
  const double from_z = 0.1 + 0.5 * size.z() + 0.01 + 0.01 * speed_m_s;
  return box("ram", size, Vec3(0, 1 - 0.5 * size.y(), from_z), "steel",
             velocity(speed_m_s * kForwards));
}

/// Returns a wall of concrete of 0.2 m.
std::string wall(double width_m, double height_m, double block_m, bool is_free) {
  return box("wall", Vec3(width_m, height_m, 0.2), Vec3(0, is_free ? 1 - 0.5 * height_m : 0, 0),
             "concrete", blocks(block_m) + (is_free ? "" : "anchored = \"bottom\"\n"));
}

/// Share of a wall, anchored at its foot, that stands after a ram of 1 t at 2 m/s.
double pushed_over(const Preset& preset) {
  double most = 0;
  for (const double block_m : {0., 0.2}) {
    double standing = 1;
    strike(wall(2, 2, block_m, false) + ram(1000, 2), 4, preset, [&](const Strike& now) {
      const FrameBody* body = now.find("ram");
      standing = share_standing(now.frame(), body != nullptr ? body->key : 1);
      return true;
    });
    most = std::max(most, standing);
  }
  return most;
}

/// Exit speed of a ram at 40 m/s, off the range that codes found.
Measure ram_at_40(double kg, double width_m, double height_m, bool is_free, double low,
                  double high) {
  return [=](const Preset& preset) {
    double worst = 0;
    for (const double block_m : {0., 0.2}) {
      const std::string scene = wall(width_m, height_m, block_m, is_free) + ram(kg, 40);
      const double exit = exit_m_s(scene, "ram", kForwards, 0.2 + kg / 3120, 0.4, preset);
      const double error = outside(exit, low, high);
      if (std::abs(error) > std::abs(worst)) worst = error;
    }
    return worst;
  };
}

/// Returns a wall in running bond whose bricks are joined by mortar, as one solid.
std::string mortared_wall() {
  std::string text =
      material("unit", "clay",
               "tensile_Pa = 3e5\nshear_Pa = 4e5\nfriction = 0.75\n"
               "toughness_J_m2 = 10") +
      "[[solid]]\nname = \"wall\"\nstructure = \"compound\"\nanchored = \"bottom\"\n";
  const auto repeat = [](int count, const char* step_m) {
    return "[[solid.part.repeat]]\ncount = " + std::to_string(count) + "\nstep_m = " + step_m +
           "\n";
  };
  // Each brick is repeated along its course, and in every second course above.
  const auto add = [&](double x, double y, double length, const std::string& along, int courses) {
    text += "[[solid.part]]\nstructure = \"box\"\nmaterial = \"unit\"\nsize_m = [" +
            std::to_string(length) + ", 0.1, 0.1]\nposition = [" + std::to_string(x) + ", " +
            std::to_string(y) + ", 0]\n" + along + repeat(courses, "[0, 0.2, 0]");
  };
  add(-0.9, 0, 0.2, repeat(10, "[0.2, 0, 0]"), 8);
  add(-0.8, 0.1, 0.2, repeat(9, "[0.2, 0, 0]"), 7);
  add(-0.95, 0.1, 0.1, repeat(2, "[1.9, 0, 0]"), 7);
  return text;
}

/// Exit speed of a ball of 30 kg at 15 m/s behind a wall of bricks in mortar, off what three codes
/// found.
double mortar(const Preset& preset) {
  constexpr double kRadius = 0.15;
  const double density = 30 / (4 / 3. * kPi * kRadius * kRadius * kRadius);
  double worst = 0;
  for (const int k : {0, 1, 2}) {
    const double from_z = 0.05 + kRadius + 0.02 + phase(k) * 15 / 60;
    const std::string scene =
        material("heavy", "steel", "density_kg_m3 = " + std::to_string(density)) + mortared_wall() +
        "[[ball]]\nname = \"shot\"\nradius_m = 0.15\nmaterial = \"heavy\"\nposition = [0, 0.75, " +
        std::to_string(from_z) + "]\nvelocity = [0, 0, -15]\n";
    const double exit = exit_m_s(scene, "shot", kForwards, 0.3, 0.5, preset);
    const double error = outside(exit, 1.9, 6.2);
    if (std::abs(error) > std::abs(worst)) worst = error;
  }
  return worst;
}

/// Number of speeds, of three, at which timber comes through a veneer of brick, which it did not.
double timber(const Preset& preset) {
  int through = 0;
  for (const double speed : {15., 25., 30.}) {
    const double length = 4.1 / (600 * 0.038 * 0.089);
    const std::string scene =
        box("veneer", Vec3(1.2, 1.2, 0.09), Vec3(0, 0, 0), "brick", "anchored = \"bottom\"\n") +
        box("shot", Vec3(0.038, 0.089, length), Vec3(0, 0.55, 0.045 + 0.5 * length + 0.01 * speed),
            "wood", velocity(speed * kForwards));
    if (exit_m_s(scene, "shot", kForwards, 0.05, 0.4, preset) > 0) ++through;
  }
  return through;
}

/// Speed behind a plate of steel of 12 mm, off what Børvik measured with a blunt projectile.
double steel_plate(const Preset& preset) {
  double worst = 0;
  for (const auto& [speed, behind] :
       {std::pair(150., 0.), {200., 71.}, {244., 133.}, {304., 200.}}) {
    const double length = 0.197 / (7800 * kPi / 4 * 0.02 * 0.02);
    const std::string scene =
        box("plate", Vec3(0.5, 0.5, 0.012), Vec3(0, 0, 0), "steel", "anchored = \"all\"\n") +
        box("shot", Vec3(0.0177, 0.0177, length),
            Vec3(0, 0.25 - 0.00885, 0.006 + 0.5 * length + 0.005 * speed), "steel",
            velocity(speed * kForwards));
    const double exit = exit_m_s(scene, "shot", kForwards, 0.1, 0.1, preset);
    const double error = (exit - behind) / speed;
    if (std::abs(error) > std::abs(worst)) worst = error;
  }
  return worst;
}

/// Least mean speed of all that falls, when three storeys that have fallen 3 m meet two, off that
/// of a plastic impact on the storey below.
double storeys(const Preset& preset) {
  const auto storey = [](double y) {
    std::string text;
    for (const double x : {-1., 1.})
      for (const double z : {-1., 1.})
        text += "[[solid.part]]\nstructure = \"box\"\nsize_m = [0.3, 2.8, 0.3]\nposition = [" +
                std::to_string(1.7 * x) + ", " + std::to_string(y) + ", " +
                std::to_string(1.7 * z) + "]\nmaterial = \"concrete\"\n";
    return text + "[[solid.part]]\nstructure = \"box\"\nsize_m = [4, 0.2, 4]\nposition = [0, " +
           std::to_string(y + 2.8) + ", 0]\nmaterial = \"concrete\"\n";
  };
  constexpr double kSpeed = 7.7;  // of a fall of 3 m
  const std::string scene =
      "[[solid]]\nname = \"below\"\nstructure = \"compound\"\nanchored = \"bottom\"\n" + storey(0) +
      storey(3) + "[[solid]]\nname = \"above\"\nstructure = \"compound\"\n" +
      velocity(Vec3(0, -kSpeed, 0)) + storey(6.1) + storey(9.1) + storey(12.1);
  double least = kSpeed;
  strike(scene, 1.2, preset, [&](const Strike& now) {
    const double time_s = now.frame().time_s;
    double momentum = 0, mass = 0;
    for (const FrameBody& body : now.frame().bodies) {
      if (body.is_static || body.X_WB.position.y() < 6) continue;
      momentum += body.mass_kg * -body.velocity_W.y(), mass += body.mass_kg;
    }
    if (time_s > 0.05 && time_s < 0.4 && mass > 0) least = std::min(least, momentum / mass);
    return time_s < 0.4;
  });
  const double plastic = kSpeed * 3 / 4;
  return std::min(0., least / plastic - 1);
}

}  // namespace

Truths outside_truths() {
  const char* codes = "OpenCourant and other codes, 2026";
  return {
      truth(52, "ram of 1 t at 2 m/s at a wall of concrete: share that stands", "", codes, 0.2,
            pushed_over, {1, 1, 1, 1}),
      truth(52, "ram of 1 t at 40 m/s through a wall of concrete: exit speed", "", codes, 0.15,
            ram_at_40(1000, 2, 2, false, 33.6, 36), {0.15, 0.15, 0.15, 0.15}),
      truth(52, "ram of 0.2 t at 40 m/s through a free wall of 0.53 t: exit speed", "", codes, 0.15,
            ram_at_40(200, 1.1, 1, true, 35, 35), {0.6, 0.65, 0.6, 0.61}),
      truth(52, "ball of 30 kg at 15 m/s through bricks in mortar: exit speed", "", codes, 0.15,
            mortar, {0.52, 0.52, 0.52, 0.52}),
      truth(53, "timber at 15, 25 and 30 m/s at a veneer of brick: shots that come through", "",
            "Bennett and Borchelt, Texas Tech", 0, timber, {2, 2, 2, 2}),
      truth(53, "blunt steel at 150 to 304 m/s at a plate of 12 mm: exit speed", "of the speed",
            "Børvik 1999", 0.1, steel_plate, {0.73, 0.73, 0.73, 0.73}),
      truth(53, "three storeys fall on two: least speed in the first 0.4 s", "",
            "plastic impact on the storey below", 0.3, storeys, {0.65, 0.97, 1, 0.8}),
  };
}

}  // namespace sunder::truths
