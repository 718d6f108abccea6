#include "solver/particles/flow.h"

#include <algorithm>
#include <cmath>

#include "engine/base/parallel.h"

namespace sunder::solver {

Flow::Flow(const Vec3i& counts) {
  grid_.lattice = {counts};
  for (Field& field : velocity_) field.assign(grid_.lattice.size(), 0);
}

void Flow::resample(const Grid& grid, std::array<Field, 3>& into) const {
  const Vec3i last = grid.lattice.counts + Vec3i::Ones();
  const auto scale = static_cast<float>(grid.cell_m / grid_.cell_m);
  const Vec3f shift = ((grid.origin_W - grid_.origin_W) / grid_.cell_m).cast<float>();
  const Vec3f inside = grid_.lattice.counts.cast<float>() + Vec3f::Constant(1.5f);
  for (int axis = 0; axis < 3; ++axis) {
    Field& field = of(into, axis);
    std::fill(field.begin(), field.end(), 0.0f);
    // Offset from a position in cells to the index of a value: along their own axis, faces lie on
    // the lower side of a cell, and in its middle along the others.
    Vec3f half = Vec3f::Constant(0.5f);
    half[axis] = 1;
    for_chunks(
        static_cast<std::size_t>(last.z()), 4,
        [&](std::size_t begin, std::size_t end, std::size_t) {
          for (int k = static_cast<int>(begin) + 1; k <= static_cast<int>(end); ++k) {
            for (int j = 1; j <= last.y(); ++j) {
              for (int i = 1; i <= last.x(); ++i) {
                if ((Vec3i(i, j, k) - Vec3i::Unit(axis) - grid.lattice.counts).maxCoeff() > 0)
                  continue;
                const Vec3f at = scale * (Vec3i(i, j, k).cast<float>() - half) + shift + half;
                if ((at.array() < 0.5f).any() || (at.array() > inside.array()).any()) continue;
                field[grid.lattice.index(i, j, k)] = sample(axis, at);
              }
            }
          }
        });
  }
}

Vec3f Flow::velocity(const Vec3f& point_W) const {
  if (!contains(point_W)) return Vec3f::Zero();
  const Vec3f cells = to_cells(point_W);
  Vec3f velocity;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3f at = cells + Vec3f::Constant(0.5f);
    at[axis] = cells[axis] + 1;
    velocity[axis] = between(axis, at);
  }
  return velocity;
}

/// Returns the velocity at a point in face indices of an axis, clamped to the grid.
float Flow::sample(int axis, const Vec3f& at) const {
  const Vec3f most = (grid_.lattice.counts + Vec3i::Ones()).cast<float>();
  return between(axis, at.cwiseMax(0.0f).cwiseMin(most));
}

/// Interpolates trilinearly at a point in face indices of an axis that is within the grid.
float Flow::between(int axis, const Vec3f& at) const {
  const Lattice& lattice = grid_.lattice;
  const Vec3i low = at.cast<int>();
  const Vec3f part = at - low.cast<float>();
  const float* u = &of(velocity_, axis)[lattice.index(low.x(), low.y(), low.z())];
  const std::ptrdiff_t sy = lattice.stride(1), sz = lattice.stride(2);
  const auto along = [&](std::ptrdiff_t o) { return u[o] + part.x() * (u[o + 1] - u[o]); };
  const float near = along(0) + part.y() * (along(sy) - along(0));
  const float far = along(sz) + part.y() * (along(sz + sy) - along(sz));
  return near + part.z() * (far - near);
}

FlowGradient Flow::gradient(const Vec3i& cell) const {
  const Lattice& lattice = grid_.lattice;
  const std::size_t at = lattice.index(cell.x(), cell.y(), cell.z());
  Mat3f slope;  // slope(axis, other): change of component `axis` per cell along `other`
  for (int axis = 0; axis < 3; ++axis) {
    const float* u = &of(velocity_, axis)[at];
    const std::ptrdiff_t next = lattice.stride(axis);
    for (int other = 0; other < 3; ++other) {
      const std::ptrdiff_t to = lattice.stride(other);
      slope(axis, other) =
          other == axis ? u[next] - u[0] : 0.25f * (u[to] + u[to + next] - u[-to] - u[next - to]);
    }
  }
  slope /= static_cast<float>(grid_.cell_m);
  FlowGradient gradient;
  gradient.strain_s = 0.5f * (slope + slope.transpose());
  gradient.vorticity_s =
      Vec3f(slope(2, 1) - slope(1, 2), slope(0, 2) - slope(2, 0), slope(1, 0) - slope(0, 1));
  return gradient;
}

float Flow::divergence() const {
  const Lattice& lattice = grid_.lattice;
  const auto sy = static_cast<std::size_t>(lattice.stride(1));
  const auto sz = static_cast<std::size_t>(lattice.stride(2));
  float speed = 0, largest = 0;
  for (int k = 1; k <= lattice.counts.z(); ++k) {
    for (int j = 1; j <= lattice.counts.y(); ++j) {
      for (int i = 1; i <= lattice.counts.x(); ++i) {
        const std::size_t at = lattice.index(i, j, k);
        const float outflow = velocity_[0][at + 1] - velocity_[0][at] +
                              (velocity_[1][at + sy] - velocity_[1][at]) +
                              (velocity_[2][at + sz] - velocity_[2][at]);
        largest = std::max(largest, std::abs(outflow));
        for (const Field& u : velocity_) speed = std::max(speed, std::abs(u[at]));
      }
    }
  }
  return speed > 0 ? largest / speed : 0;
}

}  // namespace sunder::solver
