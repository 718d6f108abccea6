// The structure `temple`: steps, columns of drums on all sides, beams on them, a ceiling and a
// gabled roof; one compound.
//
// Read first: TempleBuilder::build(), which goes from the ground up.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

struct Temple {
  int columns_x = 6;
  int columns_z = 4;
  double spacing_m = 2;
  double radius_m = 0.32;
  double height_m = 4;
  int drums = 3;
  int steps = 3;
  double rise_m = 1.3;
  double block_m = 2;
  MaterialRef stone{"marble", {}};
};

constexpr double kStep = 0.2;      // m, height and depth of a step
constexpr double kCapital = 0.2;   // m, height
constexpr double kBeam = 0.5;      // m, height
constexpr double kCeiling = 0.25;  // m, thickness
constexpr double kEaves = 0.3;     // m, overhang of the roof
constexpr int kSides = 16;

class TempleBuilder {
 public:
  explicit TempleBuilder(const Temple& temple)
      : temple_(temple),
        x_((temple.columns_x - 1) * temple.spacing_m / 2),
        z_((temple.columns_z - 1) * temple.spacing_m / 2),
        half_(1.25 * temple.radius_m) {}

  std::vector<fracture::Part> build() {
    double y = 0;
    for (int step = temple_.steps; step > 0; --step, y += kStep) {
      const double out = half_ + kStep * step;
      add(-x_ - out, y, -z_ - out, x_ + out, y + kStep, z_ + out);
    }
    for (int i = 0; i < temple_.columns_x; ++i) {
      for (int k = 0; k < temple_.columns_z; ++k) {
        const bool edge =
            i == 0 || k == 0 || i == temple_.columns_x - 1 || k == temple_.columns_z - 1;
        if (edge) add_column(i * temple_.spacing_m - x_, y, k * temple_.spacing_m - z_);
      }
    }
    y += temple_.height_m;
    add_beams(y);
    y += kBeam;
    const double out = half_ + kEaves;
    add(-x_ - out, y, -z_ - out, x_ + out, y + kCeiling, z_ + out);
    add_roof(y + kCeiling, x_ + out, z_ + out);
    return std::move(parts_);
  }

 private:
  void add(double x0, double y0, double z0, double x1, double y1, double z1) {
    add_blocks(parts_, Vec3(x0, y0, z0), Vec3(x1, y1, z1), temple_.block_m, temple_.stone.index);
  }

  void add_column(double x, double y, double z) {
    std::vector<Vec2> rim;
    for (int i = 0; i < kSides; ++i) {
      const SinCos turn = sin_cos(2 * std::numbers::pi * i / kSides);
      rim.emplace_back(x + temple_.radius_m * turn.sin, z + temple_.radius_m * turn.cos);
    }
    const double shaft = temple_.height_m - kCapital;
    for (int i = 0; i < temple_.drums; ++i) {
      parts_.push_back({make_prism(rim, y + shaft * i / temple_.drums,
                                   y + shaft * (i + 1) / temple_.drums, true),
                        temple_.stone.index});
    }
    add(x - half_, y + shaft, z - half_, x + half_, y + temple_.height_m, z + half_);
  }

  /// Adds beams from column axis to column axis; the outermost extend over the corners.
  void add_beams(double y) {
    for (const double z : {-z_, z_}) {
      for (int i = 0; i + 1 < temple_.columns_x; ++i) {
        const double from = i == 0 ? -x_ - half_ : i * temple_.spacing_m - x_;
        const double to =
            i + 2 == temple_.columns_x ? x_ + half_ : (i + 1) * temple_.spacing_m - x_;
        add(from, y, z - half_, to, y + kBeam, z + half_);
      }
    }
    for (const double x : {-x_, x_}) {
      for (int k = 0; k + 1 < temple_.columns_z; ++k) {
        const double from = k == 0 ? -z_ + half_ : k * temple_.spacing_m - z_;
        const double to =
            k + 2 == temple_.columns_z ? z_ - half_ : (k + 1) * temple_.spacing_m - z_;
        add(x - half_, y, from, x + half_, y + kBeam, to);
      }
    }
  }

  /// Adds a roof with its ridge along x; each side is cut across the ridge, and once along it.
  void add_roof(double y, double x, double z) {
    const int cuts = std::max(1, static_cast<int>(std::ceil(2 * x / temple_.block_m)));
    const double middle = y + temple_.rise_m / 2, ridge = y + temple_.rise_m;
    for (int i = 0; i < cuts; ++i) {
      const double from = -x + 2 * x * i / cuts, to = -x + 2 * x * (i + 1) / cuts;
      for (const double side : {-1.0, 1.0}) {
        add_prism(from, to, {{side * z, y}, {side * z / 2, y}, {side * z / 2, middle}});
        add_prism(from, to, {{side * z / 2, y}, {side * z / 2, middle}, {0, ridge}, {0, y}});
      }
    }
  }

  /// Adds a polygon of (z, y), extruded from one x to another.
  void add_prism(double from, double to, const std::vector<Vec2>& corners) {
    std::vector<Vec3> points;
    for (const double x : {from, to}) {
      for (const Vec2& corner : corners) points.emplace_back(x, corner.y(), corner.x());
    }
    parts_.push_back({make_hull(points), temple_.stone.index});
  }

  const Temple& temple_;
  const double x_, z_;  // coordinates of the outermost column axes
  const double half_;   // half the width of beams and capitals
  std::vector<fracture::Part> parts_;
};

std::vector<Piece> build_temple(const Temple& temple) {
  return {{TempleBuilder(temple).build(), Vec3::Zero()}};
}

}  // namespace

StructureType temple_structure() {
  return make_structure<Temple, build_temple>(
      "temple", "A temple with columns of drums all round under a gabled roof, its front at +z.",
      {key<&Temple::columns_x>("columns_x", "", Range{2, 40}, "Columns in front and back."),
       key<&Temple::columns_z>("columns_z", "", Range{2, 40}, "Columns at the sides."),
       key<&Temple::spacing_m>("spacing_m", "m", Range{1, 10}, "From column to column."),
       key<&Temple::radius_m>("radius_m", "m", Range{0.1, 0.38}, "Of a column."),
       key<&Temple::height_m>("height_m", "m", Range{1, 20}, "Of a column."),
       key<&Temple::drums>("drums", "", Range{1, 20}, "Drums of a column."),
       key<&Temple::steps>("steps", "", Range{1, 20}, "Steps all round."),
       key<&Temple::rise_m>("rise_m", "m", Range{0.1, 10}, "Height of the gable."),
       key<&Temple::block_m>("block_m", "m", Range{0.2, 100},
                             "Longest edge of what steps and roof are made of."),
       key<&Temple::stone>("stone", "What it is made of.")});
}

}  // namespace sunder::scenes
