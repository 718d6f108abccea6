#include "scenes/file/chain.h"

#include "fracture/adjacency/compound_builder.h"

namespace sunder::scenes {
namespace {

// Fractions of the inner length of a link.
constexpr double kBarThickness = 0.2;
constexpr double kLinkWidth = 0.72;  // outer width

/// Returns a link along x with the inner length `pitch_m`: a rectangle of four bars.
Compound make_link(double pitch_m, MaterialIndex material) {
  const double bar = kBarThickness * pitch_m, width = kLinkWidth * pitch_m;
  const Vec3 inner(0.5 * pitch_m, 0.5 * width - bar, 0.5 * bar), side(inner.x(), bar, bar);
  std::vector<fracture::Part> parts;
  for (const double s : {-1.0, 1.0}) {
    const Vec3 end(s * (inner.x() + 0.5 * bar), 0, 0), rail(0, s * (inner.y() + 0.5 * bar), 0);
    const Vec3 half_end(0.5 * bar, 0.5 * width, 0.5 * bar);
    const Vec3 half_rail(inner.x(), 0.5 * bar, 0.5 * bar);
    parts.push_back({make_box(end - half_end, end + half_end), material});
    parts.push_back({make_box(rail - half_rail, rail + half_rail), material});
  }
  return fracture::make_compound(std::move(parts));
}

}  // namespace

std::vector<Solid> make_chain(const Shot& shot, std::uint32_t count) {
  const Vec3 from = *shot.hangs_from_W, to_center = shot.ball.center_W - from;
  const Vec3 along = to_center.normalized();
  const double pitch_m = (to_center.norm() - shot.ball.radius_m) / std::max(1u, count);
  const Quat aligned = Quat::FromTwoVectors(Vec3::UnitX(), along);
  const Quat quarter(std::sqrt(0.5), std::sqrt(0.5), 0, 0);
  std::vector<Solid> links(count);
  for (std::uint32_t i = 0; i < count; ++i) {
    Solid& link = links[i];
    link.name = shot.ball.name + ".link." + std::to_string(i);
    link.compound = make_link(pitch_m, shot.ball.material);
    link.X_WR = {from + (i + 0.5) * pitch_m * along,
                 i % 2 == 0 ? aligned : Quat(aligned * quarter)};
    link.velocity_W = (i + 0.5) / count * shot.ball.velocity_W;
  }
  return links;
}

}  // namespace sunder::scenes
