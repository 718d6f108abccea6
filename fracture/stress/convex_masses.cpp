#include "fracture/stress/convex_masses.h"

#include <algorithm>
#include <utility>

#include <Eigen/Dense>

#include "engine/base/state_checks.h"
#include "fracture/adjacency/islands.h"
#include "fracture/stress/spring_math.h"

namespace sunder::fracture {

ConvexMasses::ConvexMasses(const Compound& compound, std::span<const Material> materials,
                           const ConvexMasses* old, std::span<const std::uint32_t> old_of_new) {
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    if (old && compound.ghosts.empty() && old_of_new[c] != kNew) {
      const std::uint32_t was = old_of_new[c];
      centroids_.push_back(old->centroids_[was]);
      masses_kg_.push_back(old->masses_kg_[was]);
      inertias_.push_back(old->inertias_[was]);
      continue;
    }
    const Convex& convex = *compound.convexes[c];
    const double density = materials[convex.material.value].density_kg_m3;
    centroids_.push_back(convex.solid.centroid);
    masses_kg_.push_back(density * convex.solid.volume_m3);
    inertias_.push_back(density * convex.solid.inertia());
  }
  // Shares volume that is counted twice among the convexes.
  for (const Ghost& ghost : compound.ghosts) {
    const Convex& common = *ghost.convex;
    const double mass = materials[common.material.value].density_kg_m3 * common.solid.volume_m3;
    for (const std::uint32_t c : ghost.of) {
      masses_kg_[c] += ghost.sign * mass / static_cast<double>(ghost.of.size());
    }
  }
  find_fixed(compound);
}

const char* ConvexMasses::wrong_field() const {
  if (masses_kg_.size() != size()) return "masses_kg_";
  if (inertias_.size() != size()) return "inertias_";
  if (fixed_.size() != size()) return "fixed_";
  for (const FreeIsland& island : free_islands_)
    if (!all_below(island.convexes, size()) || !(island.mass_kg > 0)) return "free_islands_";
  return nullptr;
}

void ConvexMasses::find_fixed(const Compound& compound) {
  const std::vector<std::uint32_t> island = find_islands(compound);
  std::vector<std::vector<std::uint32_t>> members;
  for (std::uint32_t c = 0; c < island.size(); ++c) {
    if (island[c] == members.size()) members.emplace_back();
    members[island[c]].push_back(c);
  }
  fixed_.assign(compound.anchored.begin(), compound.anchored.end());
  for (std::vector<std::uint32_t>& convexes : members) {
    if (std::any_of(convexes.begin(), convexes.end(), [&](auto c) { return fixed_[c] != 0; })) {
      continue;
    }
    const auto heaviest = std::max_element(convexes.begin(), convexes.end(), [&](auto x, auto y) {
      return masses_kg_[x] < masses_kg_[y];
    });
    fixed_[*heaviest] = 1;
    add_free_island(std::move(convexes));
  }
}

void ConvexMasses::add_free_island(std::vector<std::uint32_t> convexes) {
  FreeIsland island;
  Mat3 inertia = Mat3::Zero();
  for (const std::uint32_t c : convexes) {
    island.mass_kg += masses_kg_[c];
    island.com_R += masses_kg_[c] * centroids_[c];
  }
  island.com_R /= island.mass_kg;
  for (const std::uint32_t c : convexes) {
    const Vec3 arm = centroids_[c] - island.com_R;
    inertia += inertias_[c] + masses_kg_[c] * parallel_axis(arm);
  }
  island.inverse_inertia = inertia.inverse();
  island.convexes = std::move(convexes);
  free_islands_.push_back(std::move(island));
}

void ConvexMasses::balance(std::span<const ConvexLoad> loads, const Vec3& gravity_R,
                           const Vec3& spin_R, std::vector<Vec3>& forces_N,
                           std::vector<Vec3>& torques_Nm) const {
  forces_N.resize(centroids_.size());
  torques_Nm.assign(centroids_.size(), Vec3::Zero());
  for (std::size_t c = 0; c < centroids_.size(); ++c) forces_N[c] = masses_kg_[c] * gravity_R;
  for (const ConvexLoad& load : loads) {
    forces_N[load.convex] += load.force_N;
    torques_Nm[load.convex] +=
        load.torque_Nm + (load.point_R - centroids_[load.convex]).cross(load.force_N);
  }
  for (const FreeIsland& island : free_islands_) {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (const std::uint32_t c : island.convexes) {
      const Vec3 arm = centroids_[c] - island.com_R;
      forces_N[c] -= masses_kg_[c] * spin_R.cross(spin_R.cross(arm));
      torques_Nm[c] -= spin_R.cross(inertias_[c] * spin_R);
      force += forces_N[c];
      torque += torques_Nm[c] + arm.cross(forces_N[c]);
    }
    // Angular acceleration by Euler's equations; the torque includes the gyroscopic term.
    const Vec3 acceleration = force / island.mass_kg, turn = island.inverse_inertia * torque;
    for (const std::uint32_t c : island.convexes) {
      forces_N[c] -= masses_kg_[c] * (acceleration + turn.cross(centroids_[c] - island.com_R));
      torques_Nm[c] -= inertias_[c] * turn;
    }
  }
}

DeflectionResponse ConvexMasses::response(std::span<const ConvexLoad> loads,
                                          std::span<const Displacement> displacements) const {
  std::vector<Vec3> forces_N, torques_Nm;
  balance(loads, Vec3::Zero(), Vec3::Zero(), forces_N, torques_Nm);
  DeflectionResponse all;
  for (std::size_t c = 0; c < centroids_.size(); ++c) {
    const Vec3 &u = displacements[c].shift_R, &turn = displacements[c].rotation_R;
    all.work_J += forces_N[c].dot(u) + torques_Nm[c].dot(turn);
    all.mass_kg_m2 += masses_kg_[c] * u.squaredNorm() + turn.dot(inertias_[c] * turn);
  }
  for (const FreeIsland& island : free_islands_) {
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero();
    for (const std::uint32_t c : island.convexes) {
      const Vec3 push = masses_kg_[c] * displacements[c].shift_R;
      linear += push;
      angular +=
          (centroids_[c] - island.com_R).cross(push) + inertias_[c] * displacements[c].rotation_R;
    }
    all.mass_kg_m2 -=
        linear.squaredNorm() / island.mass_kg + angular.dot(island.inverse_inertia * angular);
  }
  return all;
}

double ConvexMasses::applied_N(std::span<const ConvexLoad> loads, const Vec3& gravity_R,
                               const Vec3& spin_R) const {
  double applied_N = 0;
  for (const double mass : masses_kg_) applied_N += mass * gravity_R.norm();
  for (const ConvexLoad& load : loads) applied_N += load.force_N.norm();
  for (const FreeIsland& island : free_islands_) {
    for (const std::uint32_t c : island.convexes) {
      const Vec3 arm = centroids_[c] - island.com_R;
      applied_N += masses_kg_[c] * spin_R.cross(spin_R.cross(arm)).norm();
    }
  }
  return applied_N;
}

}  // namespace sunder::fracture
