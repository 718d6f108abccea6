// The structure `house`: brick walls between concrete columns, floors and a roof; one compound.
//
// Read first: HouseBuilder::build(). Walls are cut into boxes around their openings; boxes that
// touch share a plane and are bonded.
#include <algorithm>
#include <string>

#include "engine/base/check.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

struct House {
  double width_m = 8;
  double depth_m = 6;
  int storeys = 2;
  double storey_m = 2.8;
  double wall_m = 0.3;
  double slab_m = 0.25;
  double overhang_m = 0.4;
  double column_m = 0.4;
  int windows = 2;
  double window_m = 1.3;
  double block_m = 1.6;
  bool inner_wall = true;
  MaterialRef wall{"brick", {}};
  MaterialRef frame{"concrete", {}};
};

constexpr double kSill = 0.9;        // m, height of a window's lower edge
constexpr double kWindowTop = 2.15;  // m, height of the upper edge of windows and doors
constexpr double kLintel = 0.2;      // m, height
constexpr double kDoor = 1.1;        // m, width

/// A hole in a wall: [left, right] along the wall, from `bottom` above the floor to kWindowTop.
struct Opening {
  double left, right, bottom;
};

/// One wall of one storey; u is the coordinate along the wall.
struct Wall {
  bool along_x;
  double u0, u1;            // ends
  double across0, across1;  // faces
  double y0, y1;
};

class HouseBuilder {
 public:
  explicit HouseBuilder(const House& house) : house_(house) {}

  std::vector<fracture::Part> build() {
    double y = 0;
    for (int storey = 0; storey < house_.storeys; ++storey) {
      add_storey(y, storey == 0);
      y += house_.storey_m;
      const bool roof = storey == house_.storeys - 1;
      const double out = roof ? house_.overhang_m : 0;
      add(Vec3(-w() - out, y, -d() - out), Vec3(w() + out, y + house_.slab_m, d() + out),
          house_.frame);
      y += house_.slab_m;
    }
    return std::move(parts_);
  }

 private:
  double w() const { return house_.width_m / 2; }
  double d() const { return house_.depth_m / 2; }

  void add(const Vec3& min, const Vec3& max, const MaterialRef& material) {
    add_blocks(parts_, min, max, house_.block_m, material.index);
  }

  void add_storey(double y0, bool ground_floor) {
    const double y1 = y0 + house_.storey_m, c = house_.column_m, t = house_.wall_m;
    for (const double x : {-w(), w() - c}) {
      for (const double z : {-d(), d() - c}) {
        add(Vec3(x, y0, z), Vec3(x + c, y1, z + c), house_.frame);
      }
    }
    const Wall front{true, -w() + c, w() - c, d() - t, d(), y0, y1};
    add_wall(front, openings(front, house_.windows, ground_floor));
    const Wall back{true, -w() + c, w() - c, -d(), -d() + t, y0, y1};
    add_wall(back, openings(back, house_.windows, false));
    const int side_windows = std::max(0, house_.windows - 1);
    for (const double x : {-w(), w() - t}) {
      const Wall side{false, -d() + c, d() - c, x, x + t, y0, y1};
      add_wall(side, openings(side, side_windows, false));
    }
    if (house_.inner_wall) {
      const double beside_door = kDoor / 2 + 0.3;
      const Wall inner{false, -d() + t, d() - t, beside_door, beside_door + t / 2, y0, y1};
      add_wall(inner, {{-kDoor / 2, kDoor / 2, 0}});
    }
  }

  /// Returns evenly spaced windows; with a door, the middle opening is one.
  std::vector<Opening> openings(const Wall& wall, int windows, bool with_door) const {
    const int count = windows + (with_door ? 1 : 0);
    std::vector<Opening> all;
    for (int i = 0; i < count; ++i) {
      const bool door = with_door && i == count / 2;
      const double middle = wall.u0 + (wall.u1 - wall.u0) * (2 * i + 1) / (2 * count);
      const double half = (door ? kDoor : house_.window_m) / 2;
      all.push_back({middle - half, middle + half, door ? 0 : kSill});
    }
    return all;
  }

