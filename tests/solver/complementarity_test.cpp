// Tests of the exact solve of an impact probe: impulses of contacts at any ratio of masses.
#include "solver/impact/complementarity.h"

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "engine/base/types.h"

namespace sunder::solver {
namespace {

struct Contacts {
  Eigen::MatrixXd A;
  Eigen::VectorXd closing_m_s;
};

/// Bodies of between a tenth of a kilogram and 200 tonnes that touch each other by faces, each at
/// four points, three of which would do; contacts give by 1e-5 of the heaviest, as the probe's do.
Contacts random_contacts(Random& random) {
  constexpr int kPoints = 4;
  const int bodies = 3 + static_cast<int>(random.below(10));
  const int faces = 2 + static_cast<int>(random.below(11));
  std::vector<double> mass_kg, radius_m;
  double heaviest_kg = 0;
  for (int b = 0; b < bodies; ++b) {
    mass_kg.push_back(std::pow(10.0, random.uniform(-1, 5.3)));
    radius_m.push_back(std::cbrt(mass_kg.back() / 1e4));
    heaviest_kg = std::max(heaviest_kg, mass_kg.back());
  }
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(faces * kPoints, 6 * bodies);
  Eigen::VectorXd inverse_mass(6 * bodies), velocity(6 * bodies);
  for (int b = 0; b < bodies; ++b) {
    const double inertia = 0.1 * mass_kg[std::size_t(b)] * std::pow(radius_m[std::size_t(b)], 2);
    inverse_mass.segment<6>(6 * b) << Vec3::Constant(1 / mass_kg[std::size_t(b)]),
        Vec3::Constant(1 / inertia);
    velocity.segment<6>(6 * b) << 5 * random.uniform() * random.direction(), random.direction();
  }
  for (int f = 0; f < faces; ++f) {
    const int a = static_cast<int>(random.below(std::uint32_t(bodies)));
    const int b = (a + 1 + static_cast<int>(random.below(std::uint32_t(bodies - 1)))) % bodies;
    const Vec3 normal = random.direction(), across = normal.unitOrthogonal();
    const Vec3 along = normal.cross(across);
    const double half_m = 0.5 * std::min(radius_m[std::size_t(a)], radius_m[std::size_t(b)]);
    for (int p = 0; p < kPoints; ++p) {
      const Vec3 offset = half_m * ((p & 1 ? 1 : -1) * across + (p & 2 ? 1 : -1) * along);
      const Vec3 arm_a = radius_m[std::size_t(a)] * normal + offset;
      const Vec3 arm_b = -radius_m[std::size_t(b)] * normal + offset;
      const int row = f * kPoints + p;
      J.row(row).segment<3>(6 * a) = normal.transpose();
      J.row(row).segment<3>(6 * a + 3) = arm_a.cross(normal).transpose();
      J.row(row).segment<3>(6 * b) = -normal.transpose();
      J.row(row).segment<3>(6 * b + 3) = -arm_b.cross(normal).transpose();
    }
  }
  Contacts contacts;
  contacts.A = J * inverse_mass.asDiagonal() * J.transpose();
  contacts.A.diagonal().array() += 1e-5 / heaviest_kg;
  contacts.closing_m_s = J * velocity;
  return contacts;
}

TEST(Complementarity, TakesEnergyAndStopsWhatClosesHoweverUnlikeTheMasses) {
  Random random(7);
  int tight = 0;
  for (int i = 0; i < 2000; ++i) {
    const Contacts c = random_contacts(random);
    const Eigen::VectorXd x = solve_complementarity(c.A, c.closing_m_s);
    ASSERT_GE(x.minCoeff(), 0) << i;
    const double gained_J = 0.5 * x.dot(c.A * x) - x.dot(c.closing_m_s);
    ASSERT_LE(gained_J, 0) << i << ": energy from nothing, and pieces fly apart";
    const Eigen::VectorXd left = c.closing_m_s - c.A * x;
    const double fastest = c.closing_m_s.cwiseAbs().maxCoeff();
    tight += left.maxCoeff() <= 1e-6 * fastest;
  }
  EXPECT_GE(tight, 1950) << "the others as far as rounding allows";
}

TEST(Complementarity, IsTheSameInAnyUnits) {
  Random random(8);
  for (int i = 0; i < 200; ++i) {
    const Contacts c = random_contacts(random);
    const Eigen::VectorXd x = solve_complementarity(c.A, c.closing_m_s);
    const double speed = std::exp2(-30), mass = std::exp2(20);  // exact, whatever is rounded
    const Eigen::VectorXd scaled = solve_complementarity(c.A / mass, speed * c.closing_m_s);
    ASSERT_EQ(scaled, speed * mass * x) << i;
  }
}

TEST(Complementarity, OfOneContactIsItsClosedForm) {
  const Eigen::MatrixXd A = Eigen::MatrixXd::Constant(1, 1, 4);
  EXPECT_DOUBLE_EQ(solve_complementarity(A, Eigen::VectorXd::Constant(1, 2))[0], 0.5);
  EXPECT_EQ(solve_complementarity(A, Eigen::VectorXd::Constant(1, -2))[0], 0);
}

}  // namespace
}  // namespace sunder::solver
