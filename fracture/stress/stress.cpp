#include "fracture/stress/stress.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>

#include "fracture/adjacency/islands.h"

namespace sunder::fracture {
namespace {

// A bond is no stiffer than one between convexes this share of its width apart.
constexpr double kLeastDistance = 0.05;
constexpr double kNothing = 1e-11;  // of all forces: rounding
// Bonds of one plane within so many cells make one section.
constexpr double kWindowCells = 2;

/// Edge of the largest cell about each convex, what holds them not counted.
std::vector<double> cell_sizes(const Compound& compound) {
  std::vector<double> own, largest;
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    own.push_back(compound.anchored[c] ? 0 : std::cbrt(compound.convexes[c]->solid.volume_m3));
  }
  largest = own;
  for (const Bond& bond : compound.bonds) {
    largest[bond.a] = std::max(largest[bond.a], own[bond.b]);
    largest[bond.b] = std::max(largest[bond.b], own[bond.a]);
  }
  return largest;
}

}  // namespace

StressSystem::StressSystem(const Compound& compound, std::vector<BondGeometry> geometry,
                           std::span<const Material> materials, std::size_t spare_nodes)
    : geometry_(std::move(geometry)), overlaps_(!compound.ghosts.empty()) {
  weigh(compound, materials, nullptr);
  for (const std::uint8_t held : find_held(compound)) {
    node_of_convex_.push_back(held ? Spring::kWorld : static_cast<std::uint32_t>(nodes_++));
  }
  make_joints(compound, materials, nullptr);
  std::vector<Spring> springs;
  for (std::uint32_t i = 0; i < joints_.size(); ++i) {
    if (has_spring(i)) springs.push_back(spring_of(i));
  }
  add_overlaps(compound, materials, springs);
  springs_ = springs.size();
  if (nodes_ == 0) return;
  nodes_ += spare_nodes;
  multigrid_ = std::make_shared<const Multigrid>(nodes_, std::move(springs));
}

void StressSystem::weigh(const Compound& compound, std::span<const Material> materials,
                         const Edited* edited) {
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    if (edited && !overlaps_ && edited->origin.convexes[c] != StressOrigin::kNew) {
      const std::uint32_t was = edited->origin.convexes[c];
      centroids_.push_back(edited->old.centroids_[was]);
      masses_kg_.push_back(edited->old.masses_kg_[was]);
      inertias_.push_back(edited->old.inertias_[was]);
      continue;
    }
    const Convex& convex = *compound.convexes[c];
    const double density = materials[convex.material.value].density_kg_m3;
    centroids_.push_back(convex.solid.centroid);
    masses_kg_.push_back(density * convex.solid.volume_m3);
    inertias_.push_back(density * convex.solid.inertia());
  }
  for (const Ghost& ghost : compound.ghosts) {  // what is counted twice, shared
    const Convex& common = *ghost.convex;
    const double mass = materials[common.material.value].density_kg_m3 * common.solid.volume_m3;
    for (const std::uint32_t c : ghost.of) {
      masses_kg_[c] += ghost.sign * mass / static_cast<double>(ghost.of.size());
    }
  }
}

/// Convexes that do not move: anchored ones, and, of an island that nothing holds, the heaviest.
std::vector<std::uint8_t> StressSystem::find_held(const Compound& compound) {
  const std::vector<std::uint32_t> island = find_islands(compound);
  std::vector<std::vector<std::uint32_t>> members;
  for (std::uint32_t c = 0; c < island.size(); ++c) {
    if (island[c] == members.size()) members.emplace_back();
    members[island[c]].push_back(c);
  }
  std::vector<std::uint8_t> held(compound.anchored.begin(), compound.anchored.end());
  for (std::vector<std::uint32_t>& convexes : members) {
    if (std::any_of(convexes.begin(), convexes.end(), [&](auto c) { return held[c] != 0; })) {
      continue;
    }
    const auto heaviest = std::max_element(convexes.begin(), convexes.end(), [&](auto x, auto y) {
      return masses_kg_[x] < masses_kg_[y];
    });
    held[*heaviest] = 1;
    add_loose(std::move(convexes));
  }
  return held;
}

