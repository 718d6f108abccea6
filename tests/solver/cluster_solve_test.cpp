// Contacts of a cluster solved at once: whatever they are, and however many, they take energy.
#include "solver/impact/cluster_solve.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace sunder::solver {
namespace {

/// Bodies of between a tenth of a gram and 1000 tonnes that touch each other by faces, at four
/// points each; a few of them hit the others.
struct Cluster {
  std::vector<double> mass_kg, inertia_kgm2;
  std::vector<BodyVelocity> velocities;
  std::vector<ContactRow> rows;

  double kinetic_J(const std::vector<BodyVelocity>& v) const {
    double sum = 0;
    for (std::size_t b = 0; b < v.size(); ++b)
      sum += 0.5 * (mass_kg[b] * v[b].linear.squaredNorm() +
                    inertia_kgm2[b] * v[b].angular.squaredNorm());
    return sum;
  }
};

Cluster random_cluster(Random& random) {
  Cluster cluster;
  const std::uint32_t bodies = 8 + random.below(25), faces = 13 + random.below(60);
  std::vector<double> radius_m;
  for (std::uint32_t b = 0; b < bodies; ++b) {
    cluster.mass_kg.push_back(std::pow(10, random.uniform(-4, 6)));
    radius_m.push_back(std::cbrt(cluster.mass_kg[b] / 1e4));
    cluster.inertia_kgm2.push_back(0.1 * cluster.mass_kg[b] * radius_m[b] * radius_m[b]);
    cluster.velocities.emplace_back();
    if (b == 0 || random.below(8) == 0)
      cluster.velocities[b] = {20 * random.direction(), random.direction()};
  }
  for (std::uint32_t f = 0; f < faces; ++f) {
    ContactRow row;
    row.moves_a = row.moves_b = true;
    row.a = f % bodies;
    row.b = (row.a + 1 + random.below(bodies - 1)) % bodies;
    row.normal = random.direction();
    const Vec3 across = row.normal.unitOrthogonal(), along = row.normal.cross(across);
    const double half_m = 0.5 * std::min(radius_m[row.a], radius_m[row.b]);
    for (const double x : {-half_m, half_m}) {
      for (const double y : {-half_m, half_m}) {
        const Vec3 offset = x * across + y * along;
        row.angular_a = (radius_m[row.a] * row.normal + offset).cross(row.normal);
        row.angular_b = (offset - radius_m[row.b] * row.normal).cross(row.normal);
        row.linear_response_a = row.normal / cluster.mass_kg[row.a];
        row.linear_response_b = row.normal / cluster.mass_kg[row.b];
        row.angular_response_a = row.angular_a / cluster.inertia_kgm2[row.a];
        row.angular_response_b = row.angular_b / cluster.inertia_kgm2[row.b];
        row.inverse_mass = row.coupling(row);
        cluster.rows.push_back(row);
      }
    }
  }
  return cluster;
}

TEST(ClusterSolve, TakesEnergyHoweverManyTouch) {
  Random random(1, 48);
  for (int i = 0; i < 1000; ++i) {
    const Cluster cluster = random_cluster(random);
    std::vector<std::uint32_t> all(cluster.rows.size());
    std::iota(all.begin(), all.end(), 0u);
    double fastest_m_s = 0;
    for (const ContactRow& row : cluster.rows)
      fastest_m_s = std::max(fastest_m_s, row.speed(cluster.velocities));
    const double give = 1e-5 / *std::ranges::max_element(cluster.mass_kg);
    const ClusterMotion solved =
        solve_cluster(cluster.rows, all, all, give, fastest_m_s, cluster.velocities);
    const double before_J = cluster.kinetic_J(cluster.velocities);
    const double after_J = cluster.kinetic_J(solved.velocities);
    double work_J = 0;
    for (std::size_t c = 0; c < all.size(); ++c) {
      EXPECT_GE(solved.impulses_Ns[c], 0);
      const ContactRow& row = cluster.rows[c];
      work_J += 0.5 * solved.impulses_Ns[c] *
                (row.speed(cluster.velocities) + row.speed(solved.velocities));
    }
    EXPECT_LE(after_J, (1 + 1e-12) * before_J) << i << ", " << all.size() << " contacts";
    EXPECT_NEAR(work_J, before_J - after_J, 1e-9 * before_J);
  }
}

}  // namespace
}  // namespace sunder::solver
