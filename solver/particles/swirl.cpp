#include "solver/particles/swirl.h"

#include <algorithm>
#include <cmath>

#include "engine/base/state_checks.h"
#include "solver/particles/tuning.h"

namespace sunder::solver {
namespace {

// Factor that makes the greatest value of the vortex profile q (1 − q²)² equal to 1.
constexpr float kProfile = 3.4939f;

}  // namespace

Swirl::Swirl(const Lattice& lattice) : lattice_(lattice), vortex_of_cell_(lattice.size(), -1) {}

const char* Swirl::wrong_field() const {
  if (vortex_of_cell_.size() != lattice_.size()) return "vortex_of_cell_";
  for (std::size_t i = 0; i < vortices_.size(); ++i) {
    if (vortices_[i].cell >= vortex_of_cell_.size() ||
        vortex_of_cell_[vortices_[i].cell] != static_cast<std::int32_t>(i))
      return "vortices_";
  }
  const auto empty = static_cast<std::size_t>(std::ranges::count(vortex_of_cell_, -1));
  return empty + vortices_.size() == vortex_of_cell_.size() ? nullptr : "vortex_of_cell_";
}

void Swirl::clear() {
  for (const Vortex& vortex : vortices_) vortex_of_cell_[vortex.cell] = -1;
  vortices_.clear();
}

void Swirl::add(std::size_t cell, const Vec3f& at, const Vec3f& axis, float speed_m_s) {
  std::int32_t& index = vortex_of_cell_[cell];
  if (index < 0) {
    index = static_cast<std::int32_t>(vortices_.size());
    vortices_.emplace_back().cell = cell;
  }
  Vortex& vortex = vortices_[static_cast<std::size_t>(index)];
  vortex.at += at;
  vortex.spin += speed_m_s * axis;
  vortex.energy += speed_m_s * speed_m_s;
  ++vortex.count;
}

void Swirl::finish() {
  for (Vortex& vortex : vortices_) {
    vortex.at /= vortex.count;
    const float length = vortex.spin.norm();
    // 2/3: a vortex moves the air in two of three directions.
    const float speed = std::sqrt(2.0f / 3 * vortex.energy / vortex.count);
    if (length > 0) vortex.spin *= speed / length;
  }
}

void Swirl::find(std::size_t cell, Near& near) const {
  near.count_ = 0;
  const auto add = [&](const Vec3f& at, const Vec3f& spin) {
    for (int axis = 0; axis < 3; ++axis) {
      near.at_[axis][near.count_] = at[axis];
      near.spin_[axis][near.count_] = spin[axis];
    }
    ++near.count_;
  };
  const auto center = static_cast<std::ptrdiff_t>(cell);
  for (int k = -1; k <= 1; ++k) {
    for (int j = -1; j <= 1; ++j) {
      const std::ptrdiff_t row = center + j * lattice_.stride(1) + k * lattice_.stride(2);
      for (std::ptrdiff_t c = row - 1; c <= row + 1; ++c) {
        const std::int32_t index = vortex_of_cell_[static_cast<std::size_t>(c)];
        if (index < 0) continue;
        const Vortex& vortex = vortices_[static_cast<std::size_t>(index)];
        add(vortex.at, vortex.spin);
      }
    }
  }
  while (near.count_ % kLanes != 0) add(Vec3f::Constant(1e9f), Vec3f::Zero());
}

Vec3f Swirl::Near::velocity(const Vec3f& at) const {
  Wide3 sum{};
  for (std::size_t i = 0; i < count_; i += kLanes) {
    const Wide3 arm = {at.x() - load(&at_[0][i]), at.y() - load(&at_[1][i]),
                       at.z() - load(&at_[2][i])};
    const Wide inside = max(1 - dot(arm, arm), Wide{});
    const Wide3 spin = {load(&spin_[0][i]), load(&spin_[1][i]), load(&spin_[2][i])};
    sum = sum + cross(spin, arm) * (kProfile * inside * inside);
  }
  Vec3f velocity = Vec3f::Zero();
  for (std::uint32_t lane = 0; lane < kLanes; ++lane) {
    velocity += Vec3f(sum.x[lane], sum.y[lane], sum.z[lane]);
  }
  return velocity;
}

float grow_turbulence(float speed_m_s, const Mat3f& strain_s, float cell_m, float dt_s) {
  const float grown = speed_m_s + dt_s * kTurbulenceProduction * cell_m * strain_s.squaredNorm();
  return grown / (1 + dt_s * 0.5f * kTurbulenceDissipation * speed_m_s / cell_m);
}

Vec3f rod_spin(const Vec3f& axis, const Vec3f& vorticity_s, const Mat3f& strain_s) {
  return 0.5f * vorticity_s + axis.cross(strain_s * axis);
}

}  // namespace sunder::solver
