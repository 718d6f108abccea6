// Read first: advance(), which lists the stages of a step, then move().
#include "solver/particles/dust.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "engine/base/parallel.h"
#include "engine/base/state_checks.h"
#include "solver/base/morton_order.h"
#include "solver/particles/rotate.h"
#include "solver/particles/tuning.h"

namespace sunder::solver {
namespace {

constexpr std::size_t kPuffsPerChunk = 256;
constexpr std::size_t kPrefetchDistance = 8;  // puffs between prefetching and reading

Vec3f axis_of(const Quatf& rotation) { return rotation * Vec3f::UnitZ(); }

}  // namespace

Dust::Dust(std::uint32_t limit, const Vec3& gravity_W, const Vec3i& air_cells)
    : limit_(limit), gravity_W_(gravity_W), air_cells_(air_cells) {
  const double strength = gravity_W.norm();
  down_W_ = strength > 0 ? Vec3f((gravity_W / strength).cast<float>()) : Vec3f(Vec3f::Zero());
}

const char* Dust::wrong_field() const {
  const std::size_t puffs = position_W_.size();
  if (puffs > limit_) return "limit_";
  if (!have_size(puffs, slip_W_, rotation_WD_, mass_kg_, settling_m_s_, turbulence_m_s_,
                 first_radius_m_, radius_m_, opacity_, age_s_, settled_s_, material_))
    return "position_W_";
  const auto is_number = [](float number) { return number >= 0 && number < 1e9f; };
  if (!std::ranges::all_of(mass_kg_, is_number)) return "mass_kg_";
  if (!std::ranges::all_of(radius_m_, is_number)) return "radius_m_";
  if (!std::ranges::all_of(first_radius_m_, is_number)) return "first_radius_m_";
  if (!std::ranges::all_of(turbulence_m_s_, is_number)) return "turbulence_m_s_";
  if (!std::ranges::all_of(age_s_, is_number)) return "age_s_";
  const auto is_near = [](const Vec3f& v) { return v.cwiseAbs().maxCoeff() < 1e9f; };
  if (!std::ranges::all_of(position_W_, is_near)) return "position_W_";
  return std::ranges::all_of(slip_W_, is_near) ? nullptr : "slip_W_";
}

void Dust::add(const DustBirth& birth) {
  if (room() == 0) {
    ignore();
    return;
  }
  ++counts_.emitted;
  position_W_.push_back(birth.position_W);
  slip_W_.push_back(birth.velocity_W);
  rotation_WD_.push_back(birth.rotation_WD);
  mass_kg_.push_back(birth.mass_kg);
  settling_m_s_.push_back(birth.settling_m_s);
  turbulence_m_s_.push_back(kDustTurbulence * birth.velocity_W.norm());
  first_radius_m_.push_back(birth.radius_m);
  radius_m_.push_back(birth.radius_m);
  opacity_.push_back(0);
  age_s_.push_back(0);
  settled_s_.push_back(0);
  material_.push_back(birth.material);
}

void Dust::advance(double dt_s, const Obstacles& obstacles) {
  if (position_W_.empty()) {
    flow_.reset();
    wanted_cells_.setZero();
    return;
  }
  place_air(obstacles.ground_m);
  sort_into_cells();
  load_air();
  flow_->air.advance(dt_s, gravity_W_, obstacles);
  for_chunks(
      position_W_.size(), kPuffsPerChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
        Surroundings around;
        for (std::size_t i = begin; i < end; ++i) {
          if (i + kPrefetchDistance < end) prefetch_puff(order_[i + kPrefetchDistance]);
          if (i == begin || cell_[order_[i]] != around.cell) sample_surroundings(order_[i], around);
          move(order_[i], around, static_cast<float>(dt_s), static_cast<float>(obstacles.ground_m));
        }
      });
  remove_settled();
}

/// Returns a box around the dust without the outliers on each side, from a sample of the puffs.
Box Dust::cloud_box() {
  Box box;
  const std::size_t every = 1 + position_W_.size() / kCloudSamples;
  const std::size_t outliers = (position_W_.size() + every - 1) / every / kPuffsPerOutlier;
  for (int axis = 0; axis < 3; ++axis) {
    sorted_m_.clear();
    for (std::size_t p = 0; p < position_W_.size(); p += every) {
      sorted_m_.push_back(position_W_[p][axis]);
    }
    const auto low = sorted_m_.begin() + static_cast<std::ptrdiff_t>(outliers);
    const auto high = sorted_m_.end() - 1 - static_cast<std::ptrdiff_t>(outliers);
    std::nth_element(sorted_m_.begin(), low, sorted_m_.end());
    if (low < high) std::nth_element(low + 1, high, sorted_m_.end());
    box.min[axis] = double{*low};
    box.max[axis] = double{*high};
  }
  return box;
}

