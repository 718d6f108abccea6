#include "fracture/stress/section.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>
#include <utility>

#include <Eigen/Eigenvalues>

#include "engine/base/roots.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

constexpr double kCos60 = 0.5, kCos30 = 0.866, kCosParallel = 1 - 1e-9;
// Minimum of projected area over the sum of areas. Below it the bonds fold back on themselves and
// form no section.
constexpr double kMinProjectedShare = 1e-6;
constexpr int kHalvings = 80;

/// Yield force of one bond, spread evenly over an interval of a direction in the section.
struct Strip {
  double force_N, center_m, half_width_m;

  /// Returns the share of the strip below a position.
  double below(double m) const {
    if (!(half_width_m > 0)) return center_m < m ? 1 : 0;
    return std::clamp((m - center_m + half_width_m) / (2 * half_width_m), 0.0, 1.0);
  }
  /// Returns the mean distance of the strip's points from a position.
  double distance(double m) const {
    const double middle = std::abs(center_m - m);
    return middle >= half_width_m
               ? middle
               : (middle * middle + half_width_m * half_width_m) / (2 * half_width_m);
  }
};

/// Returns the plastic moment of strips: those on one side of the neutral axis pull, those on the
/// other push, and the axis is where both forces are equal.
double bending_Nm(std::span<const Strip> strips) {
  double low = 1e300, high = -1e300, force = 0;
  for (const Strip& strip : strips) {
    low = std::min(low, strip.center_m - strip.half_width_m);
    high = std::max(high, strip.center_m + strip.half_width_m);
    force += strip.force_N;
  }
  for (int i = 0; i < kHalvings; ++i) {
    const double middle = 0.5 * (low + high);
    double below = 0;
    for (const Strip& strip : strips) below += strip.force_N * strip.below(middle);
    (below < 0.5 * force ? low : high) = middle;
  }
  double moment = 0;
  for (const Strip& strip : strips) moment += strip.force_N * strip.distance(0.5 * (low + high));
  return moment;
}

/// Returns the unit axis, away from `face`, of a convex that is a prism on that face; none if it is
/// no prism.
std::optional<Vec3> prism_axis(const ConvexPolyhedron& convex, std::uint32_t face) {
  const auto end = convex.face_corners(face);
  const auto in_face = [&](std::uint32_t v) { return std::ranges::find(end, v) != end.end(); };
  Vec3 sum = Vec3::Zero();
  double edges = 0;
  for (std::size_t f = 0; f < convex.faces.size(); ++f) {
    const auto corners = convex.face_corners(f);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      const std::uint32_t from = corners[i], to = corners[i + 1 < corners.size() ? i + 1 : 0];
      if (!in_face(from) || in_face(to)) continue;
      sum += (convex.vertices[to] - convex.vertices[from]).normalized();
      ++edges;
    }
  }
  if (!(sum.norm() > kMinPrismParallelism * edges)) return std::nullopt;
  return sum.normalized();
}

Vec3 any_perpendicular(const Vec3& axis) {
  return axis.cross(std::abs(axis.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitZ()).normalized();
}

}  // namespace

Sections::Sections(const Compound& compound, const StressSystem& system,
                   std::span<const Displacement> displacements, std::span<const Material> materials)
    : compound_(compound), system_(system), displacements_(displacements), materials_(materials) {}

double Sections::yield_Pa(std::uint32_t bond) const {
  const auto of = [&](std::uint32_t convex) -> const Material& {
    return materials_[compound_.convexes[convex]->material.value];
  };
  return sunder::yield_Pa(of(compound_.bonds[bond].a), of(compound_.bonds[bond].b));
}

