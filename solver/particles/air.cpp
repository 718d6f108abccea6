// Read first: advance(), which lists the stages of a step.
#include "solver/particles/air.h"

#include <algorithm>

#include "engine/base/parallel.h"
#include "engine/base/state_checks.h"
#include "solver/particles/tuning.h"

namespace sunder::solver {
namespace {

/// Calls work(first index, number of faces in the row, j, k) for every row of faces of an axis.
template <class Work>
void for_faces(const Lattice& lattice, int axis, const Work& work) {
  const Vec3i last = lattice.counts + Vec3i::Unit(axis);
  for_chunks(static_cast<std::size_t>(last.z()), lattice.layers_a_chunk(),
             [&](std::size_t begin, std::size_t end, std::size_t) {
               for (int k = static_cast<int>(begin) + 1; k <= static_cast<int>(end); ++k) {
                 for (int j = 1; j <= last.y(); ++j) {
                   work(lattice.index(1, j, k), last.x(), j, k);
                 }
               }
             });
}

/// Calls work(first index, number of cells in the row, j, k) for every row of cells.
template <class Work>
void for_cells(const Lattice& lattice, const Work& work) {
  for_chunks(static_cast<std::size_t>(lattice.counts.z()), lattice.layers_a_chunk(),
             [&](std::size_t begin, std::size_t end, std::size_t) {
               for (int k = static_cast<int>(begin) + 1; k <= static_cast<int>(end); ++k) {
                 for (int j = 1; j <= lattice.counts.y(); ++j) {
                   work(lattice.index(1, j, k), lattice.counts.x(), j, k);
                 }
               }
             });
}

constexpr int kLongestRow = 136;

/// Departure points of a row of faces: displacement upstream, in cells, at most one per axis.
struct DeparturePoints {
  float x[kLongestRow], y[kLongestRow], z[kLongestRow];
  float* operator[](int axis) { return axis == 0 ? x : axis == 1 ? y : z; }
};

// Minimum and maximum by value: unlike those of the standard library, these vectorise.
float least(float a, float b) { return a < b ? a : b; }
float most(float a, float b) { return a > b ? a : b; }
float clamp_to_one_cell(float x) { return least(most(x, -1), 1); }

/// Interpolation weights of three neighbouring values for a point `x` cells upstream of the middle
/// one: quadratic, blended with linear, because quadratic alone amplifies noise at grid scale.
struct Taps {
  float low, middle, high;
  explicit Taps(float x) {
    const float linear = kLinearAdvection * most(x, -x);
    const float square = (1 - kLinearAdvection) * x * x;
    low = 0.5f * (square + linear + x);
    high = 0.5f * (square + linear - x);
    middle = 1 - square - linear;
  }
};

/// Interpolates q at the departure points, clamped to the range of the surrounding values.
void advect_row(const float* q, std::ptrdiff_t sy, std::ptrdiff_t sz,
                const DeparturePoints& departures, int count, float* __restrict out) {
  const float* rows[9];
  for (int r = 0; r < 9; ++r) rows[r] = q + (r % 3 - 1) * sy + (r / 3 - 1) * sz;
  for (int i = 0; i < count; ++i) {
    const Taps tx(departures.x[i]), ty(departures.y[i]), tz(departures.z[i]);
    float low = rows[4][i], high = low;
    float along[9];
#pragma GCC unroll 9
    for (int r = 0; r < 9; ++r) {
      const float a = rows[r][i - 1], b = rows[r][i], c = rows[r][i + 1];
      along[r] = tx.low * a + tx.middle * b + tx.high * c;
      low = least(low, least(a, least(b, c)));
      high = most(high, most(a, most(b, c)));
    }
    const auto across = [&](const float* row) {
      return ty.low * row[0] + ty.middle * row[1] + ty.high * row[2];
    };
    const float value =
        tz.low * across(along) + tz.middle * across(along + 3) + tz.high * across(along + 6);
    out[i] = least(most(value, low), high);
  }
}

/// Blends the velocity of each face of a row towards that of the solid that covers it, by the
/// covered fraction, and writes the open fraction to `open`.
void apply_solids_to_row(const float* fraction, const float* momentum, std::ptrdiff_t below,
                         int count, float* __restrict u, float* __restrict open) {
  for (int i = 0; i < count; ++i) {
    const float solid = fraction[i] + fraction[i + below];
    const float covered = least(kCoverGain * solid, 1);
    const float mean = (momentum[i] + momentum[i + below]) / most(solid, 1e-6f);
    u[i] += covered * (mean - u[i]);
    open[i] = most(1 - kCoverGain * solid, kMinOpenFraction);
  }
}

}  // namespace

Air::Air(const Vec3i& counts) : Flow(counts), solver_(counts) {
  const std::size_t size = grid_.lattice.size();
  for (auto* fields : {&advected_, &emitted_Ns_}) {
    for (Field& field : *fields) field.assign(size, 0);
  }
  for (Field* field : {&dust_kg_, &emitted_kg_}) field->assign(size, 0);
}

bool Air::place(const Box& dust, double ground_m) {
  if (placed_ && may_stay(grid_, dust)) return false;
  const Grid grid = grid_around(dust, ground_m, grid_, placed_);
  if (placed_) {
    resample(grid, advected_);
    std::swap(velocity_, advected_);
    std::fill(solver_.pressure().begin(), solver_.pressure().end(), 0.0f);
  }
  grid_ = grid;
  placed_ = true;
  return true;
}

void Air::advance(double dt_s, const Vec3& gravity_W, const Obstacles& obstacles) {
  solids_.rasterize(grid_, obstacles);
  advect(static_cast<float>(dt_s));
  apply_dust_loads(static_cast<float>(dt_s), gravity_W.cast<float>());
  apply_solids();
  project();
}

const char* Air::wrong_field() const {
  const Lattice& lattice = grid_.lattice;
  if (lattice.counts != solver_.lattice().counts) return "grid_";
  const std::size_t cells = lattice.size();
  const auto fit = [&](const std::array<Field, 3>& fields) {
    return have_size(cells, fields[0], fields[1], fields[2]);
  };
  if (!fit(velocity_)) return "velocity_";
  if (!fit(advected_)) return "advected_";
  if (!have_size(cells, solids_.fraction) || !fit(solids_.momentum)) return "solids_";
  if (dust_kg_.size() != cells) return "dust_kg_";
  if (emitted_kg_.size() != cells) return "emitted_kg_";
  if (!fit(emitted_Ns_)) return "emitted_Ns_";
  return are_different_below(dusty_cells_, cells) ? nullptr : "dusty_cells_";
}

void Air::clear_loads() {
  for (const std::size_t cell : dusty_cells_) {
    dust_kg_[cell] = emitted_kg_[cell] = 0;
    for (Field& emitted : emitted_Ns_) emitted[cell] = 0;
  }
  dusty_cells_.clear();
}

void Air::add_dust(std::size_t cell, float mass_kg) {
  if (dust_kg_[cell] == 0) dusty_cells_.push_back(cell);
  dust_kg_[cell] += mass_kg;
}

void Air::add_momentum(std::size_t cell, float mass_kg, const Vec3f& velocity_W) {
  emitted_kg_[cell] += mass_kg;
  for (int axis = 0; axis < 3; ++axis) of(emitted_Ns_, axis)[cell] += mass_kg * velocity_W[axis];
}

void Air::advect(float dt_s) {
  const Lattice& lattice = grid_.lattice;
  const float cells_per_speed = dt_s / static_cast<float>(grid_.cell_m);
  const std::ptrdiff_t strides[] = {1, lattice.stride(1), lattice.stride(2)};
  for (int axis = 0; axis < 3; ++axis) {
    for_faces(lattice, axis, [&](std::size_t at, int count, int, int) {
      DeparturePoints departures;
      for (int other = 0; other < 3; ++other) {
        const float* u = &of(velocity_, other)[at];
        float* departure = departures[other];
        if (other == axis) {
          for (int i = 0; i < count; ++i) departure[i] = clamp_to_one_cell(cells_per_speed * u[i]);
          continue;
        }
        // Mean over the four nearest faces of the other axis.
        const std::ptrdiff_t back = -strides[axis], up = strides[other];
        for (int i = 0; i < count; ++i) {
          const float sum = u[i] + u[i + back] + (u[i + up] + u[i + up + back]);
          departure[i] = clamp_to_one_cell(0.25f * cells_per_speed * sum);
        }
      }
      advect_row(&of(velocity_, axis)[at], strides[1], strides[2], departures, count,
                 &of(advected_, axis)[at]);
    });
  }
  std::swap(velocity_, advected_);
}

/// Applies the weight of the dust and the momentum of newly emitted dust to the air.
void Air::apply_dust_loads(float dt_s, const Vec3f& gravity_W) {
  const auto volume = static_cast<float>(grid_.cell_m * grid_.cell_m * grid_.cell_m);
  const float air_kg = kAirDensity_kg_m3 * volume;
  const auto apply = [&](int axis, std::size_t face) {
    const std::size_t below = face - static_cast<std::size_t>(grid_.lattice.stride(axis));
    const float dust_kg = 0.5f * (dust_kg_[below] + dust_kg_[face]);
    const float emitted_kg = 0.5f * (emitted_kg_[below] + emitted_kg_[face]);
    const Field& emitted_Ns = of(emitted_Ns_, axis);
    const float momentum = 0.5f * (emitted_Ns[below] + emitted_Ns[face]);
    float& u = of(velocity_, axis)[face];
    u = (air_kg * u + momentum) / (air_kg + emitted_kg);
    u += dt_s * gravity_W[axis] * dust_kg / (air_kg + dust_kg);
  };
  for_chunks(3, 1, [&](std::size_t, std::size_t, std::size_t which) {
    const auto axis = static_cast<int>(which);
    for (const std::size_t cell : dusty_cells_) {
      apply(axis, cell);
      const std::size_t above = cell + static_cast<std::size_t>(grid_.lattice.stride(axis));
      if (dust_kg_[above] == 0) apply(axis, above);
    }
  });
}

void Air::apply_solids() {
  const Lattice& lattice = grid_.lattice;
  const Vec3i& counts = lattice.counts;
  for (int axis = 0; axis < 3; ++axis) {
    const std::ptrdiff_t below = -lattice.stride(axis);
    for_faces(lattice, axis, [&](std::size_t at, int count, int j, int k) {
      const float *fraction = &solids_.fraction[at], *momentum = &of(solids_.momentum, axis)[at];
      float *u = &of(velocity_, axis)[at], *a = &of(solver_.coefficients(), axis)[at];
      const bool rim =
          (axis == 1 && (j == 1 || j > counts.y())) || (axis == 2 && (k == 1 || k > counts.z()));
      const bool closed = axis == 1 && j == 1 && grid_.on_ground;
      apply_solids_to_row(fraction, momentum, below, count, u, a);
      if (rim) std::transform(a, a + count, a, [&](float open) { return closed ? 0 : 2 * open; });
      if (closed) std::fill_n(u, count, 0.0f);
      if (axis == 0) {
        a[0] *= 2;
        a[count - 1] *= 2;
      }
    });
  }
}

void Air::project() {
  const Lattice& lattice = grid_.lattice;
  const std::ptrdiff_t sy = lattice.stride(1), sz = lattice.stride(2);
  max_speed_of_layer_.assign(static_cast<std::size_t>(lattice.counts.z()), 0);
  for_cells(lattice, [&](std::size_t at, int count, int, int k) {
    const float *u = &velocity_[0][at], *v = &velocity_[1][at], *w = &velocity_[2][at];
    float& layer = max_speed_of_layer_[static_cast<std::size_t>(k) - 1];
    for (const float* row : {u, v, w}) layer = std::max(layer, largest_in(row, count + 1));
    float* inflow = &solver_.inflow()[at];
    for (int i = 0; i < count; ++i) {
      inflow[i] = u[i] - u[i + 1] + (v[i] - v[i + sy]) + (w[i] - w[i + sz]);
    }
  });
  iterations_ = solver_.solve(kOutflowTolerance * *std::ranges::max_element(max_speed_of_layer_));
  for (int axis = 0; axis < 3; ++axis) {
    const std::ptrdiff_t below = -lattice.stride(axis);
    for_faces(lattice, axis, [&](std::size_t at, int count, int, int) {
      const float* p = &solver_.pressure()[at];
      const float* a = &of(solver_.coefficients(), axis)[at];
      float* u = &of(velocity_, axis)[at];
      for (int i = 0; i < count; ++i) u[i] -= a[i] * (p[i] - p[i + below]);
    });
  }
  if (grid_.on_ground) apply_free_slip_at_ground();
}

/// Copies the tangential velocities of the lowest layer below the closed floor (free slip).
void Air::apply_free_slip_at_ground() {
  const Lattice& lattice = grid_.lattice;
  for (const int axis : {0, 2}) {
    Field& u = of(velocity_, axis);
    for (int k = 1; k <= lattice.counts.z() + 1; ++k) {
      const std::size_t at = lattice.index(1, 0, k);
      const auto row = u.begin() + static_cast<std::ptrdiff_t>(at) + lattice.stride(1);
      std::copy_n(row, lattice.counts.x() + 1, u.begin() + static_cast<std::ptrdiff_t>(at));
    }
  }
}

}  // namespace sunder::solver