void StressSystem::add_loose(std::vector<std::uint32_t> convexes) {
  Loose loose;
  Mat3 inertia = Mat3::Zero();
  for (const std::uint32_t c : convexes) {
    loose.mass_kg += masses_kg_[c];
    loose.com_R += masses_kg_[c] * centroids_[c];
  }
  loose.com_R /= loose.mass_kg;
  for (const std::uint32_t c : convexes) {
    const Vec3 arm = centroids_[c] - loose.com_R;
    inertia += inertias_[c] +
               masses_kg_[c] * (arm.squaredNorm() * Mat3::Identity() - arm * arm.transpose());
  }
  loose.inverse_inertia = inertia.inverse();
  loose.convexes = std::move(convexes);
  loose_.push_back(std::move(loose));
}

bool StressSystem::has_spring(std::uint32_t bond) const {
  const Joint& joint = joints_[bond];
  return joint.stiffness_Pa_m > 0 &&
         (node_of_convex_[joint.a] != Spring::kWorld || node_of_convex_[joint.b] != Spring::kWorld);
}

Spring StressSystem::spring_of(std::uint32_t bond) const {
  const Joint& joint = joints_[bond];
  const BondGeometry& g = geometry_[bond];
  const Mat3 moment = g.second_moment.trace() * Mat3::Identity() - g.second_moment;
  return {node_of_convex_[joint.a], node_of_convex_[joint.b], g.centroid_R,
          joint.stiffness_Pa_m * g.area_m2, joint.stiffness_Pa_m * moment};
}

StressSystem::Joint StressSystem::make_joint(const Compound& compound, std::uint32_t number,
                                             std::span<const Material> materials) const {
  const Bond& bond = compound.bonds[number];
  const BondGeometry& g = geometry_[number];
  const auto stiffness = [&](std::uint32_t c) {
    return materials[compound.convexes[c]->material.value].youngs_Pa;
  };
  Joint joint;
  joint.plane = compound.convexes[bond.a]->polyhedron.faces[bond.face_a].id.value >> 1;
  if (!(g.area_m2 > 0)) return joint;
  const double distance = std::max(g.normal_R.dot(centroids_[bond.b] - centroids_[bond.a]),
                                   kLeastDistance * std::sqrt(g.area_m2));
  const double e_a = stiffness(bond.a), e_b = stiffness(bond.b);
  joint.stiffness_Pa_m = 2 * e_a * e_b / (e_a + e_b) / distance;
  return joint;
}

void StressSystem::make_joints(const Compound& compound, std::span<const Material> materials,
                               const Edited* edited) {
  const std::vector<double> cell_m = cell_sizes(compound);
  std::vector<std::uint32_t> fresh,
      new_of_old(edited ? edited->old.joints_.size() : 0, StressOrigin::kNew);
  for (std::uint32_t i = 0; i < compound.bonds.size(); ++i) {
    const Bond& bond = compound.bonds[i];
    const std::uint32_t was = edited ? edited->origin.bonds[i] : StressOrigin::kNew;
    if (was == StressOrigin::kNew) {
      joints_.push_back(make_joint(compound, i, materials));
      fresh.push_back(i);
    } else {
      joints_.push_back(edited->old.joints_[was]);
      new_of_old[was] = i;
    }
    Joint& joint = joints_.back();
    joint.a = bond.a;
    joint.b = bond.b;
    joint.window_m = kWindowCells * std::max(cell_m[bond.a], cell_m[bond.b]);
  }
  const auto by_plane = [&](std::uint32_t x, std::uint32_t y) {
    return std::tie(joints_[x].plane, x) < std::tie(joints_[y].plane, y);
  };
  std::sort(fresh.begin(), fresh.end(), by_plane);
  std::vector<std::uint32_t> kept;  // in order still, as numbers keep theirs
  if (edited) kept = edited->old.by_plane_;
  for (std::uint32_t& bond : kept) bond = new_of_old[bond];
  std::erase(kept, StressOrigin::kNew);
  std::merge(kept.begin(), kept.end(), fresh.begin(), fresh.end(), std::back_inserter(by_plane_),
             by_plane);
}

