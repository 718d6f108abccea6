// The structure `hall`: steel portal frames of I-sections, purlins, and loose slabs on these.
//
// Read first: HallBuilder::build(). Members are cut across into slices, so that each cross-section
// between slices is a plane of bonds, which may yield. The slabs are solids of their own, and load
// the purlins by contact alone.
#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/base/check.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

struct Hall {
  int bays = 3;
  double bay_m = 4;
  double span_m = 10;
  double height_m = 5;
  double depth_m = 0.2;
  double flange_m = 0.12;
  double plate_m = 0.015;
  int purlins = 6;
  double purlin_m = 0.06;
  double roof_m = 0.15;
  double block_m = 0.6;
  MaterialRef steel{"steel", {}};
  MaterialRef roof{"concrete", {}};
};

constexpr double kFootPlate = 0.04;  // m, thickness
constexpr double kGap = 0.02;        // m, between slabs, so that they do not jam as purlins sag
constexpr int kSlabs = 4;            // slabs along z in a bay

class HallBuilder {
 public:
  explicit HallBuilder(const Hall& hall) : hall_(hall) {}

  std::vector<Piece> build() {
    for (int frame = 0; frame <= hall_.bays; ++frame) add_frame(z_of(frame));
    for (int i = 0; i < hall_.purlins; ++i) add_purlin(x_of(i));
    std::vector<Piece> pieces = {{std::move(steel_), Vec3::Zero()}};
    if (hall_.roof_m > 0) add_roof(pieces);
    return pieces;
  }

 private:
  double z_of(int frame) const { return hall_.bay_m * (frame - 0.5 * hall_.bays); }
  double x_of(int purlin) const { return hall_.span_m * (purlin / (hall_.purlins - 1.0) - 0.5); }
  double on_girders() const { return hall_.height_m + hall_.depth_m; }

  void add(const Vec3& min, const Vec3& max, bool anchored = false) {
    steel_.push_back({make_box(min, max), hall_.steel.index, anchored});
  }

  /// Adds a slice of a member whose web is in the plane of its frame: two flanges, which face along
  /// the axis `across` (0 for a column, 1 for a girder), and the web between them.
  void add_slice(const Vec3& min, const Vec3& max, int across) {
    const double t = hall_.plate_m, middle = 0.5 * (min.z() + max.z());
    Vec3 inner_min = min, inner_max = max;
    inner_min[across] += t, inner_max[across] -= t;
    Vec3 low = max, high = min;
    low[across] = inner_min[across], high[across] = inner_max[across];
    add(min, low);
    add(high, max);
    inner_min.z() = middle - t / 2, inner_max.z() = middle + t / 2;
    add(inner_min, inner_max);
  }

  /// Adds a member along an axis, in slices of about block_m.
  void add_member(const Vec3& min, const Vec3& max, int along) {
    const double length = max[along] - min[along];
    const int count = std::max(1, static_cast<int>(std::lround(length / hall_.block_m)));
    const auto level = [&](int i) {
      return i == count ? max[along] : min[along] + length * i / count;
    };
    for (int i = 0; i < count; ++i) {
      Vec3 from = min, to = max;
      from[along] = level(i), to[along] = level(i + 1);
      add_slice(from, to, 1 - along);
    }
  }

  /// Adds two columns on anchored foot plates, and a girder on them.
  void add_frame(double z) {
    const double d = hall_.depth_m / 2, w = hall_.flange_m / 2, y = hall_.height_m;
    const double x = hall_.span_m / 2;
    for (const double at : {-x, x}) {
      add(Vec3(at - 1.5 * d, 0, z - 1.5 * w), Vec3(at + 1.5 * d, kFootPlate, z + 1.5 * w), true);
      add_member(Vec3(at - d, kFootPlate, z - w), Vec3(at + d, y, z + w), 1);
      add_slice(Vec3(at - d, y, z - w), Vec3(at + d, on_girders(), z + w), 1);
    }
    add_member(Vec3(-x + d, y, z - w), Vec3(x - d, on_girders(), z + w), 0);
  }

  /// Adds a bar over all frames, in blocks, one of which is centred on each frame.
  void add_purlin(double x) {
    const int blocks = std::max(2, static_cast<int>(std::lround(hall_.bay_m / hall_.block_m)));
    const double w = hall_.purlin_m / 2, y = on_girders();
    const auto level = [&](int i) { return z_of(0) + hall_.bay_m * (i - 0.5) / blocks; };
    for (int i = 0; i <= hall_.bays * blocks; ++i)
      add(Vec3(x - w, y, level(i)), Vec3(x + w, y + hall_.purlin_m, level(i + 1)));
  }

  /// Adds slabs from purlin to purlin, each a solid of its own.
  void add_roof(std::vector<Piece>& pieces) const {
    const double wide = hall_.span_m / (hall_.purlins - 1), deep = hall_.bay_m / kSlabs;
    const Vec3 half(0.5 * (wide - kGap), 0, 0.5 * (deep - kGap));
    const Part slab{make_box(-half, half + Vec3(0, hall_.roof_m, 0)), hall_.roof.index};
    for (int i = 0; i + 1 < hall_.purlins; ++i)
      for (int k = 0; k < hall_.bays * kSlabs; ++k)
        pieces.push_back({{slab},
                          Vec3(0.5 * (x_of(i) + x_of(i + 1)), on_girders() + hall_.purlin_m,
                               z_of(0) + deep * (k + 0.5))});
  }

  using Part = fracture::Part;

  const Hall& hall_;
  std::vector<Part> steel_;
};

std::vector<Piece> build_hall(const Hall& hall) {
  const auto require = [](bool holds, const char* what) {
    if (!holds) throw InputError(std::string("hall: ") + what);
  };
  require(hall.depth_m > 3 * hall.plate_m && hall.flange_m > 2 * hall.plate_m,
          "plate_m must be less than a third of depth_m and half of flange_m");
  require(hall.span_m > 4 * hall.depth_m, "span_m must exceed four times depth_m");
  return HallBuilder(hall).build();
}

}  // namespace

StructureType hall_structure() {
  const Range length{0.2, 100};
  return make_structure<Hall, build_hall>(
      "hall",
      "A hall of steel along z: portal frames on feet that the world holds, purlins, loose slabs.",
      {key<&Hall::bays>("bays", "", Range{1, 50}, "From frame to frame; one frame more."),
       key<&Hall::bay_m>("bay_m", "m", length, "From frame to frame."),
       key<&Hall::span_m>("span_m", "m", length, "Along x, from column to column."),
       key<&Hall::height_m>("height_m", "m", length, "Of the columns."),
       key<&Hall::depth_m>("depth_m", "m", Range{0.05, 5}, "Of columns and girders, I-sections."),
       key<&Hall::flange_m>("flange_m", "m", Range{0.02, 5}, "Width of their flanges."),
       key<&Hall::plate_m>("plate_m", "m", Range{0.002, 1}, "Thickness of their plates."),
       key<&Hall::purlins>("purlins", "", Range{2, 100}, "Bars on the girders, along z."),
       key<&Hall::purlin_m>("purlin_m", "m", Range{0.02, 2}, "Their edge; they are square."),
       key<&Hall::roof_m>("roof_m", "m", Range{0, 2},
                          "Thickness of the slabs that lie on them; 0 for none."),
       key<&Hall::block_m>("block_m", "m", Range{0.05, 100},
                           "Length of the slices that members are made of."),
       key<&Hall::steel>("steel", "What frames and purlins are made of."),
       key<&Hall::roof>("roof", "What the slabs are made of.")});
}

}  // namespace sunder::scenes