/// Called before the first search, as most structures never have one.
void Sections::index_bonds() {
  first_.assign(compound_.convexes.size() + 1, 0);
  for (const Bond& bond : compound_.bonds) ++first_[bond.a], ++first_[bond.b];
  std::uint32_t sum = 0;
  for (std::uint32_t& first : first_) sum += first, first = sum;
  bonds_.resize(sum);
  for (auto i = static_cast<std::uint32_t>(compound_.bonds.size()); i-- > 0;) {
    bonds_[--first_[compound_.bonds[i].a]] = i;
    bonds_[--first_[compound_.bonds[i].b]] = i;
  }
  for (const Ghost& ghost : compound_.ghosts) {
    for (const std::uint32_t c : ghost.of) {
      for (const std::uint32_t other : ghost.of)
        if (other != c) overlaps_.emplace_back(c, other);
    }
  }
  std::ranges::sort(overlaps_);
  seen_bond_.assign(compound_.bonds.size(), 0);
  seen_convex_.assign(compound_.convexes.size(), 0);
}

std::span<const std::uint32_t> Sections::bonds_of(std::uint32_t convex) const {
  return std::span(bonds_).subspan(first_[convex], first_[convex + 1] - first_[convex]);
}

const Vec3& Sections::centroid(std::uint32_t convex) const {
  return compound_.convexes[convex]->solid.centroid;
}

std::uint32_t Sections::other_convex(std::uint32_t bond, std::uint32_t convex) const {
  return compound_.bonds[bond].a ^ compound_.bonds[bond].b ^ convex;
}

/// Returns true if a bond is under compression: it transmits force even without strength.
bool Sections::is_compressed(std::uint32_t bond) const {
  return system_.geometry()[bond].normal_R.dot(system_.wrench(bond, displacements_).force_N) < 0;
}

/// Returns the bonds that cross the plane, found from bond to bond: those of a visited convex, and
/// those of convexes on the same side that are bonded to it or overlap it. Other members that the
/// plane crosses are not reached.
std::vector<Crossing> Sections::find_crossings(std::uint32_t bond, const Vec3& normal_R) {
  const Vec3& point_R = system_.geometry()[bond].centroid_R;
  const auto ahead = [&](std::uint32_t c) { return normal_R.dot(centroid(c) - point_R) > 0; };
  if (ahead(compound_.bonds[bond].a) == ahead(compound_.bonds[bond].b)) return {};
  std::vector<Crossing> crossings;
  bool all_give_way = true;
  const auto add = [&](std::uint32_t i) {
    if (seen_bond_[i] == search_) return;
    seen_bond_[i] = search_;
    all_give_way &= yield_Pa(i) > 0 || is_compressed(i);
    crossings.push_back({i, ahead(compound_.bonds[i].b)});
  };
  const auto add_those_of = [&](std::uint32_t convex) {
    if (seen_convex_[convex] == search_) return;
    seen_convex_[convex] = search_;
    work_ += bonds_of(convex).size();
    for (const std::uint32_t i : bonds_of(convex))
      if (ahead(other_convex(i, convex)) != ahead(convex)) add(i);
  };
  ++search_;
  add(bond);
  for (std::size_t k = 0; k < crossings.size(); ++k) {
    if (!all_give_way || crossings.size() > kMaxSectionBonds) return {};
    const Bond& crossing = compound_.bonds[crossings[k].bond];
    for (const std::uint32_t convex : {crossing.a, crossing.b}) {
      add_those_of(convex);
      for (const std::uint32_t i : bonds_of(convex)) {
        const std::uint32_t beside = other_convex(i, convex);
        if (ahead(beside) == ahead(convex)) add_those_of(beside);
      }
      for (auto at = std::ranges::lower_bound(overlaps_, std::pair(convex, 0u));
           at != overlaps_.end() && at->first == convex; ++at)
        if (ahead(at->second) == ahead(convex)) add_those_of(at->second);
    }
  }
  std::ranges::sort(crossings, {}, &Crossing::bond);
  return crossings;
}

