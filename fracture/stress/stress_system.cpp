#include "fracture/stress/stress_system.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <tuple>
#include <utility>

#include "engine/base/roots.h"
#include "engine/base/state_checks.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

// Rounding error of balanced forces, over the sum of all forces.
constexpr double kForceRounding = 1e-11;

/// Returns, per convex, the edge of the largest free cell among it and its neighbours.
std::vector<double> cell_sizes(const Compound& compound) {
  std::vector<double> own, largest;
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    own.push_back(compound.anchored[c] ? 0 : cube_root(compound.convexes[c]->solid.volume_m3));
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
    : geometry_(std::move(geometry)),
      masses_(compound, materials),
      overlaps_(!compound.ghosts.empty()) {
  for (const std::uint8_t fixed : masses_.fixed()) {
    node_of_convex_.push_back(fixed ? Spring::kWorld : static_cast<std::uint32_t>(nodes_++));
  }
  make_bonds(compound, materials, nullptr);
  std::vector<Spring> springs;
  for (std::uint32_t i = 0; i < bonds_.size(); ++i) {
    if (has_spring(i)) springs.push_back(spring_of(i));
  }
  add_overlaps(compound, materials, springs);
  springs_ = springs.size();
  if (nodes_ == 0) return;
  nodes_ += spare_nodes;
  multigrid_ = std::make_shared<const Multigrid>(nodes_, std::move(springs));
}

StressSystem::StressSystem(const StressSystem& old, const Compound& compound,
                           std::vector<BondGeometry> geometry, std::span<const Material> materials,
                           const StressOrigin& origin)
    : geometry_(std::move(geometry)),
      masses_(compound, materials, &old.masses_, origin.convexes),
      overlaps_(!compound.ghosts.empty()) {
  const Edited edited{old, origin};
  SpringEdit edit;
  if (overlaps_ || old.overlaps_ || !old.multigrid_ || !number_nodes(edited, edit)) {
    *this = StressSystem(compound, std::move(geometry_), materials, spare_nodes(compound));
    return;
  }
  make_bonds(compound, materials, &edited);
  mark_changes(edited, edit);
  for (std::uint32_t i = 0; i < bonds_.size(); ++i) {
    if (!has_spring(i)) continue;
    ++springs_;
    const std::uint32_t a = node_of_convex_[bonds_[i].a], b = node_of_convex_[bonds_[i].b];
    if (edit.is_at(a) || edit.is_at(b)) edit.springs.push_back(spring_of(i));
  }
  multigrid_ = std::make_shared<const Multigrid>(*old.multigrid_, std::move(edit));
}

const char* StressSystem::wrong_field() const {
  if (bonds_.size() != geometry_.size()) return "bonds_";
  for (const ElasticBond& bond : bonds_)
    if (bond.a >= masses_.size() || bond.b >= masses_.size() || !(bond.stiffness_Pa_m >= 0) ||
        !(bond.window_m >= 0))
      return "bonds_";
  if (node_of_convex_.size() != masses_.size()) return "node_of_convex_";
  std::vector<std::uint32_t> nodes;
  for (const std::uint32_t node : node_of_convex_)
    if (node != Spring::kWorld) nodes.push_back(node);
  if (nodes_ != (multigrid_ ? multigrid_->springs().size() : nodes.size())) return "nodes_";
  if (!are_different_below(nodes, nodes_)) return "node_of_convex_";
  if (!multigrid_ && !nodes.empty()) return "multigrid_";
  if (by_plane_.size() != bonds_.size() || !are_different_below(by_plane_, bonds_.size()))
    return "by_plane_";
  const auto is_before = [&](std::uint32_t x, std::uint32_t y) {
    return std::tie(bonds_[x].plane, x) < std::tie(bonds_[y].plane, y);
  };
  return std::ranges::is_sorted(by_plane_, is_before) ? nullptr : "by_plane_";
}

bool StressSystem::has_spring(std::uint32_t bond) const {
  const ElasticBond& elastic = bonds_[bond];
  return elastic.stiffness_Pa_m > 0 && (node_of_convex_[elastic.a] != Spring::kWorld ||
                                        node_of_convex_[elastic.b] != Spring::kWorld);
}

Spring StressSystem::spring_of(std::uint32_t bond) const {
  const ElasticBond& elastic = bonds_[bond];
  const BondGeometry& g = geometry_[bond];
  const Mat3 moment = g.second_moment.trace() * Mat3::Identity() - g.second_moment;
  return {node_of_convex_[elastic.a], node_of_convex_[elastic.b], g.centroid_R,
          elastic.stiffness_Pa_m * g.area_m2, elastic.stiffness_Pa_m * moment};
}

StressSystem::ElasticBond StressSystem::make_bond(const Compound& compound, std::uint32_t number,
                                                  std::span<const Material> materials) const {
  const Bond& bond = compound.bonds[number];
  const BondGeometry& g = geometry_[number];
  ElasticBond elastic;
  elastic.plane = compound.convexes[bond.a]->polyhedron.faces[bond.face_a].id.value >> 1;
  if (!(g.area_m2 > 0)) return elastic;
  // Compliance of each convex from its centroid to the bond.
  double compliance_m_Pa = 0;
  for (const std::uint32_t c : {bond.a, bond.b}) {
    if (compound.anchored[c]) continue;
    const double distance_m = std::max(std::abs(g.normal_R.dot(g.centroid_R - masses_.centroid(c))),
                                       kMinSpringLength * std::sqrt(g.area_m2));
    compliance_m_Pa += distance_m / materials[compound.convexes[c]->material.value].youngs_Pa;
  }
  if (compliance_m_Pa > 0) elastic.stiffness_Pa_m = 1 / compliance_m_Pa;
  return elastic;
}

void StressSystem::make_bonds(const Compound& compound, std::span<const Material> materials,
                              const Edited* edited) {
  const std::vector<double> cell_m = cell_sizes(compound);
  std::vector<std::uint32_t> added,
      new_of_old(edited ? edited->old.bonds_.size() : 0, StressOrigin::kNew);
  for (std::uint32_t i = 0; i < compound.bonds.size(); ++i) {
    const Bond& bond = compound.bonds[i];
    const std::uint32_t was = edited ? edited->origin.bonds[i] : StressOrigin::kNew;
    if (was == StressOrigin::kNew) {
      bonds_.push_back(make_bond(compound, i, materials));
      added.push_back(i);
    } else {
      bonds_.push_back(edited->old.bonds_[was]);
      new_of_old[was] = i;
    }
    ElasticBond& elastic = bonds_.back();
    elastic.a = bond.a;
    elastic.b = bond.b;
    elastic.window_m = kSectionWindow * std::max(cell_m[bond.a], cell_m[bond.b]);
  }
  const auto by_plane = [&](std::uint32_t x, std::uint32_t y) {
    return std::tie(bonds_[x].plane, x) < std::tie(bonds_[y].plane, y);
  };
  std::sort(added.begin(), added.end(), by_plane);
  std::vector<std::uint32_t> kept;  // Already in order, as the order of bonds does not change.
  if (edited) kept = edited->old.by_plane_;
  for (std::uint32_t& bond : kept) bond = new_of_old[bond];
  std::erase(kept, StressOrigin::kNew);
  std::merge(kept.begin(), kept.end(), added.begin(), added.end(), std::back_inserter(by_plane_),
             by_plane);
}

/// Returns the spring of an overlap between its convexes `of[0]` and `of[i]`.
Spring StressSystem::spring_of(const Ghost& ghost, std::size_t i,
                               std::span<const Material> materials) const {
  const Convex& common = *ghost.convex;
  const double edge = cube_root(std::max(common.solid.volume_m3, 1e-300));
  const double stretch = materials[common.material.value].youngs_Pa * edge;
  return {node_of_convex_[ghost.of[0]], node_of_convex_[ghost.of[i]], common.solid.centroid,
          stretch, stretch * edge * edge / 6 * Mat3::Identity()};
}

void StressSystem::add_overlaps(const Compound& compound, std::span<const Material> materials,
                                std::vector<Spring>& springs) const {
  for (const Ghost& ghost : compound.ghosts) {
    for (std::size_t i = 1; i < ghost.of.size(); ++i) {
      Spring spring = spring_of(ghost, i, materials);
      if (spring.a != Spring::kWorld || spring.b != Spring::kWorld)
        springs.push_back(std::move(spring));
    }
  }
}

Wrench StressSystem::overlap_wrench(const Ghost& ghost, std::span<const Material> materials,
                                    std::span<const Displacement> displacements) const {
  const Spring spring = spring_of(ghost, 1, materials);
  const auto shift = [&](std::uint32_t convex) -> Vec3 {
    const Displacement& d = displacements[convex];
    return d.shift_R + d.rotation_R.cross(spring.place - masses_.centroid(convex));
  };
  return {spring.stretch_N_m * (shift(ghost.of[1]) - shift(ghost.of[0])),
          spring.rotation_Nm *
              (displacements[ghost.of[1]].rotation_R - displacements[ghost.of[0]].rotation_R)};
}

/// Keeps the nodes of old convexes, gives new ones free nodes; returns false if those are too few.
bool StressSystem::number_nodes(const Edited& edited, SpringEdit& edit) {
  const std::vector<std::uint8_t>& fixed = masses_.fixed();
  nodes_ = edited.old.nodes_;
  edit.changes.assign(nodes_, SpringEdit::Change::kNone);
  std::vector<std::uint8_t> taken(nodes_, 0);
  node_of_convex_.assign(fixed.size(), Spring::kWorld);
  for (std::size_t c = 0; c < fixed.size(); ++c) {
    const std::uint32_t was = edited.origin.convexes[c];
    if (fixed[c] || was == StressOrigin::kNew) continue;
    node_of_convex_[c] = edited.old.node_of_convex_[was];
    if (node_of_convex_[c] != Spring::kWorld) taken[node_of_convex_[c]] = 1;
  }
  for (const std::uint32_t node : edited.old.node_of_convex_) {
    if (node != Spring::kWorld && !taken[node]) edit.changes[node] = SpringEdit::Change::kSprings;
  }
  std::uint32_t free = 0;
  for (std::size_t c = 0; c < fixed.size(); ++c) {
    if (fixed[c] || node_of_convex_[c] != Spring::kWorld) continue;
    while (free < nodes_ && taken[free]) ++free;
    if (free == nodes_) return false;
    node_of_convex_[c] = free;
    edit.changes[free++] = SpringEdit::Change::kNew;
  }
  return true;
}

/// Marks the nodes of bonds that were added, were removed or now connect other nodes.
void StressSystem::mark_changes(const Edited& edited, SpringEdit& edit) const {
  const auto mark = [&](std::uint32_t convex) {
    const std::uint32_t node = node_of_convex_[convex];
    if (node == Spring::kWorld || edit.is_at(node)) return;
    edit.changes[node] = SpringEdit::Change::kSprings;
  };
  const auto moved = [&](std::uint32_t convex) {
    const std::uint32_t was = edited.origin.convexes[convex];
    return was == StressOrigin::kNew || node_of_convex_[convex] != edited.old.node_of_convex_[was];
  };
  std::vector<std::uint8_t> stays(edited.old.bonds_.size(), 0);
  for (std::size_t i = 0; i < bonds_.size(); ++i) {
    const std::uint32_t was = edited.origin.bonds[i];
    if (was != StressOrigin::kNew) stays[was] = 1;
    if (was != StressOrigin::kNew && !moved(bonds_[i].a) && !moved(bonds_[i].b)) continue;
    mark(bonds_[i].a);
    mark(bonds_[i].b);
  }
  std::vector<std::uint32_t> new_of_old(edited.old.masses_.size(), StressOrigin::kNew);
  for (std::uint32_t c = 0; c < edited.origin.convexes.size(); ++c) {
    const std::uint32_t was = edited.origin.convexes[c];
    if (was != StressOrigin::kNew) new_of_old[was] = c;
  }
  for (std::size_t k = 0; k < stays.size(); ++k) {
    if (stays[k]) continue;
    for (const std::uint32_t end : {edited.old.bonds_[k].a, edited.old.bonds_[k].b}) {
      if (new_of_old[end] != StressOrigin::kNew) mark(new_of_old[end]);
    }
  }
}

SolveResult StressSystem::solve(std::span<const ConvexLoad> loads, const Vec3& gravity_R,
                                double tolerance, int most_iterations,
                                std::vector<Displacement>& displacements, const Vec3& spin_R,
                                Nodal<double>* last_direction) const {
  displacements.resize(masses_.size());
  if (!multigrid_) return {0, 0, 0, true};
  std::vector<Vec3> forces_N, torques_Nm;
  masses_.balance(loads, gravity_R, spin_R, forces_N, torques_Nm);
  const SpringLevel<double>& level = multigrid_->springs();
  Nodal<double> f = level.zero(), x = level.zero();
  // A node is at the centre of its springs, which is not the centroid of its convex.
  for (std::size_t c = 0; c < masses_.size(); ++c) {
    const std::uint32_t node = node_of_convex_[c];
    if (node == Spring::kWorld) continue;
    const Vec3 arm = masses_.centroid(c) - level.place(node);
    f[node] = {simd4<double>(forces_N[c]), simd4<double>(torques_Nm[c] + arm.cross(forces_N[c]))};
    const Displacement& d = displacements[c];
    x[node] = {simd4<double>(d.shift_R - d.rotation_R.cross(arm)), simd4<double>(d.rotation_R)};
  }
  // The forces on islands in free fall cancel up to rounding.
  const double rounding_N = kForceRounding * masses_.applied_N(loads, gravity_R, spin_R);
  Nodal<double> none;
  const SolveResult result = multigrid_->solve(f, tolerance, rounding_N, most_iterations, x,
                                               last_direction ? *last_direction : none);
  for (std::size_t c = 0; c < masses_.size(); ++c) {
    const std::uint32_t node = node_of_convex_[c];
    displacements[c] = {};
    if (node == Spring::kWorld) continue;
    const Vec3 arm = masses_.centroid(c) - level.place(node), rotation = vec3(x[node].angular);
    displacements[c] = {vec3(x[node].linear) + rotation.cross(arm), rotation};
  }
  return result;
}

StressSystem::Field StressSystem::field(std::uint32_t bond,
                                        std::span<const Displacement> displacements) const {
  const ElasticBond& elastic = bonds_[bond];
  const BondGeometry& g = geometry_[bond];
  const Displacement &a = displacements[elastic.a], &b = displacements[elastic.b];
  const Vec3 rotation = elastic.stiffness_Pa_m * (b.rotation_R - a.rotation_R);
  const Vec3 stress = elastic.stiffness_Pa_m *
                      (b.shift_R + b.rotation_R.cross(g.centroid_R - masses_.centroid(elastic.b)) -
                       a.shift_R - a.rotation_R.cross(g.centroid_R - masses_.centroid(elastic.a)));
  Field field;
  field.mean_Pa = g.normal_R.dot(stress);
  field.slope_Pa_m = g.normal_R.cross(rotation);
  field.shear_Pa = stress - field.mean_Pa * g.normal_R;
  field.twist_Pa_m = g.normal_R.dot(rotation);
  return field;
}

double StressSystem::energy_J(std::span<const Displacement> displacements, const Vec3& center_R,
                              double radius_m) const {
  double energy = 0;
  for (std::uint32_t i = 0; i < bonds_.size(); ++i) {
    const BondGeometry& g = geometry_[i];
    if (!has_spring(i) || (g.centroid_R - center_R).norm() > radius_m) continue;
    const Field f = field(i, displacements);
    const double square = g.area_m2 * (f.mean_Pa * f.mean_Pa + f.shear_Pa.squaredNorm()) +
                          f.slope_Pa_m.dot(g.second_moment * f.slope_Pa_m) +
                          f.twist_Pa_m * f.twist_Pa_m * g.second_moment.trace();
    energy += 0.5 * square / bonds_[i].stiffness_Pa_m;
  }
  return energy;
}

Wrench StressSystem::wrench(std::uint32_t bond, std::span<const Displacement> displacements) const {
  const BondGeometry& g = geometry_[bond];
  const Field f = field(bond, displacements);
  const Vec3 rotation = f.twist_Pa_m * g.normal_R + f.slope_Pa_m.cross(g.normal_R);
  return {g.area_m2 * (f.mean_Pa * g.normal_R + f.shear_Pa),
          g.second_moment.trace() * rotation - g.second_moment * rotation};
}

BondStress StressSystem::bound(std::uint32_t bond,
                               std::span<const Displacement> displacements) const {
  const Field f = field(bond, displacements);
  const double reach = geometry_[bond].reach_m;
  const double bending = f.slope_Pa_m.norm() * reach;
  return {std::max(0.0, f.mean_Pa + bending), std::max(0.0, bending - f.mean_Pa),
          f.shear_Pa.norm() + std::abs(f.twist_Pa_m) * reach};
}

/// Returns the bond's field with the linear tension of least ∫ (fit − tension)² dA over its
/// section.
StressSystem::Field StressSystem::section_field(std::uint32_t bond,
                                                std::span<const Displacement> displacements) const {
  Field own = field(bond, displacements);
  const ElasticBond& elastic = bonds_[bond];
  const BondGeometry& g = geometry_[bond];
  const auto [begin, end] =
      std::equal_range(by_plane_.begin(), by_plane_.end(), bond,
                       [&](auto x, auto y) { return bonds_[x].plane < bonds_[y].plane; });
  // Coordinates about the bond's centroid, in an orthonormal basis of the plane.
  const Vec3 u =
      g.normal_R.cross(std::abs(g.normal_R.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitZ()).normalized();
  const Vec3 v = g.normal_R.cross(u);
  Mat3 matrix = Mat3::Zero();
  Vec3 right = Vec3::Zero();
  int bonds = 0;
  for (auto it = begin; it != end; ++it) {
    const BondGeometry& h = geometry_[*it];
    const Vec3 arm = h.centroid_R - g.centroid_R;
    if (bonds_[*it].stiffness_Pa_m <= 0 || arm.norm() > elastic.window_m) continue;
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
  if (bonds_[bond].stiffness_Pa_m <= 0) return worst;
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
