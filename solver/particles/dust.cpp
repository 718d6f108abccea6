// Read first: advance(), the list of a step's stages, then move().
#include "solver/particles/dust.h"

#include <algorithm>
#include <cmath>

#include "engine/base/parallel.h"
#include "solver/particles/turn.h"

namespace sunder::solver {
namespace {

constexpr std::size_t kChunk = 256;
constexpr float kThrown_s = 0.15f;         // in which thrown dust comes to move with the air
constexpr float kThrownTurbulence = 0.2f;  // of its speed relative to the air
constexpr float kSpread_m2_s = 0.004f;     // growth of a puff's squared radius in still air
constexpr float kMostOpacity = 0.6f;
constexpr float kLeastOpacity = 0.008f;  // thinner dust is gone
constexpr float kAppear_s = 0.1f;
constexpr float kSettle_s = 2;       // until dust that lies has faded
constexpr float kSolid = 0.9f;       // part of a cell from which dust in it lies
constexpr float kCrowded = 4;        // times faster the oldest fade when room is short
constexpr std::uint32_t kRoom = 16;  // one part in so many is kept free for new dust

Vec3f axis_of(const Quatf& rotation) { return rotation * Vec3f::UnitZ(); }

}  // namespace

Dust::Dust(std::uint32_t limit, const Vec3& gravity_W, const Vec3i& air_cells)
    : limit_(limit), gravity_W_(gravity_W), air_cells_(air_cells) {
  const double strength = gravity_W.norm();
  down_W_ = strength > 0 ? Vec3f((gravity_W / strength).cast<float>()) : Vec3f(Vec3f::Zero());
}

void Dust::add(const DustBirth& birth) {
  if (room() == 0) {
    ignore();
    return;
  }
  ++books_.emitted;
  position_W_.push_back(birth.position_W);
  slip_W_.push_back(birth.velocity_W);
  rotation_WD_.push_back(birth.rotation_WD);
  mass_kg_.push_back(birth.mass_kg);
  settling_m_s_.push_back(birth.settling_m_s);
  turbulence_m_s_.push_back(kThrownTurbulence * birth.velocity_W.norm());
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
    return;
  }
  place_air(obstacles.ground_m);
  load_air();
  flow_->air.advance(dt_s, gravity_W_, obstacles);
  for_chunks(position_W_.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    move(begin, end, static_cast<float>(dt_s), static_cast<float>(obstacles.ground_m));
  });
  remove_settled();
}

void Dust::place_air(double ground_m) {
  Vec3f low = position_W_.front(), high = low;
  for (const Vec3f& position : position_W_) {
    low = low.cwiseMin(position);
    high = high.cwiseMax(position);
  }
  if (!flow_) flow_.emplace(Flow{Air(air_cells_), Swirl(Lattice{air_cells_})});
  flow_->air.place(Box{low.cast<double>(), high.cast<double>()}, ground_m);
}

/// Tells the air what it carries, and gathers the vortices.
void Dust::load_air() {
  Air& air = flow_->air;
  Swirl& swirl = flow_->swirl;
  air.clear_loads();
  swirl.clear();
  for (std::size_t puff = 0; puff < position_W_.size(); ++puff) {
    const Vec3i at = air.cell_at(position_W_[puff]);
    const std::size_t cell = air.grid().lattice.index(at.x(), at.y(), at.z());
    air.add_dust(cell, mass_kg_[puff]);
    if (age_s_[puff] == 0) air.add_momentum(cell, mass_kg_[puff], slip_W_[puff]);
    swirl.add(cell, air.to_cells(position_W_[puff]), axis_of(rotation_WD_[puff]),
              turbulence_m_s_[puff]);
  }
  swirl.finish();
}

/// With the air, the swirl, what is left of the throw, and down.
void Dust::move(std::size_t begin, std::size_t end, float dt_s, float ground_m) {
  const Air& air = flow_->air;
  const auto cell_m = static_cast<float>(air.grid().cell_m);
  for (std::size_t puff = begin; puff < end; ++puff) {
    Vec3f& position = position_W_[puff];
    const Vec3i at = air.cell_at(position);
    const std::size_t cell = air.grid().lattice.index(at.x(), at.y(), at.z());
    const AirGradient gradient = air.gradient(at);
    const float solid = std::min(1.0f, air.solid(at));
    float& turbulence = turbulence_m_s_[puff];
    turbulence = grow_turbulence(turbulence, gradient.strain_s, cell_m, dt_s);

    const Vec3f axis = axis_of(rotation_WD_[puff]);
    const Vec3f own = (turbulence / (0.5f * cell_m)) * axis;
    turn(rotation_WD_[puff], own + rod_spin(axis, gradient.vorticity_s, gradient.strain_s), dt_s);

    const Vec3f drift =
        settling_m_s_[puff] * down_W_ + flow_->swirl.velocity(cell, air.to_cells(position));
    slip_W_[puff] /= 1 + dt_s / kThrown_s;
    const Vec3f own_way = slip_W_[puff] + (1 - solid) * drift;
    const Vec3f middle = position + 0.5f * dt_s * (air.velocity(position) + own_way);
    position += dt_s * (air.velocity(middle) + own_way);

    float& radius = radius_m_[puff];
    const float mixing = kSpread_m2_s + 0.1f * cell_m * turbulence;
    radius = std::sqrt(radius * radius + dt_s * mixing);
    age_s_[puff] += dt_s;
    settle(puff, dt_s, solid, ground_m);
  }
}

void Dust::settle(std::size_t puff, float dt_s, float solid, float ground_m) {
  Vec3f& position = position_W_[puff];
  const bool lies = position.y() <= ground_m || solid > kSolid;
  position.y() = std::max(position.y(), ground_m);
  const std::size_t kept = limit_ - limit_ / kRoom;
  const bool crowded = position_W_.size() > kept && puff < position_W_.size() - kept;
  float& settled = settled_s_[puff];
  if (lies || crowded) settled += dt_s * (crowded ? kCrowded : 1);
  const float thin = first_radius_m_[puff] / radius_m_[puff];
  const float appear = std::min(1.0f, age_s_[puff] / kAppear_s);
  const float stay = std::max(0.0f, 1 - settled / kSettle_s);
  opacity_[puff] = kMostOpacity * appear * stay * thin * thin;
}

/// Keeps the order of birth.
void Dust::remove_settled() {
  std::size_t kept = 0;
  for (std::size_t puff = 0; puff < position_W_.size(); ++puff) {
    const bool appeared = age_s_[puff] >= kAppear_s;
    if (appeared && opacity_[puff] < kLeastOpacity) continue;
    const auto keep = [&](auto&... arrays) { ((arrays[kept] = arrays[puff]), ...); };
    keep(position_W_, slip_W_, rotation_WD_, mass_kg_, settling_m_s_, turbulence_m_s_,
         first_radius_m_, radius_m_, opacity_, age_s_, settled_s_, material_);
    ++kept;
  }
  books_.gone += position_W_.size() - kept;
  const auto cut = [&](auto&... arrays) { (arrays.resize(kept), ...); };
  cut(position_W_, slip_W_, rotation_WD_, mass_kg_, settling_m_s_, turbulence_m_s_, first_radius_m_,
      radius_m_, opacity_, age_s_, settled_s_, material_);
}

DustView Dust::view() const {
  return {position_W_, rotation_WD_, radius_m_, opacity_, age_s_, material_};
}

ParticleBooks Dust::books() const {
  ParticleBooks books = books_;
  books.alive = books.awake = static_cast<std::uint32_t>(position_W_.size());
  return books;
}

}  // namespace sunder::solver