/// Returns the sum of the vector areas of bonds: for a closed outline in a plane, the area in the
/// plane times its normal. Sets `area_m2` to the sum of the areas.
Vec3 Sections::vector_area(std::span<const Crossing> crossings, double& area_m2) const {
  Vec3 sum = Vec3::Zero();
  area_m2 = 0;
  for (const Crossing& crossing : crossings) {
    const BondGeometry& g = system_.geometry()[crossing.bond];
    sum += (crossing.forward ? g.area_m2 : -g.area_m2) * g.normal_R;
    area_m2 += g.area_m2;
  }
  return sum;
}

/// Returns the principal axes of connected centroids within four, three and two cells of a bond.
std::vector<Vec3> Sections::axes_around(std::uint32_t bond) {
  const Bond& own = compound_.bonds[bond];
  const Vec3& point_R = system_.geometry()[bond].centroid_R;
  double cell_m = 0;
  for (const std::uint32_t c : {own.a, own.b})
    cell_m = std::max(cell_m, cube_root(compound_.convexes[c]->solid.volume_m3));
  std::vector<std::uint32_t> near = {own.a, own.b};
  ++search_;
  for (const std::uint32_t c : near) seen_convex_[c] = search_;
  for (std::size_t k = 0; k < near.size(); ++k) {
    work_ += bonds_of(near[k]).size();
    for (const std::uint32_t i : bonds_of(near[k])) {
      const std::uint32_t c = other_convex(i, near[k]);
      if (seen_convex_[c] == search_ || (centroid(c) - point_R).norm() > 4 * cell_m) continue;
      seen_convex_[c] = search_;
      near.push_back(c);
    }
  }
  std::vector<Vec3> axes;
  for (const double cells : {4.0, 3.0, 2.0}) {
    Vec3 sum = Vec3::Zero();
    Mat3 squares = Mat3::Zero();
    double count = 0;
    for (const std::uint32_t c : near) {
      const Vec3 arm = centroid(c) - point_R;
      if (arm.norm() > cells * cell_m) continue;
      sum += arm;
      squares += arm * arm.transpose();
      ++count;
    }
    if (count < 5) continue;
    const Eigen::SelfAdjointEigenSolver<Mat3> solver(squares - sum * sum.transpose() / count);
    for (int k = 0; k < 3; ++k) axes.emplace_back(solver.eigenvectors().col(k));
  }
  return axes;
}

/// Returns the plastic strength of crossings whose areas, projected along `normal_R`, are
/// `areas_m2`, in bending about `bending_R` and across it.
SectionStrength Sections::strength(std::span<const Crossing> crossings,
                                   std::span<const double> areas_m2, const Vec3& normal_R,
                                   const Vec3& bending_R) const {
  SectionStrength strength;
  strength.axes_R << normal_R, bending_R, normal_R.cross(bending_R);
  std::vector<Strip> strips(crossings.size());
  for (int axis = 1; axis <= 2; ++axis) {
    const Vec3 along = strength.axes_R.col(3 - axis);
    strength.axial_N = 0;
    for (std::size_t i = 0; i < crossings.size(); ++i) {
      const BondGeometry& g = system_.geometry()[crossings[i].bond];
      const double square_m4 = std::max(0.0, along.dot(g.second_moment * along));
      strips[i] = {areas_m2[i] * yield_Pa(crossings[i].bond), along.dot(g.centroid_R),
                   g.area_m2 > 0 ? std::sqrt(3 * square_m4 / g.area_m2) : 0};
      strength.axial_N += strips[i].force_N;
    }
    strength.moment_Nm[axis] = bending_Nm(strips);
  }
  strength.shear_N = strength.axial_N * std::numbers::inv_sqrt3;  // von Mises
  // Torsion of a rectangle by the sand heap analogy (Nadai 1923), from its moments in bending.
  const double weak = std::min(strength.moment_Nm[1], strength.moment_Nm[2]);
  const double strong = std::max(strength.moment_Nm[1], strength.moment_Nm[2]);
  strength.moment_Nm[0] = std::numbers::inv_sqrt3 * weak * (2 - 2.0 / 3 * weak / strong);
  return strength;
}