  /// Adds strips of full height between the openings, and strips under and over each opening.
  void add_wall(const Wall& wall, const std::vector<Opening>& openings) {
    double u = wall.u0;
    for (const Opening& opening : openings) {
      add_strip(wall, u, opening.left, wall.y0, wall.y1, house_.wall);
      const double sill = wall.y0 + opening.bottom, top = wall.y0 + kWindowTop;
      if (opening.bottom > 0) {
        add_strip(wall, opening.left, opening.right, wall.y0, sill, house_.wall);
      }
      add_strip(wall, opening.left, opening.right, top, top + kLintel, house_.frame);
      add_strip(wall, opening.left, opening.right, top + kLintel, wall.y1, house_.wall);
      u = opening.right;
    }
    add_strip(wall, u, wall.u1, wall.y0, wall.y1, house_.wall);
  }

  void add_strip(const Wall& wall, double u0, double u1, double y0, double y1,
                 const MaterialRef& material) {
    if (wall.along_x) {
      add(Vec3(u0, y0, wall.across0), Vec3(u1, y1, wall.across1), material);
    } else {
      add(Vec3(wall.across0, y0, u0), Vec3(wall.across1, y1, u1), material);
    }
  }

  const House& house_;
  std::vector<fracture::Part> parts_;
};

void check_sizes(const House& house) {
  const auto require = [](bool holds, const std::string& what) {
    if (!holds) throw InputError("house: " + what);
  };
  const double clear = std::min(house.width_m, house.depth_m) - 2 * house.column_m;
  require(house.wall_m <= house.column_m, "wall_m must not exceed column_m");
  require(clear > kDoor + 0.2, "width_m and depth_m leave no room for a door between the columns");
  require(house.storey_m > kWindowTop + kLintel + 0.05, "storey_m must exceed 2.4");
  const double front = (house.width_m - 2 * house.column_m) / (house.windows + 1);
  const double side = (house.depth_m - 2 * house.column_m) / std::max(1, house.windows - 1);
  require(std::min(front, side) > house.window_m + 0.1,
          "windows of window_m do not fit side by side; take fewer, or a larger house");
}

std::vector<Piece> build_house(const House& house) {
  check_sizes(house);
  return {{HouseBuilder(house).build(), Vec3::Zero()}};
}

}  // namespace

StructureType house_structure() {
  const Range thickness{0.05, 5};
  return make_structure<House, build_house>(
      "house",
      "A house with windows, a door, floors and a flat roof; one compound, its front at +z.",
      {key<&House::width_m>("width_m", "m", Range{3, 200}, "Along x."),
       key<&House::depth_m>("depth_m", "m", Range{3, 200}, "Along z."),
       key<&House::storeys>("storeys", "", Range{1, 50}, "Storeys."),
       key<&House::storey_m>("storey_m", "m", Range{2, 10}, "Clear height of a storey."),
       key<&House::wall_m>("wall_m", "m", thickness, "Thickness of the outer walls."),
       key<&House::slab_m>("slab_m", "m", thickness, "Thickness of floors and roof."),
       key<&House::overhang_m>("overhang_m", "m", Range{0, 5}, "How far the roof stands out."),
       key<&House::column_m>("column_m", "m", thickness, "Edge of the corner columns."),
       key<&House::windows>("windows", "", Range{0, 50},
                            "In front and back of each storey; one fewer at the sides."),
       key<&House::window_m>("window_m", "m", Range{0.2, 10}, "Width of a window."),
       key<&House::block_m>("block_m", "m", Range{0.2, 100},
                            "Longest edge of the convexes it is made of."),
       key<&House::inner_wall>("inner_wall", "Whether a wall along z divides each storey."),
       key<&House::wall>("wall", "What the walls are made of."),
       key<&House::frame>("frame", "What columns, lintels, floors and roof are made of.")});
}

}  // namespace sunder::scenes
