// Validation of blasts: damage to a brick house by a charge of TNT on the ground in front of it,
// compared with Jarrett (1968). Distance of a degree of damage: R = K W^(1/3) / (1 +
// (3175/W)²)^(1/6) in m and kg, with K = 3.8 for three quarters of the walls demolished (A), 5.6
// for a house beyond repair (B), 9.6 for partial collapse of a wall (Cb), 28 for no structural
// damage (Ca).
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "bench/truths/truth.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"
#include "tests/fixtures/standing.h"

namespace sunder::truths {
namespace {

constexpr double kCharge_kg = 1000, kSeconds = 2;
constexpr double kA = 3.8, kB = 5.6, kCb = 9.6, kCa = 28;

double radius_m(double k) {
  return k * std::cbrt(kCharge_kg) / std::pow(1 + std::pow(3175 / kCharge_kg, 2), 1.0 / 6);
}

/// Returns the fraction of a house that falls, with the charge at `distance_m` from its front wall.
double share_fallen(double distance_m, const Preset& preset) {
  static std::map<std::pair<double, std::string>, double> cache;
  const auto [place, is_new] = cache.try_emplace({distance_m, preset.name});
  if (!is_new) return place->second;
  const double front_m = -3;
  const std::string text =
      "[scene]\ndescription = \"A blast.\"\nduration_s = " + std::to_string(kSeconds) +
      "\n[limits]\ndust = 0\ndebris = 0\n[[solid]]\nstructure = \"house\"\nanchored = "
      "\"bottom\"\n[[script.blast]]\ntime_s = 0.1\nat = [0, 0.5, " +
      std::to_string(front_m - distance_m) + "]\ntnt_kg = " + std::to_string(kCharge_kg) + "\n";
  const auto simulation =
      scenes::make_simulation(scenes::parse_scene(text, "blast.toml", {preset.name, {}}));
  FramePtr last;
  while (FramePtr frame = simulation->next()) last = std::move(frame);
  return place->second = 1 - share_standing(*last);
}

/// Returns the logarithm of the least distance without damage, over the geometric mean of B and Cb.
double damage_distance(const Preset& preset) {
  constexpr double kDamaged = 0.01;
  constexpr int kRounds = 5;
  const double found_m = threshold(radius_m(kA), radius_m(kCa), kRounds, [&](double at_m) {
    return share_fallen(at_m, preset) < kDamaged;
  });
  return std::log(found_m / std::sqrt(radius_m(kB) * radius_m(kCb)));
}

}  // namespace

Truths blast_truths() {
  const char* jarrett = "Jarrett 1968";
  return {
      truth(45, "house of brick, 1 t of TNT: logarithm of the reach of damage, from B to Cb", "",
            jarrett, 0.27, damage_distance, {0.27, 0.27, 0.27, 0.27}),
      truth(45, "house of brick, 1 t of TNT at A, 25 m: share that stands", "", jarrett, 0.5,
            [](const Preset& p) { return 1 - share_fallen(radius_m(kA), p); },
            {0.93, 0.5, 0.5, 0.5}),
      truth(45, "house of brick, 1 t of TNT at Ca, 188 m: share that falls", "", jarrett, 0.01,
            [](const Preset& p) { return share_fallen(radius_m(kCa), p); },
            {0.01, 0.01, 0.01, 0.01}),
  };
}

}  // namespace sunder::truths