Section Sections::make_section(std::vector<Crossing> crossings, const Vec3& normal_R) const {
  Section section;
  std::erase_if(crossings, [&](const Crossing& crossing) {
    const bool yields = yield_Pa(crossing.bond) > 0;
    if (!yields) section.compressed.push_back(crossing.bond);
    return !yields;
  });
  double all_m2 = 0;
  std::vector<double> areas_m2;
  for (const Crossing& crossing : crossings) {
    const BondGeometry& g = system_.geometry()[crossing.bond];
    areas_m2.push_back((crossing.forward ? g.area_m2 : -g.area_m2) * normal_R.dot(g.normal_R));
    section.area_m2 += areas_m2.back();
    section.centroid_R += areas_m2.back() * g.centroid_R;
    all_m2 += g.area_m2;
  }
  if (!(section.area_m2 > kMinProjectedShare * all_m2)) return {};
  section.centroid_R /= section.area_m2;
  Wrench& wrench = section.wrench_R;
  for (const Crossing& crossing : crossings) {
    const Wrench part = system_.wrench(crossing.bond, displacements_);
    const Vec3 arm = system_.geometry()[crossing.bond].centroid_R - section.centroid_R;
    const double sign = crossing.forward ? 1 : -1;
    wrench.force_N += sign * part.force_N;
    wrench.moment_Nm += sign * (part.moment_Nm + arm.cross(part.force_N));
  }
  const Vec3 bending = wrench.moment_Nm - normal_R * normal_R.dot(wrench.moment_Nm);
  section.strength =
      strength(crossings, areas_m2, normal_R,
               bending.norm() > 0 ? Vec3(bending.normalized()) : any_perpendicular(normal_R));
  if (!(section.strength.moment_Nm.minCoeff() > 0)) return {};
  section.utilisation = utilisation(section.strength, wrench);
  section.crossings = std::move(crossings);
  return section;
}

Section Sections::at(std::uint32_t bond) {
  if (first_.empty()) index_bonds();
  const BondGeometry& g = system_.geometry()[bond];
  if (!(g.area_m2 > 0)) return {};
  std::vector<Crossing> crossings = find_crossings(bond, g.normal_R);
  Section best = make_section(crossings, g.normal_R);
  if (best.crossings.empty()) return best;
  double area_m2 = 0;
  if (vector_area(crossings, area_m2).norm() > kMinSectionPlanarity * area_m2) {
    const Bond& own = compound_.bonds[bond];
    for (const auto& [convex, face] : {std::pair(own.a, own.face_a), {own.b, own.face_b}}) {
      const auto axis = prism_axis(compound_.convexes[convex]->polyhedron, face);
      const double cosine = axis ? std::abs(axis->dot(g.normal_R)) : 0;
      if (cosine < kCos60 || cosine > kCosParallel) continue;
      Section section = make_section(crossings, convex == own.a ? Vec3(-*axis) : *axis);
      if (!section.crossings.empty() && section.area_m2 < best.area_m2) best = std::move(section);
    }
    return best;
  }
  double least_m2 = std::numeric_limits<double>::infinity();
  for (const Vec3& axis : axes_around(bond)) {
    const Vec3 ahead = axis.dot(g.normal_R) < 0 ? Vec3(-axis) : axis;
    if (ahead.dot(g.normal_R) < kCos60) continue;
    crossings = find_crossings(bond, ahead);
    const Vec3 sum = vector_area(crossings, area_m2);
    if (!(ahead.dot(sum) > kCos30 * sum.norm()) || sum.norm() >= least_m2) continue;
    Section section = make_section(std::move(crossings), ahead);
    if (section.crossings.empty()) continue;
    least_m2 = sum.norm();
    best = std::move(section);
  }
  return best;
}

}  // namespace sunder::fracture
