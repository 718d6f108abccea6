// Validation of small things that fall on hard ground: from what height they break, and into how
// many pieces.
#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "bench/truths/strikes.h"

namespace sunder::truths {
namespace {

/// A thing that falls onto the ground, which is as hard as concrete.
struct Thing {
  const char* material;
  Vec3 size;
  double compressive_Pa, tensile_Pa, youngs_Pa, density_kg_m3, toughness_J_m2;
  bool lies =
      false;  ///< True if the thing is thin and lands flat, so that it bends before it is crushed.
};
const Thing kBrick = {"clay", Vec3(0.24, 0.071, 0.115), 2e7, 2e6, 1e10, 1900, 60};
const Thing kPaver = {"concrete", Vec3(0.2, 0.08, 0.1), 3e7, 3e6, 3e10, 2400, 100};
const Thing kTile = {"ceramic", Vec3(0.4, 0.012, 0.25), 6e7, 1.5e7, 2e10, 2000, 30, true};
const Thing kSheetOfGlass = {"glass", Vec3(0.8, 0.006, 0.6), 5e8, 4e7, 7e10, 2500, 8, true};

/// Least height of a fall that breaks: the wave of the impact exceeds the strength, and the energy
/// that falls in suffices for a crack across.
double least_height_m(const Thing& thing) {
  const double z = std::sqrt(thing.youngs_Pa * thing.density_kg_m3),
               ground_z = std::sqrt(3e10 * 2400), size_m = std::cbrt(thing.size.prod());
  const double by_wave = thing.lies ? 0.78 * thing.tensile_Pa / z
                                    : thing.compressive_Pa / z * (z + ground_z) / ground_z;
  const double by_crack =
      2 * thing.toughness_J_m2 / (0.24 * thing.density_kg_m3 * size_m);  // a speed squared
  return (by_wave * by_wave + by_crack) / (2 * 9.81);
}

/// Area of the cracks of a thing that falls from a height, turned by `tilt`.
double cracks_m2(const Thing& thing, double height_m, double tilt, const Preset& preset) {
  const double half_m = 0.5 * (thing.size.y() * std::cos(tilt) + thing.size.x() * std::sin(tilt));
  const double speed = std::sqrt(2 * 9.81 * height_m);
  const Vec3 up(-std::sin(tilt), std::cos(tilt), 0);
  const Vec3 foot = Vec3(0, half_m + 0.01 + 0.003 * speed, 0) - 0.5 * thing.size.y() * up;
  double area_m2 = 0;
  strike(
      box("thing", thing.size, foot, thing.material,
          "rotation_rad = [0, 0, " + std::to_string(tilt) + "]\n" + velocity(Vec3(0, -speed, 0))),
      0.3, preset, [&](const Strike& now) {
        area_m2 = now.cracks_m2();
        return true;
      });
  return area_m2;
}

/// Logarithm of the least height that breaks, over that of theory; of three attitudes the worst.
Measure least_height(const Thing& thing) {
  return [&thing](const Preset& preset) {
    const double theory = std::log(least_height_m(thing));
    double worst = 0;
    for (const double tilt : {0.02, 0.3, 1.2}) {
      if (thing.lies && tilt > 0.1) continue;
      const double found = threshold(std::log(0.02), std::log(200), 8, [&](double height) {
        return cracks_m2(thing, std::exp(height), tilt, preset) > 0;
      });
      if (std::abs(found - theory) > std::abs(worst)) worst = found - theory;
    }
    return worst;
  };
}

/// Number of heights, of five from 1 to 100 m, from which less breaks than from a lower one.
Measure falling(const Thing& thing) {
  return [&thing](const Preset& preset) {
    double most = 0;
    int less = 0;
    for (const double height_m : {1., 5., 10., 30., 100.}) {
      const double area = cracks_m2(thing, height_m, 0.1, preset);
      if (area < 0.9 * most || (area == 0 && height_m > 1.5 * least_height_m(thing))) ++less;
      most = std::max(most, area);
    }
    return static_cast<double>(less);
  };
}

}  // namespace

Truths drop_truths() {
  const char* waves = "strength over impedance, energy of a crack";
  const char* more = "what breaks at a speed breaks at a higher one";
  const double mark = std::log(1.5);
  return {
      truth(51, "brick that falls on hard ground: logarithm of the least height", "", waves, mark,
            least_height(kBrick), {0.1, 0.1, 0.1, 0.1}),
      truth(51, "paver that falls on hard ground: logarithm of the least height", "", waves, mark,
            least_height(kPaver), {4.7, 4.7, 4.7, 4.7}),
      truth(51, "tile that falls flat: logarithm of the least height", "", waves, mark,
            least_height(kTile), {0.1, 0.1, 0.1, 0.1}),
      truth(51, "pane that falls flat: logarithm of the least height", "", waves, mark,
            least_height(kSheetOfGlass), {0.1, 0.1, 0.1, 0.1}),
      truth(51, "brick from 1 to 100 m: heights from which less breaks, of 5", "", more, 0,
            falling(kBrick), {0, 0, 0, 0}),
      truth(51, "tile from 1 to 100 m: heights from which less breaks, of 5", "", more, 0,
            falling(kTile), {0, 0, 0, 3}),
  };
}

}  // namespace sunder::truths
