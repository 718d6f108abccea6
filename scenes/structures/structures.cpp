// The list of structures, and the simple ones: box, stack, column, wheel and pane.
#include <array>
#include <cmath>
#include <cstdio>

#include "engine/base/check.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/hull.h"
#include "scenes/file/error_list.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

constexpr Range kLength{0.001, 1000};
constexpr double kTurn = 6.283185307179586;

struct BoxShape {
  Vec3 size_m = Vec3(1, 1, 1);
  double block_m = 1000;
  MaterialRef material{"concrete", {}};
};

std::vector<Piece> build_box(const BoxShape& box) {
  const Vec3 half(box.size_m.x() / 2, 0, box.size_m.z() / 2);
  Piece piece;
  add_blocks(piece.parts, -half, box.size_m - half, box.block_m, box.material.index);
  return {piece};
}

struct Stack {
  Vec3 size_m = Vec3(1, 1, 1);
  int count = 10;
  MaterialRef material{"concrete", {}};
};

std::vector<Piece> build_stack(const Stack& stack) {
  const Vec3 half(stack.size_m.x() / 2, 0, stack.size_m.z() / 2);
  std::vector<Piece> pieces;
  for (int i = 0; i < stack.count; ++i) {
    pieces.push_back({{{make_box(-half, stack.size_m - half), stack.material.index}},
                      Vec3(0, stack.size_m.y() * i, 0)});
  }
  return pieces;
}

struct Column {
  double radius_m = 0.25;
  double height_m = 3;
  int sides = 20;
  MaterialRef material{"concrete", {}};
};

std::vector<Piece> build_column(const Column& column) {
  std::vector<Vec2> rim;
  for (int i = 0; i < column.sides; ++i) {
    const SinCos turn = sin_cos(kTurn * i / column.sides);
    rim.emplace_back(column.radius_m * turn.sin, column.radius_m * turn.cos);
  }
  return {{{{make_prism(rim, 0, column.height_m, true), column.material.index}}, Vec3::Zero()}};
}

struct Wheel {
  double radius_m = 1;
  double hub_m = 0.2;
  double width_m = 0.3;
  int rings = 3;
  int sectors = 24;
  MaterialRef material{"concrete", {}};
  MaterialRef hub{"steel", {}};
};

/// Builds a wheel of wedges in rings about a hub.
std::vector<Piece> build_wheel(const Wheel& wheel) {
  if (wheel.hub_m >= wheel.radius_m) throw InputError("wheel: hub_m must be less than radius_m");
  const auto add_corners = [&](double radius_m, int sector, std::vector<Vec3>& corners) {
    const SinCos turn = sin_cos(kTurn * (sector % wheel.sectors) / wheel.sectors);
    for (const double z : {-wheel.width_m / 2, wheel.width_m / 2})
      corners.emplace_back(radius_m * turn.sin, wheel.radius_m + radius_m * turn.cos, z);
  };
  Piece piece;
  std::vector<Vec3> hub;
  for (int s = 0; s < wheel.sectors; ++s) add_corners(wheel.hub_m, s, hub);
  piece.parts.push_back({make_hull(hub), wheel.hub.index});
  const double ring_m = (wheel.radius_m - wheel.hub_m) / wheel.rings;
  for (int r = 0; r < wheel.rings; ++r) {
    for (int s = 0; s < wheel.sectors; ++s) {
      std::vector<Vec3> wedge;
      for (const int ring : {r, r + 1})
        for (const int side : {s, s + 1}) add_corners(wheel.hub_m + ring * ring_m, side, wedge);
      piece.parts.push_back({make_hull(wedge), wheel.material.index});
    }
  }
  return {piece};
}

struct Pane {
  double width_m = 3;
  double height_m = 2;
  double thickness_m = 0.02;
  double frame_m = 0.1;
  MaterialRef material{"glass", {}};
  MaterialRef frame{"steel", {}};
};

/// Builds a pane in a frame of four bars, bonded where they touch; the lowest bar is anchored.
std::vector<Piece> build_pane(const Pane& pane) {
  Piece piece;
  const double f = pane.frame_m, w = pane.width_m / 2, h = pane.height_m, t = pane.thickness_m / 2;
  piece.parts.push_back({make_box(Vec3(-w, f, -t), Vec3(w, f + h, t)), pane.material.index});
  if (f == 0) return {piece};
  const double deep = std::max(t, f / 2);
  const auto bar = [&](double x0, double y0, double x1, double y1) {
    const bool is_foot = y0 == 0;
    piece.parts.push_back(
        {make_box(Vec3(x0, y0, -deep), Vec3(x1, y1, deep)), pane.frame.index, is_foot});
  };
  bar(-w - f, 0, w + f, f);
  bar(-w - f, f + h, w + f, h + 2 * f);
  bar(-w - f, f, -w, f + h);
  bar(w, f, w + f, f + h);
  return {piece};
}

}  // namespace

void check_parts(double parts) {
  constexpr double kMaxParts = 200000;  // as the highest limits.bodies
  if (parts <= kMaxParts) return;
  char text[100];
  std::snprintf(text, sizeof text,
                "%.3g parts; allowed: at most %.0f; make them larger, or use fewer", parts,
                kMaxParts);
  throw InputError(text);
}

