// The presets of scene files for physics worlds without a scene.
#pragma once

#include <array>
#include <cmath>

#include "bench/truths/rigid_world.h"

namespace sunder::solver {

inline constexpr double kG = 9.81, kPi = 3.14159265358979323846;

/// Copy of a preset of scenes::presets(); a test compares them.
struct Preset {
  const char* name;
  double dt_s;
  int substeps;
  int sweeps = 1;
};
inline constexpr std::array<Preset, 4> kPresets = {{{"draft", 1.0 / 60, 8},
                                                    {"realtime", 1.0 / 120, 4},
                                                    {"accurate", 1.0 / 120, 8},
                                                    {"reference", 1.0 / 480, 4, 4}}};

/// Returns options with gravity and without sleeping.
inline RigidOptions awake(const Vec3& gravity_W = Vec3(0, -kG, 0)) {
  RigidOptions options;
  options.gravity_W = gravity_W;
  options.sleeping = false;
  return options;
}

/// A world without sleeping that is advanced with the step, substeps and sweeps of a preset.
class PresetWorld : public RigidWorld {
 public:
  explicit PresetWorld(const Preset& preset, const Vec3& gravity_W = Vec3(0, -kG, 0))
      : RigidWorld(options_of(preset, gravity_W)), preset_(preset) {}

  SolveReport step() { return RigidWorld::step(preset_.dt_s, preset_.substeps); }
  SolveReport run(double time_s) { return RigidWorld::run(time_s, preset_.dt_s, preset_.substeps); }
  /// Advances the world by `time_s` and calls visit() after every step.
  template <class Visit>
  void watch(double time_s, const Visit& visit) {
    const auto steps = static_cast<int>(std::lround(time_s / preset_.dt_s));
    for (int i = 0; i < steps; ++i) step(), visit();
  }

 private:
  static RigidOptions options_of(const Preset& preset, const Vec3& gravity_W) {
    RigidOptions options = awake(gravity_W);
    options.sweeps = preset.sweeps;
    return options;
  }

  Preset preset_;
};

}  // namespace sunder::solver
