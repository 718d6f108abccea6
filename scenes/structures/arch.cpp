// The structures that are extruded along z: `arch`, and `prism` with any convex outline.
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

struct Arch {
  double span_m = 3;
  double ring_m = 0.4;
  double depth_m = 0.5;
  int voussoirs = 11;
  double block_m = 1000;
  MaterialRef material{"stone", {}};
};

/// Builds a ring of voussoirs; its feet are exactly at y = 0.
std::vector<Piece> build_arch(const Arch& arch) {
  const auto at = [&](double radius_m, int joint) -> Vec2 {
    if (joint == 0) return {radius_m, 0};
    if (joint == arch.voussoirs) return {-radius_m, 0};
    const SinCos angle = sin_cos(std::numbers::pi * joint / arch.voussoirs);
    return {radius_m * angle.cos, radius_m * angle.sin};
  };
  const double inner_m = arch.span_m / 2, outer_m = inner_m + arch.ring_m;
  Piece piece;
  for (int i = 0; i < arch.voussoirs; ++i) {
    const std::array corners = {at(inner_m, i), at(inner_m, i + 1), at(outer_m, i),
                                at(outer_m, i + 1)};
    add_slices(piece.parts, corners, arch.depth_m, arch.block_m, arch.material.index);
  }
  return {piece};
}

struct Prism {
  std::vector<Vec2> outline_m;
  double depth_m = 1;
  double block_m = 1000;
  MaterialRef material{"concrete", {}};
};

std::vector<Piece> build_prism(const Prism& prism) {
  Piece piece;
  add_slices(piece.parts, prism.outline_m, prism.depth_m, prism.block_m, prism.material.index);
  // make_hull() keeps all corners at both ends only if the outline is convex.
  if (piece.parts[0].polyhedron.vertices.size() != 2 * prism.outline_m.size()) {
    throw InputError(
        "prism: outline_m is not convex, or has a corner twice or within a side; allowed: the "
        "corners of a convex polygon, in any order. Split it into parts of a compound");
  }
  return {piece};
}

}  // namespace

void add_slices(std::vector<fracture::Part>& parts, std::span<const Vec2> corners, double depth_m,
                double longest_m, MaterialIndex material) {
  const double slices = std::max(1.0, std::ceil(depth_m / longest_m - 1e-9));
  check_parts(static_cast<double>(parts.size()) + slices);
  for (int k = 0; k < static_cast<int>(slices); ++k) {
    std::vector<Vec3> points;
    for (const int end : {k, k + 1}) {
      const double z = depth_m * (end / slices - 0.5);
      for (const Vec2& corner : corners) points.emplace_back(corner.x(), corner.y(), z);
    }
    parts.push_back({make_hull(points), material});
  }
}

StructureType arch_structure() {
  const Range length{0.01, 1000};
  return make_structure<Arch, build_arch>(
      "arch", "A round arch of voussoirs along x, on its two feet.",
      {key<&Arch::span_m>("span_m", "m", length, "Clear width."),
       key<&Arch::ring_m>("ring_m", "m", length, "Thickness of the ring; each foot is as wide."),
       key<&Arch::depth_m>("depth_m", "m", length, "Along z."),
       key<&Arch::voussoirs>("voussoirs", "", Range{3, 101}, "Stones of the ring."),
       key<&Arch::block_m>("block_m", "m", Range{0.05, 1000}, "Most depth of a stone."),
       key<&Arch::material>("material", "What it is made of.")});
}

StructureType prism_structure() {
  const Range length{0.001, 1000};
  return make_structure<Prism, build_prism>(
      "prism", "A convex outline in x and y, as it is given, drawn out along z to both sides.",
      {key<&Prism::outline_m>("outline_m", "m", Range{-1000, 1000}, "Its corners.").must(),
       key<&Prism::depth_m>("depth_m", "m", length, "Along z."),
       key<&Prism::block_m>("block_m", "m", Range{0.05, 1000},
                            "Most depth of the slices it is made of."),
       key<&Prism::material>("material", "What it is made of.")});
}

}  // namespace sunder::scenes