void check_parts(double parts, const Value& table) {
  try {
    check_parts(parts);
  } catch (const InputError& error) {
    throw InputError(table.where + ": " + error.what());
  }
}

void add_blocks(std::vector<fracture::Part>& parts, const Vec3& min, const Vec3& max,
                double longest_m, MaterialIndex material) {
  const Vec3 extent = max - min;
  std::array<int, 3> count;
  for (int a = 0; a < 3; ++a) {
    count[static_cast<std::size_t>(a)] =
        std::max(1, static_cast<int>(std::ceil(extent[a] / longest_m - 1e-9)));
  }
  check_parts(static_cast<double>(parts.size()) + double(count[0]) * count[1] * count[2]);
  // The outermost levels are exactly min and max, so that neighbouring boxes share planes.
  const auto level = [&](int axis, int i) {
    const int n = count[static_cast<std::size_t>(axis)];
    return i == n ? max[axis] : min[axis] + extent[axis] * i / n;
  };
  for (int x = 0; x < count[0]; ++x) {
    for (int y = 0; y < count[1]; ++y) {
      for (int z = 0; z < count[2]; ++z) {
        parts.push_back({make_box(Vec3(level(0, x), level(1, y), level(2, z)),
                                  Vec3(level(0, x + 1), level(1, y + 1), level(2, z + 1))),
                         material});
      }
    }
  }
}

StructureType box_structure() {
  return make_structure<BoxShape, build_box>(
      "box", "One box.",
      {key<&BoxShape::size_m>("size_m", "m", kLength, "Edge lengths."),
       key<&BoxShape::block_m>("block_m", "m", Range{0.05, 1000}, "Longest edge of its convexes."),
       key<&BoxShape::material>("material", "Material.")});
}

StructureType stack_structure() {
  return make_structure<Stack, build_stack>(
      "stack", "Boxes on top of each other, each a body.",
      {key<&Stack::size_m>("size_m", "m", kLength, "Edge lengths of one box."),
       key<&Stack::count>("count", "", Range{1, 1000}, "Number of boxes."),
       key<&Stack::material>("material", "Material.")});
}

StructureType column_structure() {
  return make_structure<Column, build_column>(
      "column", "An upright prism with the shading of a cylinder.",
      {key<&Column::radius_m>("radius_m", "m", kLength, "Radius."),
       key<&Column::height_m>("height_m", "m", kLength, "Height."),
       key<&Column::sides>("sides", "", Range{3, 64}, "Sides of the prism."),
       key<&Column::material>("material", "Material.")});
}

StructureType pane_structure() {
  return make_structure<Pane, build_pane>(
      "pane", "An upright pane facing z, in a frame whose foot is anchored.",
      {key<&Pane::width_m>("width_m", "m", kLength, "Width of the glass."),
       key<&Pane::height_m>("height_m", "m", kLength, "Height of the glass."),
       key<&Pane::thickness_m>("thickness_m", "m", kLength, "Thickness of the glass."),
       key<&Pane::frame_m>("frame_m", "m", Range{0, 10}, "Width of the frame; 0: no frame."),
       key<&Pane::material>("material", "Material of the pane."),
       key<&Pane::frame>("frame", "Material of the frame.")});
}

StructureType wheel_structure() {
  return make_structure<Wheel, build_wheel>(
      "wheel", "An upright disc facing z, made of wedges around a hub.",
      {key<&Wheel::radius_m>("radius_m", "m", kLength, "Radius."),
       key<&Wheel::hub_m>("hub_m", "m", kLength, "Radius of the hub."),
       key<&Wheel::width_m>("width_m", "m", kLength, "Width."),
       key<&Wheel::rings>("rings", "", Range{1, 30}, "Number of rings of wedges."),
       key<&Wheel::sectors>("sectors", "", Range{3, 64}, "Number of wedges in a ring."),
       key<&Wheel::material>("material", "Material of the wedges."),
       key<&Wheel::hub>("hub", "Material of the hub.")});
}

std::vector<Piece> read_structure(const Value& table, std::string_view name,
                                  const std::string& structure,
                                  std::initializer_list<std::span<const Key>> more,
                                  const BuildContext& context) {
  const StructureType& type = structures()[find_named(
      structures(), structure,
      find(table, "structure")->where + ": unknown structure '" + structure + "'")];
  const std::string full_name = std::string(name) + " " + structure;
  std::vector<Key> known;
  for (const std::span<const Key> keys : more) known.insert(known.end(), keys.begin(), keys.end());
  known.insert(known.end(), type.keys.begin(), type.keys.end());
  const std::shared_ptr<void> parameters = type.parameters();
  ErrorList errors;
  errors.collect([&] { check_known(table, full_name, {known}); });
  errors.collect(
      [&] { read_keys(table, full_name, type.keys, context.materials, parameters.get()); });
  errors.throw_any();
  return type.build(parameters.get(), table, context);
}

std::span<const StructureType> structures() {
  static const std::vector<StructureType> all = {
      arch_structure(),       arena_structure(),  box_structure(),      brick_wall_structure(),
      bridge_structure(),     column_structure(), compound_structure(), hall_structure(),
      house_structure(),      mesh_structure(),   pane_structure(),     prism_structure(),
      reinforced_structure(), stack_structure(),  temple_structure(),   terrain_structure(),
      wheel_structure()};
  return all;
}

}  // namespace sunder::scenes
