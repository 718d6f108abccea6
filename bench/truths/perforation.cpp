// Validation of perforation of walls, slabs and panes by hard balls: exit speeds and limit speeds
// compared with published formulas, and the fraction that is left standing.
#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <numbers>
#include <string>
#include <tuple>

#include "bench/truths/strikes.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"
#include "tests/fixtures/standing.h"

namespace sunder::truths {
namespace {

/// A plate that is anchored at its foot, and a steel ball that hits its middle.
struct Shot {
  const char* material;
  double compressive_Pa, density_kg_m3, reinforcement_percent;
  double width_m, height_m, thickness_m, block_m;
  double radius_m, speed_m_s;
  int seeds;
};
struct Outcome {
  double exit_m_s = 0;  ///< Exit speed of the worst seed; 0 if the ball did not pass.
  double standing = 1;  ///< Least volume fraction of the plate that is still anchored.
};

double ball_kg(const Shot& shot) { return steel_ball_kg(shot.radius_m); }

/// Limit speed by CEA-EDF (Berriaud et al. 1978), with the factor of UKAEA (Barr 1990) for
/// reinforcement.
double limit_m_s(const Shot& shot) {
  const double slenderness =
      2 * shot.radius_m * shot.thickness_m * shot.thickness_m / ball_kg(shot);
  return std::sqrt(1.7 * (shot.reinforcement_percent + 0.3) * shot.compressive_Pa *
                   std::cbrt(shot.density_kg_m3) * std::pow(slenderness, 4 / 3.));
}

/// Exit speed by Recht and Ipson (1963) for a plug of the ball's cross-section.
double theory_m_s(const Shot& shot) {
  const double plug_kg =
      std::numbers::pi * shot.radius_m * shot.radius_m * shot.thickness_m * shot.density_kg_m3;
  const double limit = limit_m_s(shot), v = shot.speed_m_s;
  return std::sqrt(std::max(0.0, v * v - limit * limit)) / (1 + plug_kg / ball_kg(shot));
}

Outcome simulate_shot(const Shot& shot, const Preset& preset, int seed) {
  const double gap_m = std::max(0.02, 0.002 * shot.speed_m_s);
  const double path_m = 2 * gap_m + 2 * shot.thickness_m + 4 * shot.radius_m;
  const double duration_s = std::min(1.0, 0.1 + 8 * path_m / shot.speed_m_s);
  const std::string text =
      "[scene]\ndescription = \"A shot.\"\nduration_s = " + std::to_string(duration_s) +
      "\nseed = " + std::to_string(seed) +
      "\n[limits]\ndust = 0\n[[solid]]\nstructure = \"box\"\nanchored = \"bottom\"\nmaterial = \"" +
      shot.material + "\"\nsize_m = [" + std::to_string(shot.width_m) + ", " +
      std::to_string(shot.height_m) + ", " + std::to_string(shot.thickness_m) + "]\n" +
      blocks(shot.block_m) + "[[ball]]\nposition = [" +
      std::to_string(0.003 * seed * shot.width_m) + ", " + std::to_string(0.5 * shot.height_m) +
      ", " + std::to_string(shot.radius_m + 0.5 * shot.thickness_m + gap_m) +
      "]\nvelocity = [0, 0, " + std::to_string(-shot.speed_m_s) +
      "]\nradius_m = " + std::to_string(shot.radius_m) + "\n";
  Scene scene = scenes::parse_scene(text, "shot.toml", {preset.name, {}});
  const std::size_t ball = scene.solids.size();
  const auto simulation = scenes::make_simulation(std::move(scene));
  Outcome outcome;
  FramePtr last;
  while (FramePtr frame = simulation->next()) {
    for (const FrameBody& body : frame->bodies) {
      const bool is_out = body.X_WB.position.z() < -(shot.radius_m + 0.5 * shot.thickness_m + 0.01);
      if (body.key == ball && is_out && outcome.exit_m_s == 0)
        outcome.exit_m_s = -body.velocity_W.z();
    }
    last = std::move(frame);
  }
  outcome.standing = share_standing(*last, ball);
  return outcome;
}

/// Returns the speed of a ball behind a house wall that it hits beside a window; 0 if it did not
/// pass.
double exit_of_house(double radius_m, double speed_m_s, int seed, const Preset& preset) {
  const double wall_m = 0.3;
  const std::string text =
      "[scene]\ndescription = \"A shot.\"\nduration_s = 1\nseed = " + std::to_string(seed) +
      "\n[limits]\ndust = 0\n[[solid]]\nstructure = \"house\"\nanchored = \"bottom\"\n"
      "[[ball]]\nposition = [-0.5, 1.5, " +
      std::to_string(-3.05 - radius_m) + "]\nvelocity = [0, 0, " + std::to_string(speed_m_s) +
      "]\nradius_m = " + std::to_string(radius_m) + "\n";
  Scene scene = scenes::parse_scene(text, "house.toml", {preset.name, {}});
  const std::size_t ball = scene.solids.size();
  const auto simulation = scenes::make_simulation(std::move(scene));
  while (FramePtr frame = simulation->next()) {
    for (const FrameBody& body : frame->bodies) {
      if (body.key == ball && body.X_WB.position.z() > -3 + wall_m + radius_m + 0.05)
        return body.velocity_W.z();
    }
  }
  return 0;
}

/// Relative error of the exit speed for the worst of eight seeds; theory is that of theory_m_s().
Measure exit_speed_of_house(double radius_m, double speed_m_s) {
  return [=](const Preset& preset) {
    Shot shot = {"brick", 8e6, 1900, 0, 8, 6, 0.3, 1.6, radius_m, speed_m_s, 8};
    const double theory = theory_m_s(shot);
    double worst = 0;
    for (int seed = 1; seed <= shot.seeds; ++seed) {
      const double error = exit_of_house(radius_m, speed_m_s, seed, preset) / theory - 1;
      if (std::abs(error) > std::abs(worst)) worst = error;
    }
    return worst;
  };
}

const Outcome& worst_of(const Shot& shot, const Preset& preset) {
  static std::map<std::tuple<std::string, double, double, double, double, std::string>, Outcome>
      cache;
  const auto [place, is_new] = cache.try_emplace(
      {shot.material, shot.thickness_m, shot.block_m, shot.radius_m, shot.speed_m_s, preset.name});
  Outcome& worst = place->second;
  if (!is_new) return worst;
  const double theory = theory_m_s(shot);
  for (int seed = 1; seed <= shot.seeds; ++seed) {
    const Outcome one = simulate_shot(shot, preset, seed);
    if (seed == 1 || std::abs(one.exit_m_s - theory) > std::abs(worst.exit_m_s - theory))
      worst.exit_m_s = one.exit_m_s;
    worst.standing = std::min(worst.standing, one.standing);
  }
  return worst;
}

Shot wall(double speed_m_s, double thickness_m = 0.4, double block_m = 0.6) {
  return {"brick", 8e6, 1900, 0, 6, 3, thickness_m, block_m, 0.4, speed_m_s, 8};
}

Measure exit_speed(const Shot& shot) {
  return [=](const Preset& preset) {
    const double theory = theory_m_s(shot);
    return (worst_of(shot, preset).exit_m_s - theory) / theory;
  };
}

Measure share_fallen(const std::vector<Shot>& shots) {
  return [=](const Preset& preset) {
    double standing = 1;
    for (const Shot& shot : shots) standing = std::min(standing, worst_of(shot, preset).standing);
    return 1 - standing;
  };
}

/// Logarithm of the limit speed found, divided by that of the formula for reinforced concrete.
Measure limit_of_concrete(double thickness_m, double radius_m) {
  return [=](const Preset& preset) {
    Shot shot{"concrete", 3e7, 2400, 0.7, 3, 3, thickness_m, 0, radius_m, 0, 1};
    const double limit = limit_m_s(shot);
    const double found = threshold(0.4 * limit, 2.5 * limit, 7, [&](double speed_m_s) {
      shot.speed_m_s = speed_m_s;
      return simulate_shot(shot, preset, 1).exit_m_s > 0;
    });
    return std::log(found / limit);
  };
}

/// Shots at walls of masonry, stone and concrete, 0.05 to 0.8 m thick, with balls of 4 kg to 2 t,
/// in the formula's range of thickness: a third of the ball's diameter to four diameters.
const std::vector<Shot>& grid() {
  static const std::vector<Shot> kAll = [] {
    std::vector<Shot> all;
    for (const auto& [material, compressive_Pa, density_kg_m3, percent] :
         {std::tuple{"brick", 8e6, 1900., 0.},
          {"stone", 2e7, 2400., 0.},
          {"concrete", 3e7, 2400., 0.3}}) {
      for (const double thickness_m : {0.05, 0.1, 0.2, 0.4, 0.8}) {
        for (const double radius_m : {0.05, 0.1, 0.2, 0.4}) {
          const double widths = thickness_m / (2 * radius_m);
          if (widths < 0.33 || widths > 4) continue;
          const double side_m = std::max(1.5, 8 * radius_m);
          const double block_m = all.size() % 2 == 0 ? 0 : 0.4;
          Shot shot{material,    compressive_Pa, density_kg_m3, percent, side_m, side_m,
                    thickness_m, block_m,        radius_m,      0,       1};
          const double limit = limit_m_s(shot);
          for (const double times : {0.5, 1 / 1.5, 1.5, 2., 3.5}) {
            shot.speed_m_s = times * limit;
            if (shot.speed_m_s >= 5 && shot.speed_m_s <= 200) all.push_back(shot);
          }
        }
      }
    }
    return all;
  }();
  return kAll;
}

/// Returns the shots of the grid whose speed is `least` to `most` times the limit speed.
std::vector<Shot> grid_shots(double least, double most) {
  std::vector<Shot> some;
  std::ranges::copy_if(grid(), std::back_inserter(some), [&](const Shot& shot) {
    const double times = shot.speed_m_s / limit_m_s(shot);
    return times >= least && times <= most;
  });
  return some;
}

/// Fraction of the shots at `least` to `most` times the limit speed whose exit speed is wrong.
Measure share_of_grid(double least, double most, bool (*is_wrong)(double exit_m_s, const Shot&)) {
  return [=](const Preset& preset) {
    const std::vector<Shot> shots = grid_shots(least, most);
    const auto wrong = std::ranges::count_if(
        shots, [&](const Shot& shot) { return is_wrong(worst_of(shot, preset).exit_m_s, shot); });
    return static_cast<double>(wrong) / static_cast<double>(shots.size());
  };
}

}  // namespace

Truths perforation_truths() {
  const char* recht = "Recht and Ipson 1963, CEA-EDF, UKAEA";
  const Shot bullet{"glass", 5e8, 2500, 0, 1.2, 1.2, 0.006, 0, 0.00598, 400, 1};
  return {
      truth(43, "ball of 2.1 t at 20 m/s through 0.4 m of brick: exit speed", "", recht, 0.15,
            exit_speed(wall(20)), {0.15, 0.15, 0.15, 0.15}),
      truth(43, "ball of 2.1 t at 40 m/s through 0.4 m of brick: exit speed", "", recht, 0.15,
            exit_speed(wall(40)), {0.15, 0.15, 0.15, 0.15}),
      truth(43, "ball of 2.1 t at 80 m/s through 0.4 m of brick: exit speed", "", recht, 0.15,
            exit_speed(wall(80)), {0.15, 0.15, 0.15, 0.15}),
      truth(43, "ball of 2.1 t at 20 m/s through 0.3 m of brick in blocks of 0.3 m: exit speed", "",
            recht, 0.15, exit_speed(wall(20, 0.3, 0.3)), {0.15, 0.15, 0.15, 0.15}),
      truth(43, "ball of 2.1 t at 40 m/s through one block of brick: exit speed", "", recht, 0.15,
            exit_speed(wall(40, 0.4, 0)), {0.15, 0.15, 0.15, 0.15}),
      truth(43, "ball of 5 t at 8 m/s beside a window of a house: exit speed", "", recht, 0.15,
            exit_speed_of_house(0.535, 8), {0.15, 0.15, 0.15, 0.15}),
      truth(43, "ball of 5 t at 30 m/s beside a window of a house: exit speed", "", recht, 0.15,
            exit_speed_of_house(0.535, 30), {0.15, 0.15, 0.15, 0.15}),
      truth(43, "bullet of 7 g at 400 m/s through 6 mm of glass: exit speed", "", recht, 0.15,
            exit_speed(bullet), {0.15, 0.15, 0.15, 0.15}),
      truth(43, "wall of brick, 0.4 m, shot at 20, 40 and 80 m/s: share that falls", "",
            "momentum through the plug", 0.2, share_fallen({wall(20), wall(40), wall(80)}),
            {0.2, 0.2, 0.2, 0.2}),
      truth(44, "concrete of 0.15 m, ball of 0.1 m: logarithm of the limit speed", "",
            "CEA-EDF (Berriaud et al. 1978)", 0.405, limit_of_concrete(0.15, 0.1),
            {0.405, 0.405, 0.405, 0.405}),
      truth(44, "concrete of 0.4 m, ball of 0.3 m: logarithm of the limit speed", "",
            "CEA-EDF (Berriaud et al. 1978)", 0.405, limit_of_concrete(0.4, 0.3),
            {0.405, 0.405, 0.405, 0.405}),
      truth(44, "concrete of 0.8 m, ball of 0.4 m: logarithm of the limit speed", "",
            "CEA-EDF (Berriaud et al. 1978)", 0.405, limit_of_concrete(0.8, 0.4),
            {0.405, 0.405, 0.405, 0.405}),
      truth(44, "198 shots at walls, those at 1/2 and 2/3 of the limit: share that comes through",
            "", recht, 0,
            share_of_grid(0, 0.7, [](double exit_m_s, const Shot&) { return exit_m_s > 0; }),
            {0, 0, 0, 0}),
      truth(44, "198 shots at walls, those at 1.5 to 3.5 of the limit: share that is stopped", "",
            recht, 0,
            share_of_grid(1.4, 10, [](double exit_m_s, const Shot&) { return exit_m_s == 0; }),
            {0, 0, 0, 0}),
      truth(44,
            "198 shots at walls, those at 2 and 3.5 of the limit: share a fifth off the exit speed",
            "", recht, 0,
            share_of_grid(1.9, 10,
                          [](double exit_m_s, const Shot& shot) {
                            return std::abs(exit_m_s / theory_m_s(shot) - 1) > 0.2;
                          }),
            {0, 0, 0, 0}),
  };
}

}  // namespace sunder::truths
