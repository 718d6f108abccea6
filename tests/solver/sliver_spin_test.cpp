// Tests that slivers on a sliding slab gain no spin from the energy that friction takes from it.
#include <algorithm>

#include <gtest/gtest.h>

#include "tests/fixtures/presets.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

class SliverSpin : public testing::TestWithParam<Preset> {};
INSTANTIATE_TEST_SUITE_P(Presets, SliverSpin, testing::ValuesIn(kPresets),
                         [](const auto& test) { return test.param.name; });

TEST_P(SliverSpin, GainsNoEnergyFromASlidingSlab) {
  constexpr double kSpin = 300, kSlide_m_s = 8, kAbove_m = 0.7, kG_m_s2 = 9.81;
  PresetWorld world(GetParam());
  world.add(W::ground());
  const Vec3 sliding(kSlide_m_s, 0, 0);
  world.add(W::moving(W::box(Vec3(8, 0.5, 8), Vec3(0, 0.25, 0), 2000), sliding));
  Random random(29);
  const Vec3 size(0.3, 0.06, 0.02);
  const BodyDesc sliver = W::box(size, Vec3::Zero(), 2000);
  const auto spin_J = [&](const BodyState& s) {
    const Vec3 w_B = s.X_WB.rotation.conjugate() * s.angular_velocity_W;
    return 0.5 * w_B.dot(sliver.inertia_B * w_B);
  };
  std::vector<BodyId> slivers;
  std::vector<double> energy_J;
  for (int i = 0; i < 36; ++i) {
    const Vec3 at(i % 6 - 2.5, kAbove_m, i / 6 - 2.5);
    const Vec3 drift = random.direction(), axis = random.direction();
    const BodyId id = world.add(W::moving(W::box(size, at, 2000), sliding + drift, kSpin * axis));
    const BodyState s = world.state(id);
    slivers.push_back(id);
    energy_J.push_back(spin_J(s) +
                       sliver.mass_kg * (0.5 * s.velocity_W.squaredNorm() + kG_m_s2 * kAbove_m));
  }
  double most = 0;
  world.watch(1, [&] {
    for (std::size_t i = 0; i < slivers.size(); ++i)
      most = std::max(most, spin_J(world.state(slivers[i])) / energy_J[i]);
  });
  EXPECT_LT(most, 1.2);  // slivers that meet exchange some
}

}  // namespace
}  // namespace sunder::solver
