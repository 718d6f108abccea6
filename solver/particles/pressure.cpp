// Read first: solve(), then cycle(). Every kernel runs along rows of cells, which the compiler
// vectorises; sums are kept per layer and lane, so that they do not depend on the threads.
#include "solver/particles/pressure.h"

#include <algorithm>

#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "engine/base/state_checks.h"
#include "solver/particles/tuning.h"

namespace sunder::solver {
namespace {

constexpr int kSumLanes = 8;

/// Calls work(j, k) for every row of cells of each layer, layers in parallel.
template <class Work>
void for_rows(const Lattice& lattice, const Work& work) {
  for_chunks(static_cast<std::size_t>(lattice.counts.z()), lattice.layers_a_chunk(),
             [&](std::size_t begin, std::size_t end, std::size_t) {
               for (std::size_t k = begin; k < end; ++k) {
                 for (int j = 1; j <= lattice.counts.y(); ++j) work(j, static_cast<int>(k) + 1);
               }
             });
}

/// A row of the linear system: pointers to the coefficients of its first cell, and strides.
struct Row {
  const float *ax, *ay, *az;
  std::ptrdiff_t sy, sz;

  /// Return Σ a · neighbour at cell i: over the four neighbours in other rows, over all six.
  float across(const float* x, int i) const {
    return ay[i] * x[i - sy] + ay[i + sy] * x[i + sy] +
           (az[i] * x[i - sz] + az[i + sz] * x[i + sz]);
  }
  float neighbours(const float* x, int i) const {
    return ax[i] * x[i - 1] + ax[i + 1] * x[i + 1] + across(x, i);
  }
  float diagonal(int i) const {
    return ax[i] + ax[i + 1] + ay[i] + ay[i + sy] + az[i] + az[i + sz];
  }
};

Row row_of(const Lattice& lattice, const std::array<Field, 3>& a, std::size_t at) {
  return {&a[0][at], &a[1][at], &a[2][at], lattice.stride(1), lattice.stride(2)};
}

/// Returns the sum of work(first index of a row) over all rows, added layer by layer in order.
template <class Work>
double sum_rows(const Lattice& lattice, std::vector<double>& partial, const Work& work) {
  std::fill(partial.begin(), partial.end(), 0.0);
  for_rows(lattice, [&](int j, int k) {
    partial[static_cast<std::size_t>(k) - 1] += work(lattice.index(1, j, k));
  });
  double sum = 0;
  for (const double part : partial) sum += part;
  return sum;
}

/// Returns the dot product of two rows, summed by lanes.
double dot_row(const float* x, const float* y, int count) {
  float lanes[kSumLanes] = {};
  for (int i = 0; i < count; i += kSumLanes) {
    for (int l = 0; l < kSumLanes; ++l) lanes[l] += x[i + l] * y[i + l];
  }
  double sum = 0;
  for (const float lane : lanes) sum += double{lane};
  return sum;
}

}  // namespace

PressureSolver::PressureSolver(const Vec3i& counts) {
  for (Vec3i size = counts; size.minCoeff() >= 4; size /= 2) {
    SUNDER_CHECK(size.x() % kSumLanes == 0 && size.x() <= kLongestRow);
    Level& level = levels_.emplace_back();
    level.lattice = {size};
    const std::size_t cells = level.lattice.size();
    for (Field& a : level.a) a.assign(cells, 0);
    for (Field* field : {&level.inverse_diagonal, &level.residual, &level.correction}) {
      field->assign(cells, 0);
    }
    if (size.x() % (2 * kSumLanes) != 0 || size.y() % 2 != 0 || size.z() % 2 != 0) break;
  }
  SUNDER_CHECK(!levels_.empty());
  for (Field* field : {&pressure_, &direction_, &matrix_direction_}) {
    field->assign(levels_[0].lattice.size(), 0);
  }
  partial_.resize(static_cast<std::size_t>(counts.z()));
}

const char* PressureSolver::wrong_field() const {
  // The levels are those that a solver for as many cells is made with.
  if (levels_.empty()) return "levels_";
  const Vec3i counts = levels_[0].lattice.counts;
  if (counts.minCoeff() < 4 || counts.x() % kSumLanes != 0 || counts.x() > kLongestRow ||
      levels_[0].residual.size() != levels_[0].lattice.size())
    return "levels_";
  const PressureSolver same(counts);
  if (levels_.size() != same.levels_.size()) return "levels_";
  for (std::size_t i = 0; i < levels_.size(); ++i) {
    const Level& level = levels_[i];
    if (level.lattice.counts != same.levels_[i].lattice.counts ||
        !have_size(level.lattice.size(), level.a[0], level.a[1], level.a[2], level.inverse_diagonal,
                   level.residual, level.correction))
      return "levels_";
  }
  if (!have_size(levels_[0].lattice.size(), pressure_, direction_, matrix_direction_))
    return "pressure_";
  return partial_.size() == same.partial_.size() ? nullptr : "partial_";
}

void PressureSolver::find_diagonal(Level& level) {
  for_rows(level.lattice, [&](int j, int k) {
    const std::size_t at = level.lattice.index(1, j, k);
    const Row row = row_of(level.lattice, level.a, at);
    float* inverse = &level.inverse_diagonal[at];
    for (int i = 0; i < level.lattice.counts.x(); ++i) {
      const float diagonal = row.diagonal(i);
      inverse[i] = diagonal > 0 ? 1 / diagonal : 0;
    }
  });
}

/// Computes the coarse coefficients: half the sum of the four fine faces of each coarse face,
/// because the distance between cells is twice as large.
void PressureSolver::coarsen(const Level& fine, Level& coarse) {
  const Vec3i& counts = coarse.lattice.counts;
  for (int axis = 0; axis < 3; ++axis) {
    const std::ptrdiff_t side = fine.lattice.stride((axis + 1) % 3);
    const std::ptrdiff_t up = fine.lattice.stride((axis + 2) % 3);
    const Vec3i last = counts + Vec3i::Unit(axis);
    for (int k = 1; k <= last.z(); ++k) {
      for (int j = 1; j <= last.y(); ++j) {
        for (int i = 1; i <= last.x(); ++i) {
          const float* a = &fine.a[static_cast<std::size_t>(axis)]
                                  [fine.lattice.index(2 * i - 1, 2 * j - 1, 2 * k - 1)];
          coarse.a[static_cast<std::size_t>(axis)][coarse.lattice.index(i, j, k)] =
              0.5f * (a[0] + a[side] + a[up] + a[side + up]);
        }
      }
    }
  }
}

/// Smooths rows of one colour of the checkerboard (j + k): Gauss-Seidel, Jacobi along a row.
void PressureSolver::smooth_rows(Level& level, int color) {
  for_rows(level.lattice, [&](int j, int k) {
    if (((j + k) & 1) != color) return;
    const std::size_t at = level.lattice.index(1, j, k);
    const Row row = row_of(level.lattice, level.a, at);
    const float* residual = &level.residual[at];
    const float* inverse = &level.inverse_diagonal[at];
    float* x = &level.correction[at];
    const int count = level.lattice.counts.x();
    float changed[kLongestRow];
    for (int i = 0; i < count; ++i) changed[i] = (residual[i] + row.neighbours(x, i)) * inverse[i];
    std::copy_n(changed, count, x);
  });
}

/// The first forward sweep of smoothing, specialised for an initial correction of zero.
void PressureSolver::smooth_from_zero(Level& level) {
  const int count = level.lattice.counts.x();
  for_rows(level.lattice, [&](int j, int k) {
    if (((j + k) & 1) != 0) return;
    const std::size_t at = level.lattice.index(1, j, k);
    const float *residual = &level.residual[at], *inverse = &level.inverse_diagonal[at];
    float* __restrict x = &level.correction[at];
    for (int i = 0; i < count; ++i) x[i] = residual[i] * inverse[i];
  });
  for_rows(level.lattice, [&](int j, int k) {
    if (((j + k) & 1) != 1) return;
    const std::size_t at = level.lattice.index(1, j, k);
    const Row row = row_of(level.lattice, level.a, at);
    const float *residual = &level.residual[at], *inverse = &level.inverse_diagonal[at];
    float* x = &level.correction[at];
    float changed[kLongestRow];
    for (int i = 0; i < count; ++i) changed[i] = (residual[i] + row.across(x, i)) * inverse[i];
    std::copy_n(changed, count, x);
  });
}

/// One smoothing sweep; backward is the transpose of forward, which keeps the V-cycle symmetric.
void PressureSolver::smooth(Level& level, Order order) {
  smooth_rows(level, order == Order::kForward ? 0 : 1);
  smooth_rows(level, order == Order::kForward ? 1 : 0);
}

/// Restricts the residual: each coarse cell gets the sum over its eight fine cells.
void PressureSolver::restrict_residual(const Level& fine, Level& coarse) {
  for_rows(coarse.lattice, [&](int j, int k) {
    const int count = fine.lattice.counts.x();
    float sum[kLongestRow] = {};
    for (const int fine_k : {2 * k - 1, 2 * k}) {
      for (const int fine_j : {2 * j - 1, 2 * j}) {
        const std::size_t at = fine.lattice.index(1, fine_j, fine_k);
        const Row row = row_of(fine.lattice, fine.a, at);
        const float* residual = &fine.residual[at];
        const float* x = &fine.correction[at];
        for (int i = 0; i < count; ++i) {
          sum[i] += residual[i] + row.neighbours(x, i) - row.diagonal(i) * x[i];
        }
      }
    }
    float* out = &coarse.residual[coarse.lattice.index(1, j, k)];
    for (int i = 0; i < count / 2; ++i) out[i] = sum[2 * i] + sum[2 * i + 1];
  });
}

void PressureSolver::prolong(const Level& coarse, Level& fine) {
  for_rows(fine.lattice, [&](int j, int k) {
    const float* from = &coarse.correction[coarse.lattice.index(1, (j + 1) / 2, (k + 1) / 2)];
    float* x = &fine.correction[fine.lattice.index(1, j, k)];
    for (int i = 0; i < coarse.lattice.counts.x(); ++i) {
      x[2 * i] += from[i];
      x[2 * i + 1] += from[i];
    }
  });
}

/// Runs one V-cycle for the right-hand side `residual` of a level, from a correction of zero.
void PressureSolver::cycle(std::size_t at) {
  Level& level = levels_[at];
  smooth_from_zero(level);
  const bool coarsest = at + 1 == levels_.size();
  const int sweeps = coarsest ? kCoarsestSweeps : kSmoothingSweeps;
  for (int i = 1; i < sweeps; ++i) smooth(level, Order::kForward);
  if (!coarsest) {
    restrict_residual(level, levels_[at + 1]);
    cycle(at + 1);
    prolong(levels_[at + 1], level);
  }
  for (int i = 0; i < sweeps; ++i) smooth(level, Order::kBackward);
}

/// Computes matrix_direction_ = matrix · direction_; returns their dot product.
double PressureSolver::apply_and_dot() {
  const Lattice& lattice = levels_[0].lattice;
  const int count = lattice.counts.x();
  return sum_rows(lattice, partial_, [&](std::size_t at) {
    const Row row = row_of(lattice, levels_[0].a, at);
    const float* x = &direction_[at];
    float* image = &matrix_direction_[at];
    for (int i = 0; i < count; ++i) image[i] = row.diagonal(i) * x[i] - row.neighbours(x, i);
    return dot_row(x, image, count);
  });
}

double PressureSolver::dot(const Field& x, const Field& y) {
  const Lattice& lattice = levels_[0].lattice;
  return sum_rows(lattice, partial_,
                  [&](std::size_t at) { return dot_row(&x[at], &y[at], lattice.counts.x()); });
}

/// Computes direction = correction + beta · direction.
void PressureSolver::update_direction(float beta) {
  const Lattice& lattice = levels_[0].lattice;
  for_rows(lattice, [&](int j, int k) {
    const std::size_t at = lattice.index(1, j, k);
    float* direction = &direction_[at];
    const float* correction = &levels_[0].correction[at];
    for (int i = 0; i < lattice.counts.x(); ++i) {
      direction[i] = correction[i] + beta * direction[i];
    }
  });
}

/// Computes pressure += alpha · direction, residual −= alpha · image; returns max |residual|.
float PressureSolver::step(float alpha) {
  const Lattice& lattice = levels_[0].lattice;
  const int count = lattice.counts.x();
  std::fill(partial_.begin(), partial_.end(), 0.0);
  for_rows(lattice, [&](int j, int k) {
    const std::size_t at = lattice.index(1, j, k);
    float* p = &pressure_[at];
    float* residual = &levels_[0].residual[at];
    const float* direction = &direction_[at];
    const float* image = &matrix_direction_[at];
    for (int i = 0; i < count; ++i) {
      p[i] += alpha * direction[i];
      residual[i] -= alpha * image[i];
    }
    double& largest = partial_[static_cast<std::size_t>(k) - 1];
    largest = std::max(largest, double{largest_in(residual, count)});
  });
  return static_cast<float>(*std::max_element(partial_.begin(), partial_.end()));
}

float PressureSolver::minimize_along_direction(double direction_dot_residual) {
  const double curvature = apply_and_dot();
  return step(curvature > 0 ? static_cast<float>(direction_dot_residual / curvature) : 0);
}

int PressureSolver::solve(float tolerance) {
  find_diagonal(levels_[0]);
  for (std::size_t level = 1; level < levels_.size(); ++level) {
    coarsen(levels_[level - 1], levels_[level]);
    find_diagonal(levels_[level]);
  }
  // Warm start: the pressure of the last solve is the first search direction.
  std::swap(direction_, pressure_);
  std::fill(pressure_.begin(), pressure_.end(), 0.0f);
  float largest = minimize_along_direction(dot(levels_[0].residual, direction_));
  double before = 0;
  int iterations = 0;
  for (; largest > tolerance && iterations < kMaxPressureIterations; ++iterations) {
    cycle(0);
    const double now = dot(levels_[0].residual, levels_[0].correction);
    update_direction(before > 0 ? static_cast<float>(now / before) : 0);
    before = now;
    largest = minimize_along_direction(now);
  }
  return iterations;
}

}  // namespace sunder::solver
