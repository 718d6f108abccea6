// Fast bodies that meet in flight, further in a step than they are thick: where the closed form
// says that they touch, whatever the step.
#include <algorithm>
#include <cmath>
#include <cstdio>

#include <gtest/gtest.h>

#include "bench/truths/rigid_world.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;
constexpr double kTimeSteps[] = {1.0 / 30, 1.0 / 60, 1.0 / 120, 1.0 / 240, 1.0 / 480};
constexpr double kSpeed_m_s = 500;
constexpr double kRounding = 5e-6;  // of a momentum, by 128 sweeps in single precision

/// Sweeps enough for the four corners of a face to share an impact evenly.
RigidOptions space() {
  RigidOptions options;
  options.gravity_W = Vec3::Zero();
  options.sleeping = false;
  options.sweeps = 32;
  return options;
}

BodyDesc thrown(BodyDesc desc, const Vec3& velocity_W) {
  desc.velocity_W = velocity_W;
  return W::with_friction(desc, 0);
}

struct Meeting {
  BodyState a, b;
  double momentum_error = 0;  ///< Of the larger of the two momenta.
};

/// Two bodies fly for 0.1 s.
Meeting meet(const BodyDesc& a, const BodyDesc& b, double dt_s) {
  RigidWorld world(space());
  const BodyId id_a = world.add(a), id_b = world.add(b);
  const Vec3 before = world.momentum();
  world.run(0.1, dt_s, 4);
  const double scale = std::max(a.mass_kg * a.velocity_W.norm(), b.mass_kg * b.velocity_W.norm());
  return {world.state(id_a), world.state(id_b), (world.momentum() - before).norm() / scale};
}

TEST(MeetingTruth, BodiesHeadOnStopEachOtherWhereTheyMeet) {
  // A light and a heavy one; after they have met they go on as one.
  const double kSize_m = 0.1, kStart_m = 17.3;
  const Vec3 way = Vec3::UnitX() * kSpeed_m_s;
  for (const bool balls : {true, false}) {
    for (const double dt_s : kTimeSteps) {
      auto body = [&](const Vec3& at, double density, const Vec3& velocity) {
        const BodyDesc desc = balls ? W::sphere(0.5 * kSize_m, at, density)
                                    : W::box(Vec3::Constant(kSize_m), at, density);
        return thrown(desc, velocity);
      };
      const Meeting met = meet(body(Vec3(-kStart_m, 0, 0), 1000, way),
                               body(Vec3(kStart_m, 0, 0), 3000, -way), dt_s);
      const double together_m_s = -0.5 * kSpeed_m_s;
      const double meet_s = (2 * kStart_m - kSize_m) / (2 * kSpeed_m_s);
      const double gap_at_m = kStart_m - 0.5 * kSize_m - kSpeed_m_s * meet_s;  // between them
      const double gap_m = gap_at_m + together_m_s * (0.1 - meet_s);
      const double error_m = std::max(std::abs(met.a.X_WB.position.x() - (gap_m - 0.5 * kSize_m)),
                                      std::abs(met.b.X_WB.position.x() - (gap_m + 0.5 * kSize_m)));
      std::printf("%s head-on, dt 1/%.0f: place off by %.2g m, speed by %.2g m/s, momentum %.1e\n",
                  balls ? "balls" : "cubes", 1 / dt_s, error_m,
                  std::abs(met.a.velocity_W.x() - together_m_s), met.momentum_error);
      EXPECT_LT(error_m, 1e-3);
      EXPECT_NEAR(met.a.velocity_W.x(), together_m_s, 1e-2);
      EXPECT_NEAR(met.b.velocity_W.x(), together_m_s, 1e-2);
      EXPECT_LT(met.momentum_error, kRounding);
    }
  }
}

TEST(MeetingTruth, BallsThatCrossPartAlongTheNormalOfTheirMeeting) {
  const double kRadius_m = 0.05, kStart_m = 20.7;
  for (const double dt_s : kTimeSteps) {
    const Vec3 start_a(-kStart_m, 0, 0), start_b(0, 0, -kStart_m + kRadius_m);
    const Vec3 v_a(kSpeed_m_s, 0, 0), v_b(0, 0, kSpeed_m_s);
    const Meeting met = meet(thrown(W::sphere(kRadius_m, start_a), v_a),
                             thrown(W::sphere(kRadius_m, start_b), v_b), dt_s);
    // |start + t·v| = 2 r, the earlier of both times.
    const Vec3 start = start_b - start_a, v = v_b - v_a;
    const double along = start.dot(v), square = v.squaredNorm();
    const double meet_s =
        (-along -
         std::sqrt(along * along - square * (start.squaredNorm() - 4 * kRadius_m * kRadius_m))) /
        square;
    const Vec3 normal = (start + meet_s * v).normalized();
    const Vec3 change = 0.5 * v.dot(normal) * normal;  // equal masses, no restitution
    const double speed_error = std::max((met.a.velocity_W - (v_a + change)).norm(),
                                        (met.b.velocity_W - (v_b - change)).norm());
    const Vec3 end_a = start_a + 0.1 * v_a + (0.1 - meet_s) * change;
    const double error_m = (met.a.X_WB.position - end_a).norm();
    std::printf("balls that cross, dt 1/%.0f: place off by %.2g m, velocity by %.2g m/s, %.1e\n",
                1 / dt_s, error_m, speed_error, met.momentum_error);
    // The normal is that of the moment when they come within the margin of a contact.
    EXPECT_LT(speed_error, 5e-3 * kSpeed_m_s);
    EXPECT_LT(error_m, 5e-3 * kSpeed_m_s * (0.1 - meet_s));
    EXPECT_LT(met.momentum_error, kRounding);
  }
}

TEST(MeetingTruth, AFastThinPlateTakesABallAlong) {
  const double kThick_m = 0.01, kRadius_m = 0.05;
  for (const double dt_s : kTimeSteps) {
    BodyDesc plate = W::box(Vec3(kThick_m, 1, 1), Vec3(-9.1, 0, 0));
    BodyDesc ball = W::sphere(kRadius_m, Vec3(1.3, 0, 0), 2000);
    plate.mass_kg = 10;
    const Meeting met = meet(thrown(plate, Vec3(300, 0, 0)), thrown(ball, Vec3::Zero()), dt_s);
    const double together_m_s = 300 * plate.mass_kg / (plate.mass_kg + ball.mass_kg);
    const double meet_s = (1.3 + 9.1 - kRadius_m - 0.5 * kThick_m) / 300;
    const double end_m = 1.3 + together_m_s * (0.1 - meet_s);
    const double gap_m =
        met.b.X_WB.position.x() - met.a.X_WB.position.x() - kRadius_m - 0.5 * kThick_m;
    std::printf("plate and ball, dt 1/%.0f: place off by %.2g m, apart %.2g m, momentum %.1e\n",
                1 / dt_s, met.b.X_WB.position.x() - end_m, gap_m, met.momentum_error);
    EXPECT_NEAR(met.b.X_WB.position.x(), end_m, 1e-3);
    EXPECT_NEAR(gap_m, 0, 1e-3);
    EXPECT_NEAR(met.b.velocity_W.x(), together_m_s, 1e-2);
    EXPECT_LT(met.momentum_error, kRounding);
  }
}

}  // namespace
}  // namespace sunder::solver
