#include "render/passes/blocks.h"

#include "engine/base/hash.h"

namespace sunder::render {

BlockSides sides_of(const Mesh& mesh, const Box& box) {
  constexpr float kFarOff_m = 1e4f, kSquare = 0.9999f, kOnSide_m = 1e-4f;
  BlockSides sides{Vec3f::Constant(-kFarOff_m), Vec3f::Constant(kFarOff_m)};
  const Vec3f least = box.min.cast<float>(), most = box.max.cast<float>();
  for (const Mesh::Vertex& v : mesh.vertices) {
    if (v.look == Mesh::kInterior) continue;
    for (int axis = 0; axis < 3; ++axis) {
      const float at = v.position[axis], along = v.normal[axis];
      if (along < -kSquare && at < least[axis] + kOnSide_m) sides.low[axis] = least[axis];
      if (along > kSquare && at > most[axis] - kOnSide_m) sides.high[axis] = most[axis];
    }
  }
  return sides;
}

BlockTone tone_of(std::uint64_t body_key) {
  constexpr float kBrightness = 0.17f, kRedness = 0.07f;  // greatest deviations, up and down
  constexpr float kScorchedShare = 0.12f, kScorched = 0.74f;
  const std::uint64_t bits = mix(body_key + 1);
  const auto part = [&](int which) {
    return static_cast<float>((bits >> (16 * which)) & 0xffffu) * 0x1.0p-16f;
  };
  const float scorched = part(2) < kScorchedShare ? kScorched : 1;
  return {scorched * (1 + kBrightness * (2 * part(0) - 1)), kRedness * (2 * part(1) - 1)};
}

}  // namespace sunder::render