/// Returns the least cell counts, in fifths of the greatest per axis, that suffice for this number
/// of puffs. The counts shrink only if the smaller ones suffice by a margin of a half (hysteresis).
Vec3i Dust::cells_for(std::size_t puffs) const {
  constexpr int kSteps = 5, kUnit = 8;
  for (int step = 2; step < kSteps; ++step) {
    const Vec3i part = (step * air_cells_ + Vec3i::Constant(kSteps * kUnit - 1)) / (kSteps * kUnit);
    const Vec3i cells = kUnit * part;
    const bool fewer = cells.prod() < wanted_cells_.prod();
    const std::size_t wanted = kAirCellsPerPuff * puffs * (fewer ? 3 : 2) / 2;
    if (static_cast<std::size_t>(cells.prod()) >= wanted) return cells;
  }
  return air_cells_;
}

/// Returns `cells` halved along the axes on which the cloud fits into half of them, at the same
/// cell size; about half of all clouds are flat or long.
Vec3i Dust::halve_where_possible(Vec3i cells, const Vec3& extent) const {
  const Vec3i now = flow_ ? flow_->air.grid().lattice.counts : Vec3i(Vec3i::Zero());
  const double cell_m = cell_m_for(extent, cells);
  const Vec3i least(16, 8, 8);  // required by the coarser grids of the pressure solver
  for (int axis = 0; axis < 3; ++axis) {
    while (cells[axis] % 16 == 0 && cells[axis] / 2 >= least[axis]) {
      const int half = cells[axis] / 2;
      const double part = now[axis] > 0 && now[axis] <= half ? 1 : kAirHalvingMargin;
      if (!grid_fits(extent[axis], half, part * cell_m)) break;
      cells[axis] = half;
    }
  }
  return cells;
}

void Dust::place_air(double ground_m) {
  const Box box = cloud_box();
  wanted_cells_ = cells_for(position_W_.size());
  const Vec3i cells = halve_where_possible(wanted_cells_, box.extent());
  if (flow_ && flow_->air.grid().lattice.counts != cells) {
    Flow next(cells);
    next.air.place(box, ground_m);
    next.air.copy_flow_from(flow_->air);
    flow_ = std::move(next);
    return;
  }
  if (!flow_) flow_.emplace(cells);
  flow_->air.place(box, ground_m);
}

void Dust::sort_into_cells() {
  const Air& air = flow_->air;
  cell_.resize(position_W_.size());
  for_chunks(cell_.size(), kPuffsPerChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t puff = begin; puff < end; ++puff) {
      cell_[puff] = kOutside;
      if (!air.contains(position_W_[puff])) continue;
      const Vec3i at = air.cell_at(position_W_[puff]);
      cell_[puff] = static_cast<std::uint32_t>(air.grid().lattice.index(at.x(), at.y(), at.z()));
    }
  });
  order_.resize(position_W_.size());
  std::iota(order_.begin(), order_.end(), 0u);
  sort_by_key(cell_, order_);
}

/// Adds the dust of each cell to the air and to the swirl, on a thread each.
void Dust::load_air() {
  const auto end = std::ranges::find(order_, kOutside, [&](std::uint32_t p) { return cell_[p]; });
  const std::span inside(order_.begin(), end);
  const auto load = [&](Air& air) {
    air.clear_loads();
    for (const std::uint32_t puff : inside) {
      air.add_dust(cell_[puff], mass_kg_[puff]);
      if (age_s_[puff] == 0) air.add_momentum(cell_[puff], mass_kg_[puff], slip_W_[puff]);
    }
  };
  const auto gather = [&](Swirl& swirl) {
    swirl.clear();
    for (const std::uint32_t puff : inside) {
      swirl.add(cell_[puff], flow_->air.to_cells(position_W_[puff]), axis_of(rotation_WD_[puff]),
                turbulence_m_s_[puff]);
    }
    swirl.finish();
  };
  for_chunks(2, 1, [&](std::size_t, std::size_t, std::size_t which) {
    which == 0 ? load(flow_->air) : gather(flow_->swirl);
  });
}

/// Prefetches the data of a puff that move() reads.
void Dust::prefetch_puff(std::size_t puff) const {
  const auto prefetch_each = [puff](const auto&... arrays) {
    (__builtin_prefetch(&arrays[puff]), ...);
  };
  prefetch_each(position_W_, slip_W_, rotation_WD_, settling_m_s_, turbulence_m_s_, first_radius_m_,
                radius_m_, opacity_, age_s_, settled_s_);
}

