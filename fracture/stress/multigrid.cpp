#include "fracture/stress/multigrid.h"

#include <cmath>
#include <utility>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "fracture/stress/spring_math.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

// Damping of block Jacobi, whose blocks bound the spectrum by 2.
constexpr float kDamping = 2.0f / 3;
constexpr std::size_t kChunk = 1024;

/// Returns the sum over nodes in an order that does not depend on threads.
template <class Term>
double ordered_sum(std::size_t nodes, const Term& term) {
  std::vector<double> partial((nodes + kChunk - 1) / kChunk);
  for_chunks(nodes, kChunk, [&](std::size_t begin, std::size_t end, std::size_t chunk) {
    double sum = 0;
    for (std::size_t i = begin; i < end; ++i) sum += term(i);
    partial[chunk] = sum;
  });
  double sum = 0;
  for (const double part : partial) sum += part;
  return sum;
}

double dot(const Nodal<double>& x, const Nodal<double>& y) {
  return ordered_sum(x.size(), [&](std::size_t i) { return dot(x[i], y[i]); });
}

/// Computes x += factor · y.
template <class Real>
void add(Real factor, const Nodal<Real>& y, Nodal<Real>& x) {
  for_chunks(x.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      x[i].linear += splat<Real>(factor) * y[i].linear;
      x[i].angular += splat<Real>(factor) * y[i].angular;
    }
  });
}

/// Computes x = y + beta · x.
void scale_and_add(double beta, const Nodal<double>& y, Nodal<double>& x) {
  for_chunks(x.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      x[i].linear = y[i].linear + splat<double>(beta) * x[i].linear;
      x[i].angular = y[i].angular + splat<double>(beta) * x[i].angular;
    }
  });
}

/// Computes y = x / unit in single precision; rounding errors become zero (see spring_math.h).
void to_float(const Nodal<double>& x, double unit, Nodal<float>& y) {
  constexpr double kLeast = 1e-15;
  const auto one = [&](Simd4<double> part) {
    part *= splat<double>(1 / unit);
    const auto keep = (part > splat<double>(kLeast)) | (part < splat<double>(-kLeast));
    return __builtin_convertvector(keep ? part : Simd4<double>{}, Simd4<float>);
  };
  for_chunks(x.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) y[i] = {one(x[i].linear), one(x[i].angular)};
  });
}

/// Computes y = unit · x.
void to_double(const Nodal<float>& x, double unit, Nodal<double>& y) {
  const auto one = [&](Simd4<float> part) {
    return splat<double>(unit) * __builtin_convertvector(part, Simd4<double>);
  };
  for_chunks(x.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) y[i] = {one(x[i].linear), one(x[i].angular)};
  });
}

/// Returns the block that a spring adds to the diagonal of the stiffness matrix for a node at `at`
/// = `by`, or subtracts between two nodes there: (force, torque) by (shift, rotation).
Eigen::Matrix<double, 6, 6> stiffness(const Spring& spring, const Vec3& at, const Vec3& by) {
  Eigen::Matrix<double, 6, 6> block;
  const Mat3 arm = cross_matrix(spring.place - at), other = cross_matrix(spring.place - by);
  block << Mat3::Identity(), -other, arm, -arm * other;
  block *= spring.stretch_N_m;
  block.bottomRightCorner<3, 3>() += spring.rotation_Nm;
  return block;
}

/// Returns the mean stiffness of springs; 1 if there are none.
double mean_stretch_N_m(std::span<const Spring> springs) {
  if (springs.empty()) return 1;
  double sum = 0;
  for (const Spring& spring : springs) sum += spring.stretch_N_m;
  return sum / static_cast<double>(springs.size());
}

}  // namespace

Multigrid::Multigrid(std::size_t nodes, std::vector<Spring> springs)
    : springs_(nodes, springs), unit_N_m_(mean_stretch_N_m(springs)) {
  to_units(springs);
  levels_.emplace_back(nodes, std::move(springs));
  while (!factorize(false)) {
    SpringGroups groups(levels_.back(), kNodesPerGroup);
    SUNDER_CHECK(groups.count() < levels_.back().size());
    levels_.push_back(groups.coarsen(levels_.back()));
    groups_.push_back(std::move(groups));
  }
}

