// Tests of the plastic strength of a section against closed forms, and of a material's stress
// limits.
#include "engine/model/section.h"

#include <cmath>

#include <gtest/gtest.h>

#include "engine/model/material.h"

namespace sunder {
namespace {

/// Returns the strength of a rectangle of width b (along z) and height h (along y), normal to x, of
/// yield stress 1 Pa. Its strength in torsion is arbitrary.
SectionStrength rectangle(double b, double h) {
  return {Mat3::Identity(), b * h, b * h / std::sqrt(3),
          Vec3(0.2 * b * b * h, b * b * h / 4, b * h * h / 4)};
}

TEST(Section, EachForceOrMomentAloneGivesItsRatioToTheStrength) {
  const SectionStrength s = rectangle(0.2, 0.3);
  EXPECT_NEAR(utilisation(s, {Vec3(0.7 * s.axial_N, 0, 0), Vec3::Zero()}), 0.7, 1e-12);
  EXPECT_NEAR(utilisation(s, {Vec3(-0.7 * s.axial_N, 0, 0), Vec3::Zero()}), 0.7, 1e-12);
  EXPECT_NEAR(utilisation(s, {Vec3(0, 0.3 * s.shear_N, 0.4 * s.shear_N), Vec3::Zero()}), 0.5,
              1e-12);
  for (int axis = 0; axis < 3; ++axis) {
    const Vec3 moment = 1.5 * s.moment_Nm[axis] * Vec3::Unit(axis);
    EXPECT_NEAR(utilisation(s, {Vec3::Zero(), moment}), 1.5, 1e-12);
  }
  EXPECT_EQ(utilisation(s, {}), 0);
}

TEST(Section, ARectangleUnderMomentAndAxialForceYieldsAsInTheory) {
  // A band of height |n|·h in the middle bears the axial force, and the rest bears the moment.
  const double b = 0.2, h = 0.3;
  for (const double n : {-0.8, -0.3, 0.1, 0.5, 0.95}) {
    const double moment = b * h * h / 4 * (1 - n * n);
    const Wrench wrench{Vec3(n * b * h, 0, 0), Vec3(0, 0, moment)};
    EXPECT_NEAR(utilisation(rectangle(b, h), wrench), 1, 1e-12) << n;
    // Utilisation is a load factor: it doubles with the load.
    EXPECT_NEAR(utilisation(rectangle(b, h), {2 * wrench.force_N, 2 * wrench.moment_Nm}), 2, 1e-12);
  }
}

TEST(Section, UtilisationDoesNotDependOnOrientation) {
  SectionStrength s = rectangle(0.2, 0.3);
  const Wrench wrench{Vec3(0.01, 0.02, 0.003), Vec3(1e-3, -2e-3, 3e-3)};
  const double before = utilisation(s, wrench);
  const Mat3 turn = Quat(0.4, -0.2, 0.7, 0.1).normalized().toRotationMatrix();
  s.axes_R = turn;
  EXPECT_NEAR(utilisation(s, {turn * wrench.force_N, turn * wrench.moment_Nm}), before, 1e-12);
}

TEST(Material, AYieldStressCountsAsAStressLimit) {
  Material material;
  EXPECT_FALSE(material.breaks_by_load());
  material.yield_Pa = 2e8;
  EXPECT_TRUE(material.yields());
  EXPECT_TRUE(material.breaks_by_load());
  EXPECT_EQ(material.min_stress_limit_Pa(), 2e8);
}

}  // namespace
}  // namespace sunder