void Dust::sample_surroundings(std::size_t puff, Surroundings& around) const {
  around.cell = cell_[puff];
  if (around.cell == kOutside) {
    around.gradient = {};
    around.solid = 0;
    return;
  }
  const Air& air = flow_->air;
  const Vec3i at = air.cell_at(position_W_[puff]);
  around.gradient = air.gradient(at);
  around.solid = std::min(1.0f, air.solid(at));
  flow_->swirl.find(around.cell, around.swirl);
}

/// Moves a puff with the air, the swirl, its remaining velocity relative to the air, and settling.
void Dust::move(std::size_t puff, const Surroundings& around, float dt_s, float ground_m) {
  const Air& air = flow_->air;
  const auto cell_m = static_cast<float>(air.grid().cell_m);
  Vec3f& position = position_W_[puff];
  float& turbulence = turbulence_m_s_[puff];
  turbulence = grow_turbulence(turbulence, around.gradient.strain_s, cell_m, dt_s);

  const Vec3f axis = axis_of(rotation_WD_[puff]);
  const Vec3f own = (turbulence / (0.5f * cell_m)) * axis;
  rotate(rotation_WD_[puff],
         own + rod_spin(axis, around.gradient.vorticity_s, around.gradient.strain_s), dt_s);

  Vec3f drift = settling_m_s_[puff] * down_W_;
  if (around.cell != kOutside) drift += around.swirl.velocity(air.to_cells(position));
  slip_W_[puff] /= 1 + dt_s / kDustSlipDecay_s;
  const Vec3f own_velocity = slip_W_[puff] + (1 - around.solid) * drift;
  const Vec3f middle = position + 0.5f * dt_s * (air.velocity(position) + own_velocity);
  position += dt_s * (air.velocity(middle) + own_velocity);

  float& radius = radius_m_[puff];
  const float mixing = kDustSpread_m2_s + kTurbulentSpread * cell_m * turbulence;
  radius = std::sqrt(radius * radius + dt_s * mixing);
  age_s_[puff] += dt_s;
  settle(puff, dt_s, around.solid, ground_m);
}

void Dust::settle(std::size_t puff, float dt_s, float solid, float ground_m) {
  Vec3f& position = position_W_[puff];
  const bool lies = position.y() <= ground_m || solid > kSettledSolidFraction;
  position.y() = std::max(position.y(), ground_m);
  const std::size_t kept = limit_ - limit_ / kPuffReserve;
  const bool near_limit = position_W_.size() > kept && puff < position_W_.size() - kept;
  float& settled = settled_s_[puff];
  if (lies || near_limit) settled += dt_s * (near_limit ? kEarlyFadeRate : 1);
  const float thin = first_radius_m_[puff] / radius_m_[puff];
  const float appear = std::min(1.0f, age_s_[puff] / kDustFadeIn_s);
  const float stay = std::max(0.0f, 1 - settled / kDustFadeOut_s);
  // The power 3/2 in place of the 2 of uniform thinning, because dust forms clots.
  opacity_[puff] = kMaxDustOpacity * appear * stay * thin * std::sqrt(thin);
}

/// Removes puffs that have faded; the others keep their order.
void Dust::remove_settled() {
  const auto gone = [&](std::size_t puff) {
    return age_s_[puff] >= kDustFadeIn_s && opacity_[puff] < kMinDustOpacity;
  };
  std::size_t kept = 0;
  while (kept < position_W_.size() && !gone(kept)) ++kept;
  for (std::size_t puff = kept; puff < position_W_.size(); ++puff) {
    if (gone(puff)) continue;
    const auto keep = [&](auto&... arrays) { ((arrays[kept] = arrays[puff]), ...); };
    keep(position_W_, slip_W_, rotation_WD_, mass_kg_, settling_m_s_, turbulence_m_s_,
         first_radius_m_, radius_m_, opacity_, age_s_, settled_s_, material_);
    ++kept;
  }
  counts_.gone += position_W_.size() - kept;
  const auto cut = [&](auto&... arrays) { (arrays.resize(kept), ...); };
  cut(position_W_, slip_W_, rotation_WD_, mass_kg_, settling_m_s_, turbulence_m_s_, first_radius_m_,
      radius_m_, opacity_, age_s_, settled_s_, material_);
}

DustView Dust::view() const { return {position_W_, rotation_WD_, radius_m_, opacity_, material_}; }

ParticleCounts Dust::counts() const {
  ParticleCounts counts = counts_;
  counts.alive = counts.awake = static_cast<std::uint32_t>(position_W_.size());
  return counts;
}

}  // namespace sunder::solver