Multigrid::Multigrid(const Multigrid& old, SpringEdit edit)
    : springs_(old.springs_, edit), unit_N_m_(old.unit_N_m_), groups_(old.groups_) {
  to_units(edit.springs);
  levels_.emplace_back(old.levels_[0], edit);
  for (std::size_t level = 0; level < groups_.size(); ++level) {
    levels_.push_back(groups_[level].coarsen(levels_[level], old.levels_[level + 1], edit));
  }
  factorize(true);
}

const char* Multigrid::wrong_field() const {
  if (!(unit_N_m_ > 0)) return "unit_N_m_";
  if (levels_.empty() || levels_[0].size() != springs_.size()) return "levels_";
  if (groups_.size() + 1 != levels_.size()) return "groups_";
  for (std::size_t level = 0; level < groups_.size(); ++level) {
    if (groups_[level].nodes() != levels_[level].size() ||
        groups_[level].count() != levels_[level + 1].size())
      return "groups_";
    // Each level is coarser; a cycle visits the next twice.
    if (levels_[level + 1].size() >= levels_[level].size()) return "levels_";
  }
  return coarsest_.nodes() == levels_.back().size() ? nullptr : "coarsest_";
}

void Multigrid::to_units(std::vector<Spring>& springs) const {
  for (Spring& spring : springs) {
    spring.stretch_N_m /= unit_N_m_;
    spring.rotation_Nm /= unit_N_m_;
  }
}

/// Factorizes the coarsest level; returns false if a coarser one is needed, unless `keep_level`.
bool Multigrid::factorize(bool keep_level) {
  // In double precision: the stiffness to the world may be tiny beside that between nodes.
  const SpringLevel<float>& last = levels_.back();
  std::vector<BlockCholesky::Pair> pairs;
  last.for_each_spring([&](const Spring& spring) {
    if (spring.a != Spring::kWorld && spring.b != Spring::kWorld)
      pairs.emplace_back(spring.a, spring.b);
  });
  if (pairs.empty()) keep_level = true;  // Each node is on its own.
  if (!keep_level && last.size() > kMaxDirectNodes) return false;
  BlockCholesky matrix(last.size(), pairs);
  if (!keep_level && matrix.products() > kMaxDirectIterations * pairs.size()) return false;
  using Row = Eigen::Matrix<double, 6, 1>;
  std::vector<Row> diagonal(last.size(), Row::Zero());
  last.for_each_spring([&](const Spring& spring) {
    for (const std::uint32_t end : {spring.a, spring.b}) {
      if (end == Spring::kWorld) continue;
      const BlockCholesky::Block own = stiffness(spring, last.place(end), last.place(end));
      matrix.add(end, end, own);
      diagonal[end] += own.diagonal();
    }
    if (spring.a != Spring::kWorld && spring.b != Spring::kWorld)
      matrix.add(spring.a, spring.b,
                 -stiffness(spring, last.place(spring.a), last.place(spring.b)));
  });
  double most = 0;
  for (const Row& row : diagonal) most = std::max(most, row.maxCoeff());
  if (!(most > 0)) most = 1;                             // No node can move.
  for (std::uint32_t i = 0; i < diagonal.size(); ++i) {  // An edit may have emptied groups.
    const Row missing = (diagonal[i].array() == 0).select(most, Row::Zero());
    if (!missing.isZero(0)) matrix.add(i, i, missing.asDiagonal());
  }
  // A nearly singular matrix gets the least diagonal shift that makes it positive definite.
  for (double diagonal_shift = 1e-13; diagonal_shift < 1; diagonal_shift *= 100) {
    coarsest_ = matrix;
    if (coarsest_.factorize()) return true;
    for (std::uint32_t i = 0; i < diagonal.size(); ++i)
      matrix.add(i, i, diagonal_shift * most * BlockCholesky::Block::Identity());
  }
  SUNDER_CHECK(false);
  return false;
}

