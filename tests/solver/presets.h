// Truths are measured at every preset; the marks are those of `accurate`.
#pragma once

#include <cstdio>
#include <functional>

#include "tests/solver/rigid_world.h"

namespace sunder::solver {

inline constexpr double kG = 9.81, kPi = 3.14159265358979323846;

struct Preset {
  const char* name;
  double dt_s;
  int substeps;
  int sweeps = 1;
};
inline constexpr Preset kPresets[] = {{"draft", 1.0 / 60, 4},
                                      {"realtime", 1.0 / 120, 4},
                                      {"accurate", 1.0 / 120, 8},
                                      {"reference", 1.0 / 480, 4, 4}};

inline RigidOptions awake(const Vec3& gravity_W = Vec3(0, -kG, 0)) {
  RigidOptions options;
  options.gravity_W = gravity_W;
  options.sleeping = false;
  return options;
}
inline RigidOptions awake(const Preset& preset, const Vec3& gravity_W = Vec3(0, -kG, 0)) {
  RigidOptions options = awake(gravity_W);
  options.sweeps = preset.sweeps;
  return options;
}

/// Calls measure(preset) for each preset, prints, and returns the value at `accurate`.
inline double at_each_preset(const char* what,
                             const std::function<double(const Preset&)>& measure) {
  double accurate = 0;
  std::printf("%-44s", what);
  for (const Preset& preset : kPresets) {
    const double value = measure(preset);
    std::printf("  %s %.4g", preset.name, value);
    if (&preset == &kPresets[2]) accurate = value;
  }
  std::printf("\n");
  return accurate;
}

}  // namespace sunder::solver
