// Bodies that slide and roll over ground of several flush shapes, against the same on one shape.
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/model/facets.h"
#include "tests/fixtures/presets.h"
#include "tests/fixtures/threads.h"

namespace sunder::solver {
namespace {

using W = RigidWorld;

struct Floor {
  const char* name;
  std::function<void(PresetWorld&, double friction)> add;  ///< Its top is at height 0.
};

BodyDesc tile(double x0, double x1, double z0, double z1) {
  return W::box(Vec3(x1 - x0, 0.5, z1 - z0), Vec3(0.5 * (x0 + x1), -0.25, 0.5 * (z0 + z1)), 2000);
}

/// Returns a row of tiles along x, in rows along z.
std::vector<BodyDesc> tiles(double length_m, double width_m) {
  std::vector<BodyDesc> all;
  for (double x = -3; x < 14; x += length_m)
    for (double z = -3.05; z < 3; z += width_m)
      all.push_back(tile(x, x + length_m, z, z + width_m));
  return all;
}

void add_one(PresetWorld& world, double friction) {
  world.add(W::with_friction(W::fixed(tile(-10, 30, -10, 10)), friction));
}
void add_tiles(PresetWorld& world, double friction) {
  for (const BodyDesc& each : tiles(1, 6)) world.add(W::with_friction(W::fixed(each), friction));
}
void add_small_tiles(PresetWorld& world, double friction) {
  for (const BodyDesc& each : tiles(0.3, 0.35))
    world.add(W::with_friction(W::fixed(each), friction));
}
void add_compound(PresetWorld& world, double friction) {
  BodyDesc all = W::fixed(tile(0, 1, 0, 1));
  all.X_WB = {};
  all.shapes.clear();
  for (const BodyDesc& each : tiles(0.7, 1.3)) {
    const Vec3 half(0.35, 0.25, 0.65), middle = each.X_WB.position;
    ShapeDesc shape;
    shape.hull = W::keep(make_box(middle - half, middle + half));
    shape.tag = static_cast<std::uint32_t>(all.shapes.size());
    all.shapes.push_back(shape);
  }
  world.add(W::with_friction(all, friction));
}
/// Adds two-triangle meshes of which each is a ground of its own, and which share only places.
void add_meshes(PresetWorld& world, double friction) {
  for (double x = -3; x < 14; x += 1.7) {
    GroundMesh mesh;
    for (int i = 0; i < 5; ++i)
      for (int k = 0; k < 4; ++k) mesh.vertices_W.emplace_back(x + 0.425 * i, 0, -3.05 + 2 * k);
    for (std::uint32_t i = 0; i < 4; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        const std::uint32_t at = 4 * i + k;
        mesh.triangles.push_back({at, at + 1, at + 5});
        mesh.triangles.push_back({at, at + 5, at + 4});
      }
    }
    BodyDesc body;
    body.is_static = true;
    for (const Facet& facet : make_facets(mesh)) {
      ShapeDesc shape;
      shape.hull = W::keep(facet.prism);
      shape.bends = facet.bends;
      shape.tag = static_cast<std::uint32_t>(body.shapes.size());
      body.shapes.push_back(shape);
    }
    world.add(W::with_friction(body, friction));
  }
}
/// Adds loose pieces that lie side by side, as those of a broken floor do.
void add_pieces(PresetWorld& world, double friction) {
  BodyDesc ground = W::ground();
  ground.X_WB.position.y() = -0.5;
  world.add(W::with_friction(ground, 0.8));
  for (const BodyDesc& each : tiles(1, 2)) world.add(W::with_friction(each, friction));
}

const Floor kFloors[] = {{"tiles", add_tiles},
                         {"small tiles", add_small_tiles},
                         {"a compound", add_compound},
                         {"meshes", add_meshes},
                         {"loose pieces", add_pieces}};

struct Slider {
  std::string name;
  bool ball;
  double size_m, yaw, speed_m_s, friction;
};

struct Slid {
  Vec3 way_m;
  double highest_m = 0, turned = 0;
};

Slid slide(const Preset& preset, const Floor& floor, const Slider& slider, double phase) {
  PresetWorld world(preset);
  floor.add(world, slider.friction);
  const Vec3 start(-1.1 + phase, 0.5 * slider.size_m, 0.03);
  BodyDesc desc = slider.ball ? W::sphere(0.5 * slider.size_m, start, 2000)
                              : W::box(Vec3::Constant(slider.size_m), start, 2000);
  desc.X_WB.rotation = Quat(Eigen::AngleAxisd(slider.yaw, Vec3::UnitY()));
  const BodyId id =
      world.add(W::moving(W::with_friction(desc, slider.friction), Vec3(slider.speed_m_s, 0, 0)));
  Slid slid;
  world.watch(1.2, [&] {
    const Pose& X = world.state(id).X_WB;
    slid.highest_m = std::max(slid.highest_m, X.position.y() - start.y());
    slid.turned = std::max(slid.turned, 1 - (X.rotation * Vec3::UnitY()).y());
  });
  slid.way_m = world.state(id).X_WB.position - start;
  return slid;
}

std::vector<Slider> sliders() {
  return {{"box", false, 0.4, 0, 4, 0.5},
          {"slow box", false, 0.4, 0.5, 0.7, 0.5},
          {"turned box", false, 0.3, 0.8, 8, 0.5},
          {"smooth box", false, 0.2, 0.3, 3, 0},
          {"ball", true, 0.4, 0, 5, 0},
          {"rough ball", true, 0.15, 0, 2, 0.5}};
}

TEST(Seams, WhatSlidesOrRollsOverThemGoesAsFarAsOnOneShape) {
  for (const Preset& preset : kPresets) {
    for (const Slider& slider : sliders()) {
      for (const double phase : {0., 0.137}) {
        const Slid on = slide(preset, {"one", add_one}, slider, phase);
        for (const Floor& floor : kFloors) {
          const Slid over = slide(preset, floor, slider, phase);
          const std::string text = std::string(preset.name) + ": " + slider.name + " over " +
                                   floor.name + ", phase " + std::to_string(phase);
          // Friction of several contacts that share a load is not exactly along the motion.
          const double error_m = 0.03 * on.way_m.x() + 0.005 * slider.size_m;
          EXPECT_NEAR(over.way_m.x(), on.way_m.x(), error_m) << text;
          EXPECT_LT(std::abs(over.way_m.z()), error_m) << text;
          EXPECT_LT(over.highest_m, on.highest_m + 0.01 * slider.size_m) << text;
          if (!slider.ball) {
            EXPECT_LT(over.turned, on.turned + 1e-3) << text;
          }
        }
      }
    }
  }
}

/// Returns the way in 0.8 s of a box of 0.4 m at 4 m/s without friction, from x = -0.5.
double way_m(const Preset& preset, const std::vector<BodyDesc>& ground) {
  PresetWorld world(preset);
  for (const BodyDesc& each : ground) world.add(W::with_friction(W::fixed(each), 0));
  const BodyId id = world.add(W::moving(
      W::with_friction(W::box(Vec3::Constant(0.4), Vec3(-0.5, 0.2, 0)), 0), Vec3(4, 0, 0)));
  world.run(0.8);
  return world.state(id).X_WB.position.x() + 0.5;
}

TEST(Seams, AStepOfTheGroundStopsWhatSlides) {
  for (const Preset& preset : kPresets) {
    BodyDesc before = tile(-3, 0, -2, 2), step = tile(0, 3, -2, 2), wall = step;
    step.X_WB.position.y() += 0.1, wall.X_WB.position.y() += 0.5;
    // The wall stands on the ground behind it, or takes its place; a box that strikes it may tip.
    for (const std::vector<BodyDesc>& ground :
         {std::vector{before, step}, {before, wall}, {before, tile(0, 3, -2, 2), wall}}) {
      const double stopped_m = way_m(preset, ground);
      EXPECT_LT(stopped_m, 0.31) << preset.name;
      EXPECT_GT(stopped_m, 0.1) << preset.name;
    }
  }
}

TEST(Seams, AGapOfTheGroundStopsABallThatFallsIntoIt) {
  for (const Preset& preset : kPresets) {
    PresetWorld world(preset);
    world.add(W::fixed(tile(-3, 0, -2, 2))), world.add(W::fixed(tile(0.5, 3, -2, 2)));
    const BodyId id = world.add(W::moving(W::sphere(0.2, Vec3(-0.5, 0.2, 0)), Vec3(1, 0, 0)));
    world.run(1.5);
    EXPECT_LT(world.state(id).X_WB.position.y(), -0.5) << preset.name;
    EXPECT_LT(world.state(id).X_WB.position.x(), 0.5) << preset.name;
  }
}

TEST(Seams, GiveTheSameBitsForAnyNumberOfThreads) {
  expect_same_for_any_threads([&] {
    PresetWorld world(kPresets[1]);
    add_compound(world, 0.4);
    for (int i = 0; i < 24; ++i)
      world.add(W::moving(W::box(Vec3(0.3, 0.2, 0.4), Vec3(0.5 * i - 1, 0.1, 0.1 * (i % 5))),
                          Vec3(3, 0, 1 - 0.5 * (i % 4))));
    world.run(1);
    return world.hash();
  });
}

}  // namespace
}  // namespace sunder::solver