/// Convexes that overlap are held together as if by a cube of what they have in common; such a
/// joint is no bond, and never breaks by load.
void StressSystem::add_overlaps(const Compound& compound, std::span<const Material> materials,
                                std::vector<Spring>& springs) const {
  for (const Ghost& ghost : compound.ghosts) {
    const Convex& common = *ghost.convex;
    const double edge = std::cbrt(std::max(common.solid.volume_m3, 1e-300));
    const double stretch = materials[common.material.value].youngs_Pa * edge;
    for (std::size_t i = 1; i < ghost.of.size(); ++i) {
      const std::uint32_t a = node_of_convex_[ghost.of[0]], b = node_of_convex_[ghost.of[i]];
      if (a == Spring::kWorld && b == Spring::kWorld) continue;
      springs.push_back(
          {a, b, common.solid.centroid, stretch, stretch * edge * edge / 6 * Mat3::Identity()});
    }
  }
}

/// Forces on convexes and torques about their centroids: loads and weight, less what accelerates
/// a loose island as a whole.
void StressSystem::weigh_down(std::span<const Load> loads, const Vec3& gravity_R,
                              std::vector<Vec3>& forces_N, std::vector<Vec3>& torques_Nm) const {
  forces_N.resize(centroids_.size());
  torques_Nm.assign(centroids_.size(), Vec3::Zero());
  for (std::size_t c = 0; c < centroids_.size(); ++c) forces_N[c] = masses_kg_[c] * gravity_R;
  for (const Load& load : loads) {
    forces_N[load.convex] += load.force_N;
    torques_Nm[load.convex] +=
        load.torque_Nm + (load.point_R - centroids_[load.convex]).cross(load.force_N);
  }
  for (const Loose& loose : loose_) {
    Vec3 force = Vec3::Zero(), torque = Vec3::Zero();
    for (const std::uint32_t c : loose.convexes) {
      force += forces_N[c];
      torque += torques_Nm[c] + (centroids_[c] - loose.com_R).cross(forces_N[c]);
    }
    const Vec3 acceleration = force / loose.mass_kg, spin = loose.inverse_inertia * torque;
    for (const std::uint32_t c : loose.convexes) {
      forces_N[c] -= masses_kg_[c] * (acceleration + spin.cross(centroids_[c] - loose.com_R));
      torques_Nm[c] -= inertias_[c] * spin;
    }
  }
}

SolveResult StressSystem::solve(std::span<const Load> loads, const Vec3& gravity_R,
                                double tolerance, int most_iterations,
                                std::vector<Displacement>& displacements) const {
  displacements.resize(centroids_.size());
  if (!multigrid_) return {0, 0, 0, true};
  std::vector<Vec3> forces_N, torques_Nm;
  weigh_down(loads, gravity_R, forces_N, torques_Nm);
  const SpringLevel<double>& level = multigrid_->springs();
  Nodal<double> f = level.zero(), x = level.zero();
  // Nodes stand where their springs have their centre, which is not the centroid.
  for (std::size_t c = 0; c < centroids_.size(); ++c) {
    const std::uint32_t node = node_of_convex_[c];
    if (node == Spring::kWorld) continue;
    const Vec3 arm = centroids_[c] - level.place(node);
    f[node] = {simd4<double>(forces_N[c]), simd4<double>(torques_Nm[c] + arm.cross(forces_N[c]))};
    const Displacement& d = displacements[c];
    x[node] = {simd4<double>(d.shift_R - d.turn_R.cross(arm)), simd4<double>(d.turn_R)};
  }
  // What falls freely has forces that cancel but for rounding.
  double applied_N = 0;
  for (const double mass : masses_kg_) applied_N += mass * gravity_R.norm();
  for (const Load& load : loads) applied_N += load.force_N.norm();
  const SolveResult result =
      multigrid_->solve(f, tolerance, kNothing * applied_N, most_iterations, x);
  for (std::size_t c = 0; c < centroids_.size(); ++c) {
    const std::uint32_t node = node_of_convex_[c];
    displacements[c] = {};
    if (node == Spring::kWorld) continue;
    const Vec3 arm = centroids_[c] - level.place(node), turn = vec3(x[node].angular);
    displacements[c] = {vec3(x[node].linear) + turn.cross(arm), turn};
  }
  return result;
}