void Multigrid::solve_coarsest(const Nodal<float>& r, Nodal<float>& z) const {
  Nodal<double> x(coarsest_.nodes());
  for (std::size_t i = 0; i < x.size(); ++i) {
    x[i] = {__builtin_convertvector(r[i].linear, Simd4<double>),
            __builtin_convertvector(r[i].angular, Simd4<double>)};
  }
  coarsest_.solve(x);
  z.resize(x.size() + 1);
  for (std::size_t i = 0; i < x.size(); ++i) {
    z[i] = {__builtin_convertvector(x[i].linear, Simd4<float>),
            __builtin_convertvector(x[i].angular, Simd4<float>)};
  }
}

void Multigrid::cycle(std::size_t level, const Nodal<float>& r, Nodal<float>& z,
                      std::span<Scratch> scratch) const {
  if (level + 1 == levels_.size()) return solve_coarsest(r, z);
  const SpringLevel<float>& here = levels_[level];
  Scratch& s = scratch[level];
  here.relax(kDamping, r, z, false);
  here.residual(r, z, s.rest);
  groups_[level].restrict_to(s.rest, s.coarse_r);
  cycle(level + 1, s.coarse_r, s.coarse_z, scratch);
  if (level + 2 < levels_.size()) {  // A second cycle makes it a W-cycle.
    levels_[level + 1].residual(s.coarse_r, s.coarse_z, s.coarse_rest);
    cycle(level + 1, s.coarse_rest, s.correction, scratch);
    add(1.0f, s.correction, s.coarse_z);
  }
  groups_[level].prolong(kOvercorrection, s.coarse_z, z);
  here.residual(r, z, s.rest);
  here.relax(kDamping, s.rest, z, true);
}

std::vector<Multigrid::Scratch> Multigrid::scratch() const {
  std::vector<Scratch> scratch(levels_.size());
  for (std::size_t level = 0; level + 1 < levels_.size(); ++level) {
    const Nodal<float> coarse = levels_[level + 1].zero();
    scratch[level] = {levels_[level].zero(), coarse, coarse, coarse, coarse};
  }
  return scratch;
}

SolveResult Multigrid::solve(const Nodal<double>& f, double tolerance, double rounding_N,
                             int most_iterations, Nodal<double>& x,
                             Nodal<double>& last_direction) const {
  std::vector<Scratch> memory = scratch();
  Nodal<double> r = springs_.zero(), z = r, p = std::exchange(last_direction, {}), product = r;
  springs_.residual(f, x, r);
  // The guess has more energy, xᵀKx / 2 − fᵀx, than no displacement has.
  if (!(dot(x, f) + dot(x, r) >= 0)) {
    x = springs_.zero();
    r = f;
    p.clear();
  }
  const bool goes_on = !p.empty();
  p.resize(r.size());
  if (goes_on) springs_.multiply(p, product);
  Nodal<float> r_f = levels_.front().zero(), z_f = r_f;
  SolveResult result;
  const double force = std::sqrt(dot(f, f));
  double rz = 0;
  for (;; ++result.iterations) {
    const double left = std::sqrt(dot(r, r));
    result.residual = force > 0 ? left / force : 0;
    if (left <= rounding_N) {
      result.converged = true;
      break;
    }
    to_float(r, left, r_f);
    cycle(0, r_f, z_f, memory);
    to_double(z_f, left / unit_N_m_, z);
    const double rz_new = dot(r, z), energy = dot(x, f);
    result.error = energy > 0 ? std::sqrt(std::max(0.0, rz_new) / energy) : 1;
    result.converged = result.residual <= tolerance && result.error <= tolerance;
    if (result.converged || result.iterations >= most_iterations) break;
    // A new direction is conjugate to the last one.
    double beta = result.iterations > 0 ? rz_new / rz : 0;
    if (result.iterations == 0 && goes_on) beta = -dot(z, product) / dot(p, product);
    scale_and_add(beta, z, p);
    rz = rz_new;
    springs_.multiply(p, product);
    const double curvature = dot(p, product);
    if (!(curvature > 0)) break;  // Only rounding errors are left.
    const double alpha = rz / curvature;
    add(alpha, p, x);
    add(-alpha, product, r);
  }
  if (!result.converged && result.iterations == most_iterations) last_direction = std::move(p);
  return result;
}

}  // namespace sunder::fracture
