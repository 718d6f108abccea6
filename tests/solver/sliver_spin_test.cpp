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
  constexpr double kSpin = 300, kSlide_m_s = 8;
  PresetWorld world(GetParam());
  world.add(W::ground());
  const Vec3 sliding(kSlide_m_s, 0, 0);
  world.add(W::moving(W::box(Vec3(8, 0.5, 8), Vec3(0, 0.25, 0), 2000), sliding));
  Random random(29);
  const Vec3 size(0.3, 0.06, 0.02);
  const BodyDesc sliver = W::box(size, Vec3::Zero(), 2000);
  const double most_kgm2 = sliver.inertia_B.diagonal().maxCoeff();
  std::vector<BodyId> slivers;
  for (int i = 0; i < 36; ++i) {
    const Vec3 at(i % 6 - 2.5, 0.7, i / 6 - 2.5);
    const Vec3 axis = random.direction(), drift = random.direction();
    slivers.push_back(world.add(W::moving(W::box(size, at, 2000), sliding + drift, kSpin * axis)));
  }
  double most_J = 0;
  world.watch(1, [&] {
    for (const BodyId id : slivers) {
      const BodyState s = world.state(id);
      const Vec3 w_B = s.X_WB.rotation.conjugate() * s.angular_velocity_W;
      most_J = std::max(most_J, 0.5 * w_B.dot(sliver.inertia_B * w_B));
    }
  });
  EXPECT_LT(most_J, 0.5 * most_kgm2 * kSpin * kSpin);
}

}  // namespace
}  // namespace sunder::solver
