// The structure `brick_wall`: a dry wall in running bond; every brick is a body of its own.
#include "engine/base/random.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

struct BrickWall {
  Vec3 brick_m = Vec3(0.4, 0.2, 0.2);
  int bricks = 25;
  int courses = 20;
  MaterialRef material{"clay", {}};
  MaterialRef second{"clay", {}};
  double second_share = 0;
};

/// Builds the wall. Each course has full bricks and one half brick, which is alternately at the
/// right and at the left end, so that all courses are equally long and no joint is over another.
std::vector<Piece> build_brick_wall(const BrickWall& wall) {
  check_parts(double(wall.bricks) * wall.courses);
  const Vec3& brick = wall.brick_m;
  const double length = (wall.bricks - 0.5) * brick.x();
  std::vector<Piece> pieces;
  Random random(1);
  for (int course = 0; course < wall.courses; ++course) {
    const bool half_first = course % 2 == 1;
    for (int i = 0; i < wall.bricks; ++i) {
      const bool half = half_first ? i == 0 : i == wall.bricks - 1;
      const double wide = half ? brick.x() / 2 : brick.x();
      const double left = -length / 2 + (half_first && i > 0 ? i - 0.5 : i) * brick.x();
      const Vec3 corner(wide / 2, 0, brick.z() / 2);
      const MaterialRef& material =
          random.uniform() < wall.second_share ? wall.second : wall.material;
      pieces.push_back(
          {{{make_box(-corner, Vec3(wide, brick.y(), brick.z()) - corner), material.index}},
           Vec3(left + wide / 2, course * brick.y(), 0)});
    }
  }
  return pieces;
}

}  // namespace

StructureType brick_wall_structure() {
  return make_structure<BrickWall, build_brick_wall>(
      "brick_wall", "A dry wall along x in running bond; every brick is a body.",
      {key<&BrickWall::brick_m>("brick_m", "m", Range{0.01, 10}, "Edge lengths of a brick."),
       key<&BrickWall::bricks>("bricks", "", Range{2, 1000},
                               "Bricks in a course, one of them a half."),
       key<&BrickWall::courses>("courses", "", Range{1, 1000}, "Courses."),
       key<&BrickWall::material>("material", "What the bricks are made of."),
       key<&BrickWall::second>("second", "What some bricks are made of instead."),
       key<&BrickWall::second_share>("second_share", "", Range{0, 1}, "How many of them.")});
}

}  // namespace sunder::scenes
