#include "fracture/multigrid.h"

#include <cmath>

#include "engine/base/check.h"
#include "engine/base/parallel.h"

namespace sunder::fracture {
namespace {

constexpr std::size_t kGroup = 8;  // nodes that move as one on the next coarser level
// Groups that move rigidly are too stiff: their correction is lengthened by this much.
constexpr double kOvercorrection = 1.4;
constexpr std::size_t kDenseNodes = 48;  // few enough for a dense factorization
constexpr double kDamping = 2.0 / 3;     // of block Jacobi; the blocks bound the spectrum by 2
constexpr std::size_t kChunk = 1024;

/// Sum over nodes in an order that threads do not change.
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

double dot(const Nodal& x, const Nodal& y) {
  return ordered_sum(x.size(), [&](std::size_t i) { return dot(x[i], y[i]); });
}

}  // namespace

Multigrid::Multigrid(std::size_t nodes, std::vector<Spring> springs) {
  levels_.emplace_back(nodes, std::move(springs));
  factorize();
}

void Multigrid::factorize() {
  while (levels_.back().size() > kDenseNodes) {
    SpringLevel coarse = levels_.back().coarsen(kGroup);
    if (coarse.size() == levels_.back().size()) break;  // no two hang together
    levels_.push_back(std::move(coarse));
  }
  const SpringLevel& last = levels_.back();
  const auto rows = static_cast<Eigen::Index>(6 * last.size());
  Eigen::MatrixXd matrix(rows, rows);
  Nodal unit = last.zero(), column;
  for (std::size_t j = 0; j < last.size(); ++j) {
    for (int k = 0; k < 6; ++k) {
      Quad& part = k < 3 ? unit[j].linear : unit[j].angular;
      part[k % 3] = 1;
      last.multiply(unit, column);
      part[k % 3] = 0;
      for (std::size_t i = 0; i < last.size(); ++i) {
        const auto at = static_cast<Eigen::Index>(6 * i), across = static_cast<Eigen::Index>(6 * j);
        matrix.block<3, 1>(at, across + k) = vec3(column[i].linear);
        matrix.block<3, 1>(at + 3, across + k) = vec3(column[i].angular);
      }
    }
  }
  coarsest_.compute(matrix);
  SUNDER_CHECK(coarsest_.info() == Eigen::Success);
}

void Multigrid::solve_coarsest(const Nodal& r, Nodal& z) const {
  const std::size_t nodes = levels_.back().size();
  Eigen::VectorXd flat(static_cast<Eigen::Index>(6 * nodes));
  for (std::size_t i = 0; i < nodes; ++i) {
    flat.segment<3>(static_cast<Eigen::Index>(6 * i)) = vec3(r[i].linear);
    flat.segment<3>(static_cast<Eigen::Index>(6 * i + 3)) = vec3(r[i].angular);
  }
  coarsest_.solveInPlace(flat);
  z.resize(nodes + 1);
  for (std::size_t i = 0; i < nodes; ++i) {
    z[i].linear = quad(flat.segment<3>(static_cast<Eigen::Index>(6 * i)));
    z[i].angular = quad(flat.segment<3>(static_cast<Eigen::Index>(6 * i + 3)));
  }
}

void Multigrid::cycle(std::size_t level, const Nodal& r, Nodal& z,
                      std::span<Scratch> scratch) const {
  if (level + 1 == levels_.size()) return solve_coarsest(r, z);
  const SpringLevel& here = levels_[level];
  const SpringLevel& coarse = levels_[level + 1];
  Scratch& s = scratch[level];
  here.relax(kDamping, r, z, false);
  here.residual(r, z, s.rest);
  here.restrict_to(coarse, s.rest, s.coarse_r);
  cycle(level + 1, s.coarse_r, s.coarse_z, scratch);
  if (level + 2 < levels_.size()) {  // once more, for what is left
    coarse.residual(s.coarse_r, s.coarse_z, s.rest);
    cycle(level + 1, s.rest, s.correction, scratch);
    for (std::size_t i = 0; i < coarse.size(); ++i) {
      s.coarse_z[i].linear += s.correction[i].linear;
      s.coarse_z[i].angular += s.correction[i].angular;
    }
  }
  here.prolong_from(coarse, kOvercorrection, s.coarse_z, z);
  here.residual(r, z, s.rest);
  here.relax(kDamping, s.rest, z, true);
}

SolveResult Multigrid::solve(const Nodal& f, double tolerance, int most_iterations,
                             Nodal& x) const {
  const SpringLevel& fine = finest();
  const std::size_t nodes = fine.size();
  std::vector<Scratch> scratch(levels_.size());
  Nodal r, z = fine.zero(), p = fine.zero(), product = fine.zero();
  fine.residual(f, x, r);
  r.back() = Six{};
  SolveResult result;
  const double force = std::sqrt(dot(f, f));
  double rz = 0;
  for (;; ++result.iterations) {
    const double left = std::sqrt(dot(r, r));
    result.residual = force > 0 ? left / force : 0;
    if (left == 0) result.converged = true;
    if (result.converged) break;
    cycle(0, r, z, scratch);
    const double rz_new = dot(r, z), energy = dot(x, f);
    result.error = energy > 0 ? std::sqrt(std::max(0.0, rz_new) / energy) : 1;
    result.converged = result.residual <= tolerance && result.error <= tolerance;
    if (result.converged || result.iterations >= most_iterations) break;
    const double keep = result.iterations > 0 ? rz_new / rz : 0;
    rz = rz_new;
    for (std::size_t i = 0; i < nodes; ++i) {
      p[i].linear = z[i].linear + splat(keep) * p[i].linear;
      p[i].angular = z[i].angular + splat(keep) * p[i].angular;
    }
    fine.multiply(p, product);
    const double curvature = dot(p, product);
    if (!(curvature > 0)) break;  // nothing but rounding is left
    const double step = rz / curvature;
    for (std::size_t i = 0; i < nodes; ++i) {
      x[i].linear += splat(step) * p[i].linear;
      x[i].angular += splat(step) * p[i].angular;
      r[i].linear -= splat(step) * product[i].linear;
      r[i].angular -= splat(step) * product[i].angular;
    }
  }
  return result;
}

}  // namespace sunder::fracture