StressSystem::Field StressSystem::field(std::uint32_t bond,
                                        std::span<const Displacement> displacements) const {
  const Joint& joint = joints_[bond];
  const BondGeometry& g = geometry_[bond];
  const Displacement &a = displacements[joint.a], &b = displacements[joint.b];
  const Vec3 turn = joint.stiffness_Pa_m * (b.turn_R - a.turn_R);
  const Vec3 stress =
      joint.stiffness_Pa_m * (b.shift_R + b.turn_R.cross(g.centroid_R - centroids_[joint.b]) -
                              a.shift_R - a.turn_R.cross(g.centroid_R - centroids_[joint.a]));
  Field field;
  field.mean_Pa = g.normal_R.dot(stress);
  field.slope_Pa_m = g.normal_R.cross(turn);
  field.shear_Pa = stress - field.mean_Pa * g.normal_R;
  field.twist_Pa_m = g.normal_R.dot(turn);
  return field;
}

BondStress StressSystem::bound(std::uint32_t bond,
                               std::span<const Displacement> displacements) const {
  const Field f = field(bond, displacements);
  const double reach = geometry_[bond].reach_m;
  const double bending = f.slope_Pa_m.norm() * reach;
  return {std::max(0.0, f.mean_Pa + bending), std::max(0.0, bending - f.mean_Pa),
          f.shear_Pa.norm() + std::abs(f.twist_Pa_m) * reach};
}

/// The bond's field with the tension that fits the section's best: of all that is linear in the
/// place the one of least ∫ (fit − tension)² dA over the bonds beside this one.
StressSystem::Field StressSystem::section_field(std::uint32_t bond,
                                                std::span<const Displacement> displacements) const {
  Field own = field(bond, displacements);
  const Joint& joint = joints_[bond];
  const BondGeometry& g = geometry_[bond];
  const auto [begin, end] =
      std::equal_range(by_plane_.begin(), by_plane_.end(), bond,
                       [&](auto x, auto y) { return joints_[x].plane < joints_[y].plane; });
  // About the bond's centroid, in an orthonormal basis of the plane.
  const Vec3 u =
      g.normal_R.cross(std::abs(g.normal_R.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitZ()).normalized();
  const Vec3 v = g.normal_R.cross(u);
  Mat3 matrix = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  int bonds = 0;
  for (auto it = begin; it != end; ++it) {
    const BondGeometry& h = geometry_[*it];
    const Vec3 arm = h.centroid_R - g.centroid_R;
    if (joints_[*it].stiffness_Pa_m <= 0 || arm.norm() > joint.window_m) continue;
    const Field other = field(*it, displacements);
    const Vec3 at(1, u.dot(arm), v.dot(arm));
    const Vec3 bend = h.second_moment * other.slope_Pa_m;
    matrix += h.area_m2 * at * at.transpose();
    matrix(1, 1) += u.dot(h.second_moment * u);
    matrix(1, 2) += u.dot(h.second_moment * v);
    matrix(2, 2) += v.dot(h.second_moment * v);
    right += h.area_m2 * other.mean_Pa * at + Vec3(0, u.dot(bend), v.dot(bend));
    ++bonds;
  }
  matrix(2, 1) = matrix(1, 2);
  if (bonds < 2) return own;
  const Vec3 fit = matrix.inverse() * right;
  if (!fit.allFinite()) return own;
  own.mean_Pa = fit[0];
  own.slope_Pa_m = fit[1] * u + fit[2] * v;
  return own;
}

BondStress StressSystem::stress(const Compound& compound, std::uint32_t bond,
                                std::span<const Displacement> displacements) const {
  BondStress worst;
  if (joints_[bond].stiffness_Pa_m <= 0) return worst;
  const Field f = section_field(bond, displacements);
  const BondGeometry& g = geometry_[bond];
  for (const Vec3& corner : bond_corners(compound, compound.bonds[bond])) {
    const Vec3 arm = corner - g.centroid_R;
    const double tension = f.mean_Pa + f.slope_Pa_m.dot(arm);
    worst.tension_Pa = std::max(worst.tension_Pa, tension);
    worst.compression_Pa = std::max(worst.compression_Pa, -tension);
    worst.shear_Pa =
        std::max(worst.shear_Pa, (f.shear_Pa + f.twist_Pa_m * g.normal_R.cross(arm)).norm());
  }
  return worst;
}

}  // namespace sunder::fracture
