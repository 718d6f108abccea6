// The structure `bridge`: a stone bridge of round arches between two abutments; one compound.
//
// Read first: BridgeBuilder::build(). An arch is a ring of voussoirs. Over each voussoir, a block
// extends up to the deck, so that all parts meet face to face.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/check.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

struct Bridge {
  int spans = 2;
  double span_m = 6;
  double ring_m = 0.5;
  int voussoirs = 13;
  double pier_m = 2.5;
  double width_m = 2.4;
  double deck_m = 0.3;
  double abutment_m = 1.5;
  double block_m = 1.3;
  MaterialRef stone{"stone", {}};
  MaterialRef deck{"stone", {}};
};

constexpr double kCover = 0.15;  // m, thickness of the stone between the crown and the deck

class BridgeBuilder {
 public:
  explicit BridgeBuilder(const Bridge& bridge)
      : bridge_(bridge),
        outer_m_(bridge.span_m / 2 + bridge.ring_m),
        top_m_(bridge.pier_m + outer_m_ + kCover),
        slices_(std::max(1, static_cast<int>(std::ceil(bridge.width_m / bridge.block_m)))) {}

  std::vector<fracture::Part> build() {
    const double half = bridge_.spans * outer_m_, end = half + bridge_.abutment_m;
    for (int i = 0; i < bridge_.spans; ++i) add_arch((2 * i + 1) * outer_m_ - half);
    for (int i = 1; i < bridge_.spans; ++i) add_pier(2 * i * outer_m_ - half);
    // The bearing of an arch at an abutment is half as wide as a pier.
    for (const double side : {-1.0, 1.0}) {
      const double face = side * half, back = side * end, ring = face - side * bridge_.ring_m;
      add_box(std::min(face, back), std::max(face, back), 0, top_m_);
      add_box(std::min(face, ring), std::max(face, ring), 0, bridge_.pier_m);
    }
    add_blocks(parts_, Vec3(-end, top_m_, -bridge_.width_m / 2),
               Vec3(end, top_m_ + bridge_.deck_m, bridge_.width_m / 2), bridge_.block_m,
               bridge_.deck.index);
    return std::move(parts_);
  }

 private:
  void add_box(double x0, double x1, double y0, double y1) {
    add_blocks(parts_, Vec3(x0, y0, -bridge_.width_m / 2), Vec3(x1, y1, bridge_.width_m / 2),
               bridge_.block_m, bridge_.stone.index);
  }

  void add_pier(double x) { add_box(x - bridge_.ring_m, x + bridge_.ring_m, 0, bridge_.pier_m); }

  /// Adds a quadrangle in the plane of the arch, extruded over the whole width in slices.
  void add_prism(const std::array<Vec2, 4>& corners) {
    for (int k = 0; k < slices_; ++k) {
      std::vector<Vec3> points;
      for (const int end : {k, k + 1}) {
        const double z = bridge_.width_m * (static_cast<double>(end) / slices_ - 0.5);
        for (const Vec2& corner : corners) points.emplace_back(corner.x(), corner.y(), z);
      }
      parts_.push_back({make_hull(points), bridge_.stone.index});
    }
  }

  void add_arch(double middle) {
    const auto at = [&](double radius, int joint) -> Vec2 {
      const SinCos angle = sin_cos(std::numbers::pi * joint / bridge_.voussoirs);
      // The feet are exactly level, and exactly beside those of the next arch.
      const bool foot = joint == 0 || joint == bridge_.voussoirs;
      const double x = foot ? (joint == 0 ? radius : -radius) : radius * angle.cos;
      return {middle + x, bridge_.pier_m + (foot ? 0 : radius * angle.sin)};
    };
    for (int i = 0; i < bridge_.voussoirs; ++i) {
      const double inner = bridge_.span_m / 2;
      const Vec2 a = at(outer_m_, i), b = at(outer_m_, i + 1);
      add_prism({at(inner, i), at(inner, i + 1), a, b});
      add_prism({a, b, Vec2(a.x(), top_m_), Vec2(b.x(), top_m_)});
    }
  }

  const Bridge& bridge_;
  const double outer_m_, top_m_;
  const int slices_;
  std::vector<fracture::Part> parts_;
};

std::vector<Piece> build_bridge(const Bridge& bridge) {
  if (bridge.ring_m > bridge.span_m / 2) {
    throw InputError("bridge: ring_m must not exceed half of span_m");
  }
  return {{BridgeBuilder(bridge).build(), Vec3::Zero()}};
}

}  // namespace

StructureType bridge_structure() {
  const Range length{0.2, 100};
  return make_structure<Bridge, build_bridge>(
      "bridge", "A stone bridge of round arches along x, on piers between two abutments.",
      {key<&Bridge::spans>("spans", "", Range{1, 20}, "Arches."),
       key<&Bridge::span_m>("span_m", "m", length, "Clear width of an arch."),
       key<&Bridge::ring_m>("ring_m", "m", length, "Thickness of an arch; a pier is twice that."),
       key<&Bridge::voussoirs>("voussoirs", "", Range{3, 101}, "Stones of an arch."),
       key<&Bridge::pier_m>("pier_m", "m", length, "Height of the piers."),
       key<&Bridge::width_m>("width_m", "m", length, "Along z."),
       key<&Bridge::deck_m>("deck_m", "m", Range{0.05, 10}, "Thickness of the deck."),
       key<&Bridge::abutment_m>("abutment_m", "m", length, "Length of the ends."),
       key<&Bridge::block_m>("block_m", "m", Range{0.2, 100},
                             "Longest edge of the boxes that it is made of."),
       key<&Bridge::stone>("stone", "What arches, piers and ends are made of."),
       key<&Bridge::deck>("deck", "What the deck is made of.")});
}

}  // namespace sunder::scenes
