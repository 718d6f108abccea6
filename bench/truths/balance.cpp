// Validation of static balance: overhangs and arches.
#include "bench/truths/truth.h"

namespace sunder::truths {
namespace {

/// Returns true if a stack of eight blocks with `factor` times the overhangs in balance falls.
bool overhang_falls(const Preset& preset, double factor) {
  PresetWorld world(preset);
  world.add(W::ground());
  world.add(W::fixed(W::box(Vec3(1, 1, 0.5), Vec3(0, 0.5, 0))));
  constexpr int kBlocks = 8;
  double x = 0;
  BodyId top;
  for (int level = 1; level <= kBlocks; ++level) {
    x += factor * 0.5 / (kBlocks + 1 - level);
    top = world.add(W::box(Vec3(1, 0.2, 0.5), Vec3(x, 0.9 + 0.2 * level, 0)));
  }
  const double before = world.state(top).X_WB.position.y();
  world.run(5);
  return world.state(top).X_WB.position.y() < before - 0.1;
}

double overhang_error(const Preset& preset) {
  return threshold(0.9, 1.05, 8, [&](double f) { return overhang_falls(preset, f); }) - 1;
}

/// Returns true if a semicircular arch of `count` voussoirs of radius 1 stands for 4 s.
bool arch_stands(const Preset& preset, int count, double thickness) {
  PresetWorld world(preset);
  world.add(W::with_friction(W::ground(), 1));
  std::vector<BodyId> stones;
  for (int i = 0; i < count; ++i) stones.push_back(world.add(W::voussoir(i, count, thickness)));
  const BodyId crown = stones[static_cast<std::size_t>(count / 2)];
  world.run(4);
  return world.state(crown).X_WB.position.y() > 0.9;
}

Measure thinnest_arch(int count, double truth) {
  return [=](const Preset& p) {
    const double thickness =
        threshold(0.08, 0.16, 7, [&](double s) { return arch_stands(p, count, s); });
    return thickness / truth - 1;
  };
}

}  // namespace

Truths balance_truths() {
  const char* heyman = "line of thrust, Milankovitch 1907, Heyman 1969";
  return {
      truth(10, "overhang of 8: farthest", "", "Σ L/2k", 0.005, overhang_error,
            {0.0005, 0.0005, 0.0005, 0.0005}),
      truth(11, "arch of 7: least thickness", "", heyman, 0.015, thinnest_arch(7, 0.09625),
            {0.0049, 0.0049, 0.0049, 0.0049}),
      truth(11, "arch of 11: least thickness", "", heyman, 0.015, thinnest_arch(11, 0.10491),
            {0.0032, 0.0032, 0.0032, 0.0032}),
      truth(11, "arch of 21: least thickness", "", heyman, 0.015, thinnest_arch(21, 0.10679),
            {0.05, 0.05, 0.015, 0.0056}),
  };
}

}  // namespace sunder::truths
