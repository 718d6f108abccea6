#include "solver/particles/debris_and_dust.h"

#include "engine/base/archive.h"
#include "engine/base/random.h"
#include "solver/particles/crumble.h"
#include "solver/particles/debris.h"
#include "solver/particles/dust.h"

namespace sunder::solver {
namespace {

class DebrisAndDust final : public Particles {
 public:
  explicit DebrisAndDust(const DebrisAndDustOptions& options)
      : seed_(options.seed),
        debris_(options.limits.debris, options.gravity_W),
        dust_(options.limits.dust, options.gravity_W, options.max_air_cells) {}

  std::unique_ptr<Particles> copy() const override {
    return std::make_unique<DebrisAndDust>(*this);
  }
  void archive(Archive& bytes) override { bytes(next_stream_, debris_, dust_); }
  void emit(std::span<const ExposedPolygon> faces) override {
    const CapacityShares shares = capacity_shares(faces, debris_, dust_);
    for (const ExposedPolygon& face : faces) {
      Random random(seed_, next_stream_++);
      crumble(face, shares, random, debris_, dust_);
    }
  }

  void emit(std::span<const DebrisPiece> chips) override {
    for (const DebrisPiece& chip : chips) {
      Random random(seed_, next_stream_++);
      add_chip(chip, random, debris_);
    }
  }

  void advance(double dt_s, const Obstacles& obstacles) override {
    debris_.advance(dt_s, obstacles);
    dust_.advance(dt_s, obstacles);
  }

  DebrisView debris() const override { return debris_.view(); }
  DustView dust() const override { return dust_.view(); }

  ParticleReport report() const override {
    ParticleReport report;
    report.debris = debris_.counts();
    report.dust = dust_.counts();
    if (const Air* air = dust_.air()) {
      report.air_cells = static_cast<std::uint32_t>(air->grid().lattice.cells());
      report.air_iterations = static_cast<std::uint32_t>(air->iterations());
    }
    return report;
  }

 private:
  std::uint64_t seed_;
  /// Next random stream; each face and chip has its own, so that their draws are independent.
  std::uint64_t next_stream_ = 0;
  Debris debris_;
  Dust dust_;
};

}  // namespace

std::unique_ptr<Particles> make_debris_and_dust(const DebrisAndDustOptions& options) {
  return std::make_unique<DebrisAndDust>(options);
}

}  // namespace sunder::solver
