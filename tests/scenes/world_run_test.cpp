// A program that acts on a running world and asks it.
#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>
#include <limits>
#include <set>
#include <span>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/random.h"
#include "engine/io/state_hash.h"
#include "engine/world/simulation.h"
#include "engine/world/world.h"
#include "scenes/file/make_compound.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

constexpr double kFrame_s = 1.0 / 60;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Scene empty_scene() {
  Scene scene;
  scene.materials = builtin_materials();
  return scene;
}

MaterialIndex material(const char* name) { return material_named(empty_scene(), name); }

Solid box(const Vec3& size_m, const Vec3& center_W, const char* of = "steel",
          bool anchored = false) {
  Part part;
  part.polyhedron = make_box(-0.5 * size_m, 0.5 * size_m);
  part.material = material(of);
  part.anchored = anchored ? 1 : 0;
  Solid solid;
  solid.compound = make_compound({part});
  solid.X_WR.position = center_W;
  return solid;
}

Ball ball(const Vec3& center_W, const Vec3& velocity_W = Vec3::Zero(), double radius_m = 0.25) {
  return {"", radius_m, material("steel"), center_W, velocity_W};
}

void run(World& world, double time_s) {
  for (double left_s = time_s; left_s > 1e-9; left_s -= kFrame_s) world.step(kFrame_s);
}

std::uint64_t hash_of(World& world) { return hash_state(*world.frame()); }

TEST(World, StepsOfAFrameAreTheSimulationOfItsScene) {
  const Scene scene = load_scene("brick_wall");
  const auto simulation = make_simulation(scene);
  World world = make_world(scene);
  for (int i = 0; i < 90; ++i) {
    const FramePtr frame = simulation->next();
    if (i > 0) world.step(kFrame_s);
    ASSERT_EQ(hash_of(world), hash_state(*frame)) << i;
  }
}

TEST(World, WhatIsAddedBeforeTheFirstStepMovesAsIfTheSceneHadIt) {
  Scene scene = empty_scene();
  World added = make_world(scene);
  scene.solids = {box(Vec3(1, 1, 1), Vec3(0, 3, 0), "concrete"),
                  box(Vec3(2, 1, 2), Vec3(0, 0.5, 0))};
  scene.balls = {ball(Vec3(0, 5, 0))};
  for (const Solid& solid : scene.solids) added.add(solid);
  added.add(scene.balls[0]);
  World given = make_world(scene);
  for (int i = 0; i < 120; ++i) {
    added.step(kFrame_s);
    given.step(kFrame_s);
    ASSERT_EQ(hash_of(added), hash_of(given)) << i;
  }
}

TEST(World, AFrameIsMadeOnlyIfSomeoneAsksAndNeverChangesTheRun) {
  const Scene scene = load_scene("brick_wall");
  World seen = make_world(scene), unseen = make_world(scene);
  for (int i = 0; i < 60; ++i) {
    seen.step(kFrame_s);
    seen.frame();
    unseen.step(kFrame_s);
  }
  EXPECT_EQ(hash_of(seen), hash_of(unseen));
  EXPECT_EQ(seen.frame(), seen.frame()) << "the same frame until something changes";
}

TEST(World, FallsByGravityInStepsOfAnyLength) {
  for (const double step_s : {1e-3, 1.0 / 250, kFrame_s, 0.0271, 0.1}) {
    World world = make_world(empty_scene());
    const BodyKey key = world.add(ball(Vec3(0, 100, 0)));
    double time_s = 0;
    for (; time_s < 1; time_s += step_s) world.step(step_s);
    EXPECT_NEAR(world.time_s(), time_s, 1e-9);
    const double fallen_m = 100 - world.body(key).com_W.y();
    EXPECT_NEAR(fallen_m, 0.5 * 9.81 * time_s * time_s, 0.03) << step_s;
    EXPECT_NEAR(world.body(key).motion.velocity_W.y(), -9.81 * time_s, 1e-6);
  }
}

TEST(World, ChangingTheLengthOfStepsKeepsTime) {
  World world = make_world(empty_scene());
  const BodyKey key = world.add(ball(Vec3(0, 100, 0)));
  Random random(1, 0);
  double time_s = 0;
  while (time_s < 2) {
    const double step_s = random.uniform(1e-3, 0.05);
    world.step(step_s);
    time_s += step_s;
    ASSERT_NEAR(world.time_s(), time_s, 1e-9);
  }
  EXPECT_NEAR(world.body(key).motion.velocity_W.y(), -9.81 * time_s, 1e-6);
}

TEST(World, RemovingASupportWakesWhatRestsOnIt) {
  World world = make_world(empty_scene());
  const BodyKey support = world.add(box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  const BodyKey upper = world.add(box(Vec3(1, 1, 1), Vec3(0, 1.5, 0)));
  run(world, 4);
  ASSERT_TRUE(world.body(upper).asleep);
  world.remove(support);
  EXPECT_FALSE(world.contains(support));
  EXPECT_TRUE(world.contains(upper));
  run(world, 2);
  EXPECT_NEAR(world.body(upper).com_W.y(), 0.5, 0.02);
  EXPECT_THROW(world.body(support), InputError);
}

TEST(World, AnImpulseChangesTheMomentumByIt) {
  Scene scene = empty_scene();
  scene.gravity_W = Vec3::Zero();
  World world = make_world(scene);
  const BodyKey key = world.add(box(Vec3(1, 1, 1), Vec3(0, 5, 0)));
  const BodyView before = world.body(key);
  world.apply_impulse(key, Vec3(0, 0, 1000), before.com_W + Vec3(0.5, 0, 0));
  world.step(kFrame_s);
  const BodyView after = world.body(key);
  EXPECT_NEAR(after.motion.velocity_W.z(), 1000 / before.mass_kg, 1e-9);
  // About y: 0.5 m × 1000 N s over m/6.
  EXPECT_NEAR(after.motion.angular_velocity_W.y(), -500 / (before.mass_kg / 6), 1e-6);
  EXPECT_LT(std::abs(world.report().energy_residual_J), 1e-6 * world.report().kinetic_J);
}

TEST(World, MovesABodyToAPoseInTimeAndCarriesWhatRestsOnIt) {
  World world = make_world(empty_scene());
  const BodyKey platform = world.add(box(Vec3(4, 0.2, 4), Vec3(0, 0.1, 0)));
  const BodyKey load = world.add(box(Vec3(1, 1, 1), Vec3(0, 0.7, 0)));
  run(world, 1);
  world.move_to(platform, {Vec3(1, 2, 0), Quat(Eigen::AngleAxisd(0.5, Vec3::UnitY()))}, 2);
  run(world, 2);
  const BodyView lifted = world.body(platform);
  EXPECT_TRUE(lifted.is_kinematic);
  EXPECT_LT((lifted.motion.X_WR.position - Vec3(1, 2, 0)).norm(), 1e-9);
  EXPECT_LT(
      lifted.motion.X_WR.rotation.angularDistance(Quat(Eigen::AngleAxisd(0.5, Vec3::UnitY()))),
      1e-9);
  run(world, 0.5);
  EXPECT_LT((world.body(platform).motion.X_WR.position - Vec3(1, 2, 0)).norm(), 1e-9)
      << "it stays there";
  EXPECT_NEAR(world.body(load).com_W.y(), 2.6, 0.02);
  EXPECT_NEAR(world.body(load).com_W.x(), 1, 0.2) << "it slides on when the platform stops";
  world.release(platform);
  run(world, 2);
  EXPECT_FALSE(world.body(platform).is_kinematic);
  EXPECT_NEAR(world.body(platform).com_W.y(), 0.1, 0.02);
}

TEST(World, ReleasingAnAnchoredBodyLetsItFallUnderItsKey) {
  for (const double side_m : {1.0, 0.005}) {  // the second is below the smallest piece
    SCOPED_TRACE(side_m);
    World world = make_world(empty_scene());
    const BodyKey key = world.add(box(Vec3::Constant(side_m), Vec3(0, 5, 0), "concrete", true));
    const BodyKey hung = world.add(ball(Vec3(0, 4, 0)));
    Joint rod;
    rod.a = key.value;
    rod.b = hung.value;
    rod.at_W = Vec3(0, 5, 0);
    rod.to_W = Vec3(0, 4, 0);
    rod.kind = JointKind::kDistance;
    const JointKey joint = world.add(rod);
    run(world, 1);
    ASSERT_TRUE(world.body(key).is_static);
    ASSERT_NEAR(world.body(key).com_W.y(), 5, 1e-12);
    world.set_user_data(key, 77);
    world.release(key);
    ASSERT_TRUE(world.contains(key));
    EXPECT_FALSE(world.body(key).is_static);
    world.step(kFrame_s);
    EXPECT_TRUE(world.events().appeared.empty());
    EXPECT_TRUE(world.events().gone.empty());
    EXPECT_EQ(world.body(key).user_data, 77u);
    EXPECT_EQ(world.body(key).root, key);
    EXPECT_TRUE(world.contains(joint));
    run(world, 0.5);
    EXPECT_LT(world.body(key).com_W.y(), 4.5);
    EXPECT_LT(world.body(hung).com_W.y(), 3.5);
    EXPECT_EQ(world.size(), 2u);
    World copy = restore_world(save_world(world));
    EXPECT_EQ(hash_of(copy), hash_of(world));
  }
}

TEST(World, AFilterMayAskTheWorldAndMayNotChangeIt) {
  World world = make_world(empty_scene());
  const BodyKey key = world.add(box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  const JointKey joint = [&] {
    Joint pin;
    pin.a = key.value;
    return world.add(pin);
  }();
  const std::uint64_t before = hash_of(world);
  const Vec3 up = Vec3::UnitY();
  const std::function<void()> changes[] = {
      [&] { world.step(kFrame_s); },
      [&] { world.set_threads(1); },
      [&] { world.add(ball(Vec3(0, 5, 0))); },
      [&] { world.add(box(Vec3(1, 1, 1), Vec3(3, 0.5, 0))); },
      [&] { world.add(Asset(box(Vec3(1, 1, 1), up).compound), BodyMotion()); },
      [&] { world.add(builtin_materials()[0]); },
      [&] { world.add(Joint()); },
      [&] { world.shoot(Shot()); },
      [&] { world.blast(Blast()); },
      [&] { world.drive(Drive()); },
      [&] { world.remove(key); },
      [&] { world.remove(joint); },
      [&] { world.set_motion(key, BodyMotion()); },
      [&] { world.move_to(key, Pose(), 1); },
      [&] { world.release(key); },
      [&] { world.apply_impulse(key, up, up); },
      [&] { world.break_at(key, up, up, 1); },
      [&] { world.set_user_data(key, 1); },
      [&] {
        world.set_filter(key, {2, 2});
      },
      [&] { world.report_hits(1); },
  };
  QueryFilter filter;
  const std::function<void()> queries[] = {
      [&] { world.cast(Vec3(0, 3, 0), -up, 10, 0, filter); },
      [&] { world.cast_all(Vec3(0, 3, 0), -up, 10, 0.1, filter); },
      [&] { world.overlap(Vec3(0, 0.5, 0), 0.2, filter); },
      [&] {
        world.overlap(Box{Vec3(-1, 0, -1), Vec3(1, 1, 1)}, filter);
      },
  };
  int refused = 0;
  for (const auto& change : changes) {
    filter.accepts = [&](BodyKey) {
      try {
        change();
      } catch (const InputError& error) {
        EXPECT_THAT(error.what(), testing::HasSubstr("cannot change during a query"));
        ++refused;
      }
      return true;
    };
    for (const auto& query : queries) query();
  }
  EXPECT_EQ(refused, static_cast<int>(std::size(changes) * std::size(queries)));
  filter.accepts = [&](BodyKey of) {
    World copy = world.copy();
    copy.remove(of);  // a copy is another world
    return world.body(of).mass_kg > 0 && world.cast(Vec3(0, 3, 0), -up, 10)->body == of;
  };
  EXPECT_EQ(world.cast(Vec3(0, 3, 0), -up, 10, 0, filter)->body, key);
  filter.accepts = [&](BodyKey of) -> bool {
    world.remove(of);
    return true;
  };
  EXPECT_THROW(world.cast(Vec3(0, 3, 0), -up, 10, 0, filter), InputError);
  EXPECT_EQ(hash_of(world), before);
  world.remove(key);  // the query has ended
}

TEST(World, AnAssetIsRefusedWhereItsMaterialIsAnother) {
  World one = make_world(empty_scene()), two = make_world(empty_scene());
  Material granite = builtin_materials()[0], mud = granite;
  granite.name = "granite";
  mud.name = "mud";
  const MaterialIndex index = one.add(granite);
  Part part;
  part.polyhedron = make_box(Vec3(0, 0, 0), Vec3(1, 1, 1));
  part.material = index;
  const Asset asset(make_compound({part}), {{index, "granite"}, {MaterialIndex(0), "other"}});
  one.add(asset, {});
  EXPECT_THROW(two.add(asset, {}), InputError) << "it has no such material";
  ASSERT_EQ(two.add(mud), index);
  try {
    two.add(asset, {});
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("granite, which is mud in this world"));
  }
  EXPECT_EQ(two.size(), 0u);
  two.add(Asset(make_compound({part})), {});  // an index without a name stands for what is there
}

TEST(World, AConvexOfTooManyCornersIsRefused) {
  const auto prism = [](int sides) {
    std::vector<Vec2> outline;
    for (int i = 0; i < sides; ++i) {
      const double turn = -2 * M_PI * i / sides;
      outline.emplace_back(std::cos(turn), std::sin(turn));
    }
    Part part;
    part.polyhedron = make_prism(outline, 0, 1, false);
    part.material = material("concrete");
    return Asset(make_compound({part}));
  };
  for (const int sides : {10001, 10950, 15000}) {  // the solver aborted from 10,923 on
    try {
      prism(sides);
      ADD_FAILURE() << sides;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("expected at most 60000 corners"));
    }
  }
  World world = make_world(empty_scene());
  const BodyKey key = world.add(prism(10000), {});
  world.step(kFrame_s);
  EXPECT_EQ(world.body(key).convexes, 1u);
}

TEST(World, SetsTheMotionOfABody) {
  World world = make_world(empty_scene());
  const BodyKey key = world.add(box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  run(world, 4);
  ASSERT_TRUE(world.body(key).asleep);
  world.set_motion(key, {{Vec3(3, 8, 0), Quat::Identity()}, Vec3(1, 0, 0), Vec3::Zero()});
  EXPECT_EQ(world.body(key).com_W, Vec3(3, 8, 0));
  world.step(kFrame_s);
  EXPECT_LT(std::abs(world.report().energy_residual_J), 1.0);
  run(world, 0.5 - kFrame_s);
  EXPECT_NEAR(world.body(key).com_W.x(), 3.5, 1e-3);
  EXPECT_LT(world.body(key).com_W.y(), 7);
}

TEST(World, FilteredBodiesPassThroughEachOtherAndPiecesInheritTheFilter) {
  for (const bool filtered : {false, true}) {
    Scene scene = empty_scene();
    scene.gravity_W = Vec3::Zero();
    World world = make_world(scene);
    const BodyKey a = world.add(ball(Vec3(-2, 5, 0), Vec3(2, 0, 0)));
    const BodyKey b = world.add(ball(Vec3(2, 5, 0), Vec3(-2, 0, 0)));
    if (filtered) {
      world.set_filter(a, {2, ~4u});
      world.set_filter(b, {4, ~2u});
    }
    run(world, 2);
    EXPECT_NEAR(world.body(a).motion.velocity_W.x(), 2, filtered ? 1e-9 : 3);
    EXPECT_EQ(world.body(a).com_W.x() > 1, filtered);
    EXPECT_EQ(world.body(b).com_W.x() < -1, filtered);
  }
  World world = make_world(empty_scene());
  Solid block = box(Vec3(2, 2, 2), Vec3(0, 1, 0), "concrete");
  block.filter = {8, 0xff};
  block.user_data = 123;
  const BodyKey key = world.add(block);
  world.break_at(key, Vec3(0, 2, 0), -Vec3::UnitY(), 1e6);
  world.step(kFrame_s);
  ASSERT_GT(world.size(), 2u);
  for (const BodyKey piece : world.bodies().key) {
    EXPECT_EQ(world.body(piece).filter, block.filter);
    EXPECT_EQ(world.body(piece).user_data, 123u);
    EXPECT_EQ(world.body(piece).root, key);
  }
}

TEST(World, BreaksABodyWhereItIsToldIfTheEnergySuffices) {
  for (const double energy_J : {1e-3, 1e6}) {
    World world = make_world(empty_scene());
    const BodyKey key = world.add(box(Vec3(2, 2, 2), Vec3(0, 1, 0), "concrete"));
    world.step(kFrame_s);
    const double mass_kg = world.body(key).mass_kg;
    world.break_at(key, Vec3(0, 2, 0), -Vec3::UnitY(), energy_J);
    world.step(kFrame_s);
    EXPECT_EQ(world.contains(key), energy_J < 1);
    if (energy_J < 1) continue;
    ASSERT_EQ(world.events().breaks.size(), 1u);
    const BreakEvent& broke = world.events().breaks[0];
    EXPECT_EQ(broke.parent_key, key.value);
    EXPECT_LE(broke.energy_J, energy_J);
    EXPECT_NEAR(world.report().mass_kg, mass_kg, 1e-6 * mass_kg);
    std::vector<BodyKey> children;
    for (const std::uint64_t child : broke.child_keys) children.emplace_back(child);
    std::ranges::sort(children);
    EXPECT_EQ(world.events().appeared, children);
    EXPECT_EQ(world.events().gone, std::vector{key});
  }
  // By a pattern of the caller's: two cells.
  World world = make_world(empty_scene());
  const BodyKey key = world.add(box(Vec3(2, 2, 2), Vec3(0, 1, 0), "concrete"));
  PatternSpec halves;
  halves.kind = PatternSpec::Kind::kVoronoi;
  halves.cells = 2;
  world.break_at(key, Vec3(0, 1.9, 0), -Vec3::UnitY(), 1e6, halves);
  world.step(kFrame_s);
  ASSERT_EQ(world.events().breaks.size(), 1u);
  EXPECT_LT(world.events().breaks[0].pieces, 8u);
}

TEST(World, EventsTellEveryChangeOfTheSetOfBodies) {
  World world = make_world(load_scene("brick_wall"));
  std::set<BodyKey> known(world.bodies().key.begin(), world.bodies().key.end());
  std::set<BodyKey> asleep;
  std::size_t breaks = 0, slept = 0;
  for (int i = 0; i < 200; ++i) {
    world.step(kFrame_s);
    const Events& events = world.events();
    breaks += events.breaks.size();
    for (const BodyKey key : events.appeared) ASSERT_TRUE(known.insert(key).second);
    for (const BodyKey key : events.gone) {
      ASSERT_EQ(known.erase(key), 1u);
      asleep.erase(key);
    }
    for (const BodyKey key : events.fell_asleep) ASSERT_TRUE(asleep.insert(key).second);
    for (const BodyKey key : events.woke) ASSERT_EQ(asleep.erase(key), 1u);
    slept += events.fell_asleep.size();
    const BodyArrays& bodies = world.bodies();
    ASSERT_TRUE(std::ranges::equal(known, bodies.key));
    ASSERT_TRUE(std::ranges::is_sorted(bodies.key));
  }
  EXPECT_GT(breaks, 10u);
  EXPECT_GT(slept, 10u);
}

TEST(World, AHitHasTheSpeedAndMassOfTheFall) {
  World world = make_world(empty_scene());
  const BodyKey key = world.add(ball(Vec3(0, 5.25, 0)));
  world.report_hits(1);
  std::vector<Hit> hits;
  for (int i = 0; i < 90; ++i) {
    world.step(kFrame_s);
    hits.insert(hits.end(), world.events().hits.begin(), world.events().hits.end());
  }
  ASSERT_FALSE(hits.empty());
  EXPECT_EQ(hits[0].a, key);
  EXPECT_TRUE(hits[0].b.none()) << "the ground";
  EXPECT_NEAR(hits[0].speed_m_s, std::sqrt(2 * 9.81 * 5), 0.1);
  EXPECT_NEAR(hits[0].mass_kg, world.body(key).mass_kg, 1e-6 * hits[0].mass_kg);
  EXPECT_NEAR(hits[0].normal_W.y(), -1, 1e-6) << "from the ball to the ground";
  world.report_hits(std::numeric_limits<double>::infinity());
  world.set_motion(key, {{Vec3(0, 3, 0), Quat::Identity()}, Vec3::Zero(), Vec3::Zero()});
  for (int i = 0; i < 90; ++i) {
    world.step(kFrame_s);
    EXPECT_TRUE(world.events().hits.empty());
  }
}

TEST(World, TheContactsOfARestingBodyBearItsWeight) {
  World world = make_world(empty_scene());
  const BodyKey lower = world.add(box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  const BodyKey upper = world.add(box(Vec3(1, 1, 1), Vec3(0, 1.5, 0)));
  run(world, 2);
  Vec3 sum = Vec3::Zero(), on_lower = Vec3::Zero();
  for (const Contact& contact : world.contacts(upper)) {
    EXPECT_EQ(contact.other, lower);
    EXPECT_NEAR(contact.point_W.y(), 1, 0.01);
    sum += contact.force_W;
  }
  for (const Contact& contact : world.contacts(lower)) on_lower += contact.force_W;
  const double weight_N = 9.81 * world.body(upper).mass_kg;
  EXPECT_NEAR(sum.y(), weight_N, 0.02 * weight_N);
  EXPECT_NEAR(on_lower.y(), weight_N, 0.04 * weight_N);
}

TEST(World, JoinsBodiesAndTellsWhenAJointIsLost) {
  World world = make_world(empty_scene());
  const BodyKey key = world.add(ball(Vec3(0, 5, 0)));
  Joint rope;
  rope.kind = JointKind::kRope;
  rope.b = key.value;
  rope.at_W = Vec3(0, 8, 0);
  rope.to_W = Vec3(0, 5, 0);
  const JointKey joint = world.add(rope);
  run(world, 1);
  EXPECT_NEAR(world.body(key).com_W.y(), 5, 0.05);
  EXPECT_TRUE(world.contains(joint));
  world.remove(joint);
  EXPECT_FALSE(world.contains(joint));
  run(world, 0.5);
  EXPECT_LT(world.body(key).com_W.y(), 4.5);
  EXPECT_THROW(world.remove(joint), InputError);
  rope.to_W = world.body(key).com_W;
  const JointKey again = world.add(rope);
  EXPECT_NE(again, joint) << "keys are never used again";
  world.remove(key);
  world.step(kFrame_s);
  EXPECT_EQ(world.events().joints_lost, std::vector{again});
}

TEST(World, ShotsAndBlastsOfTheProgramActAsThoseOfAScript) {
  Scene scripted = load_scene("brick_wall");
  ASSERT_FALSE(scripted.shots.empty());
  Scene bare = scripted;
  bare.shots.clear();
  Blast blast;
  blast.time_s = 1;
  blast.center_W = Vec3(0, 1, 2);
  scripted.blasts = {blast};
  World by_script = make_world(scripted), by_program = make_world(bare);
  for (const Shot& shot : scripted.shots) by_program.shoot(shot);
  by_program.blast(blast);
  for (int i = 0; i < 90; ++i) {
    by_script.step(kFrame_s);
    by_program.step(kFrame_s);
    ASSERT_EQ(hash_of(by_script), hash_of(by_program)) << i;
  }
}

TEST(World, AnAssetMakesEqualSolids) {
  Scene scene = empty_scene();
  const Asset asset(make_compound("torus:1,0.3", material("concrete")));
  World by_asset = make_world(scene), by_solid = make_world(scene);
  for (int i = 0; i < 3; ++i) {
    Solid solid;
    solid.compound = asset.compound();
    solid.X_WR.position = Vec3(0, 1 + 3 * i, 0.2 * i);
    solid.name = "ring";
    by_solid.add(solid);
    by_asset.add(asset, {solid.X_WR, Vec3::Zero(), Vec3::Zero()}, "ring");
  }
  EXPECT_EQ(by_asset.body(BodyKey(2)).name, "ring");
  for (int i = 0; i < 90; ++i) {
    by_asset.step(kFrame_s);
    by_solid.step(kFrame_s);
  }
  EXPECT_EQ(hash_of(by_asset), hash_of(by_solid));
}

TEST(World, QueriesFindWhatIsThereAndDoNotChangeTheRun) {
  const Scene scene = load_scene("brick_wall");
  World asked = make_world(scene), other = make_world(scene);
  Random random(3, 0);
  std::size_t met = 0, pieces = 0;
  for (int i = 0; i < 100; ++i) {
    for (int k = 0; k < 20; ++k) {
      const Vec3 from(random.uniform(-4, 4), random.uniform(0.1, 4), random.uniform(-4, 4));
      const Vec3 to(random.uniform(-2, 2), random.uniform(0, 2), random.uniform(-1, 1));
      const double radius_m = k % 2 == 0 ? 0 : 0.1, most_m = 10;
      const Vec3 along = (to - from).normalized();
      const std::optional<CastHit> hit = asked.cast(from, to - from, most_m, radius_m);
      const std::vector<CastHit> all = asked.cast_all(from, to - from, most_m, radius_m);
      ASSERT_EQ(hit.has_value(), !all.empty());
      const double end_m = hit ? hit->distance_m : most_m;
      // Nothing overlaps before the hit, which another way of asking confirms.
      for (const double share : {0.2, 0.6, 0.999}) {
        const Vec3 center = from + share * end_m * along;
        ASSERT_TRUE(end_m == 0 || asked.overlap(center, 0.999 * radius_m).empty());
      }
      if (!hit) continue;
      ++met;
      ASSERT_EQ(hit->distance_m, all[0].distance_m);
      const auto here = asked.overlap(from + end_m * along, radius_m + 1e-6);
      const Overlap found{hit->body, hit->slot};
      ASSERT_TRUE(std::ranges::binary_search(here, found));
      pieces += !hit->body.none() && asked.body(hit->body).root != hit->body;
      if (hit->distance_m == 0) continue;
      const Box box{hit->point_W - Vec3::Constant(1e-6), hit->point_W + Vec3::Constant(1e-6)};
      ASSERT_TRUE(std::ranges::binary_search(asked.overlap(box), found));
    }
    asked.step(kFrame_s);
    other.step(kFrame_s);
  }
  EXPECT_EQ(hash_of(asked), hash_of(other));
  EXPECT_GT(met, 500u);
  EXPECT_GT(pieces, 20u);
}

TEST(World, QueriesSeeWhatHasChangedSinceTheLastStep) {
  World world = make_world(empty_scene());
  const Vec3 from(0, 5, -10), ahead = Vec3::UnitZ();
  EXPECT_FALSE(world.cast(from, ahead, 20));
  const BodyKey key = world.add(box(Vec3(1, 1, 1), Vec3(0, 5, 0)));
  ASSERT_TRUE(world.cast(from, ahead, 20));
  EXPECT_EQ(world.cast(from, ahead, 20)->body, key);
  EXPECT_NEAR(world.cast(from, ahead, 20)->distance_m, 9.5, 1e-6);
  world.set_motion(key, {{Vec3(0, 5, 4), Quat::Identity()}, Vec3::Zero(), Vec3::Zero()});
  EXPECT_NEAR(world.cast(from, ahead, 20)->distance_m, 13.5, 1e-6);
  const BodyKey post = world.add(box(Vec3(1, 9, 1), Vec3(0, 4.5, 2), "concrete", true));
  EXPECT_EQ(world.cast(from, ahead, 20)->body, post);
  world.remove(post);
  EXPECT_EQ(world.cast(from, ahead, 20)->body, key);
  world.step(kFrame_s);
  EXPECT_EQ(world.cast(from, ahead, 20)->body, key);
  world.remove(key);
  EXPECT_FALSE(world.cast(from, ahead, 20));
}

TEST(World, QueryFiltersChooseWhatIsFound) {
  World world = make_world(empty_scene());
  const BodyKey near = world.add(box(Vec3(1, 1, 1), Vec3(0, 5, 0)));
  const BodyKey far = world.add(ball(Vec3(0, 5, 5)));
  world.set_filter(near, {2, ~0u});
  const Vec3 from(0, 5, -10), ahead = Vec3::UnitZ();
  EXPECT_EQ(world.cast(from, ahead, 30)->body, near);
  EXPECT_EQ(world.cast(from, ahead, 30, 0, {1, true, {}})->body, far);
  const QueryFilter not_near{~0u, true, [&](BodyKey key) { return key != near; }};
  EXPECT_EQ(world.cast(from, ahead, 30, 0, not_near)->body, far);
  EXPECT_EQ(world.cast_all(from, ahead, 30).size(), 2u);
  const std::optional<CastHit> ground = world.cast(from, -Vec3::UnitY(), 30);
  ASSERT_TRUE(ground);
  EXPECT_TRUE(ground->body.none());
  EXPECT_NEAR(ground->distance_m, 5, 1e-6);
  EXPECT_FALSE(world.cast(from, -Vec3::UnitY(), 30, 0, {~0u, false, {}}));
}

TEST(World, RaysMeetAHillOnItsSurface) {
  World world = make_world(load_scene("hillside"));
  world.step(kFrame_s);
  Random random(2, 0);
  int met = 0;
  for (int i = 0; i < 200; ++i) {
    const Vec3 from(random.uniform(-20, 20), 60, random.uniform(-20, 20));
    const auto hit = world.cast(from, -Vec3::UnitY(), 100, 0, {0, true, {}});
    ASSERT_TRUE(hit);
    ASSERT_TRUE(hit->body.none());
    met += hit->point_W.y() > world.scene().ground.height_m + 0.01;
    EXPECT_FALSE(world.overlap(hit->point_W - Vec3(0, 1e-3, 0), 0).empty());
    EXPECT_TRUE(world.overlap(hit->point_W + Vec3(0, 1e-3, 0), 0, {0, true, {}}).empty());
  }
  EXPECT_GT(met, 100);
}

TEST(World, TwoWorldsInTwoThreadsGiveTheBitsOfEachAlone) {
  const char* names[] = {"brick_wall", "glass"};
  std::uint64_t alone[2], together[2];
  const auto simulate = [&](int i, std::uint64_t& hash) {
    World world = make_world(load_scene(names[i]));
    world.set_threads(1 + i);
    run(world, 1.5);
    hash = hash_of(world);
  };
  for (int i = 0; i < 2; ++i) simulate(i, alone[i]);
  std::thread first([&] { simulate(0, together[0]); });
  std::thread second([&] { simulate(1, together[1]); });
  first.join();
  second.join();
  EXPECT_EQ(together[0], alone[0]);
  EXPECT_EQ(together[1], alone[1]);
}

TEST(World, ACopyGoesOnWithTheSameBits) {
  for (const char* name : {"brick_wall", "house", "wrecking_ball", "steel_hall"}) {
    World world = make_world(load_scene(name));
    run(world, 0.7);
    const World kept = world.copy();
    std::vector<std::uint64_t> hashes;
    for (int i = 0; i < 60; ++i) {
      world.step(kFrame_s);
      hashes.push_back(hash_of(world));
    }
    for (const bool again : {false, true}) {  // a kept world can be rolled back to more than once
      world = kept.copy();
      for (int i = 0; i < 60; ++i) {
        if (again) world.set_threads(1);
        world.step(kFrame_s);
        ASSERT_EQ(hash_of(world), hashes[static_cast<std::size_t>(i)]) << name << ", " << i;
      }
    }
  }
}

TEST(World, WhatHappensInACopyDoesNotTouchTheOther) {
  World world = make_world(load_scene("brick_wall"));
  run(world, 0.5);
  World other = world.copy();
  const std::uint64_t before = hash_of(world);
  for (const BodyKey key : std::vector(other.bodies().key)) other.remove(key);
  other.add(box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  run(other, 1);
  other.frame();
  EXPECT_EQ(hash_of(world), before);
  World as_before = make_world(load_scene("brick_wall"));
  run(as_before, 0.5);
  run(as_before, 0.5);
  run(world, 0.5);
  EXPECT_EQ(hash_of(world), hash_of(as_before));
}

TEST(World, CopiesOfASolidShareTheMemoryOfTheirMeshes) {
  World world = make_world(empty_scene());
  const Solid one = box(Vec3(1, 1, 1), Vec3(0, 0.5, 0));
  Solid copy = one;
  copy.X_WR.position.x() = 3;
  world.add(one);
  world.add(copy);
  world.add(box(Vec3(1, 2, 1), Vec3(6, 1, 0)));
  const FramePtr frame = world.frame();
  ASSERT_EQ(frame->instances.size(), 3u);
  const auto mesh = [&](std::size_t i) { return frame->instances[i].mesh; };
  const auto memory = [&](std::size_t i) { return (*frame->meshes)[mesh(i).value].get(); };
  EXPECT_NE(mesh(0), mesh(1));
  EXPECT_EQ(memory(0), memory(1));
  EXPECT_NE(memory(0), memory(2));
}

// Walls in the middle of their fall, a ball on a rope, bending steel, dust in the air, a ground of
// meshes, a blast, and an empty world.
TEST(World, ARestoredWorldGoesOnWithTheSameBits) {
  const std::pair<const char*, double> cases[] = {
      {"brick_wall", 0}, {"brick_wall", 1.2}, {"house", 0.8},  {"wrecking_ball", 1.5},
      {"steel_hall", 2}, {"glass", 0.4},      {"hillside", 1}, {"column_row", 1},
      {"vase", 0.6},     {"blast", 1.2}};
  for (const auto& [name, time_s] : cases) {
    World world = make_world(load_scene(name));
    world.report_hits(1);
    run(world, time_s);
    const std::vector<std::byte> saved = save_world(world);
    World restored = restore_world(saved);
    EXPECT_TRUE(save_world(restored) == saved) << name;
    EXPECT_EQ(restored.time_s(), world.time_s());
    EXPECT_EQ(restored.events().hits.size(), world.events().hits.size());
    ASSERT_EQ(hash_of(restored), hash_of(world)) << name;
    restored.set_threads(1);
    for (int i = 0; i < 40; ++i) {
      world.step(kFrame_s);
      restored.step(kFrame_s);
      ASSERT_EQ(hash_of(restored), hash_of(world)) << name << ", frame " << i;
      ASSERT_EQ(restored.events().hits.size(), world.events().hits.size()) << name;
    }
    EXPECT_TRUE(save_world(restored) == save_world(world)) << name;
  }
}

TEST(World, OtherBytesAreNotRestored) {
  World world = make_world(empty_scene());
  world.add(box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  const std::vector<std::byte> saved = save_world(world);
  const auto refuses = [](std::span<const std::byte> bytes, const char* reason) {
    try {
      restore_world(bytes);
      ADD_FAILURE() << "restored: " << reason;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr(reason));
    }
  };
  refuses({}, "no saved state");
  refuses(std::as_bytes(std::span("[scene]\ndescription = \"x\"\n")), "no saved state");
  for (std::size_t size = 24; size < saved.size(); size += 97)
    refuses(std::span(saved).first(size), "truncated or damaged");
  const auto head =
      static_cast<std::size_t>(std::ranges::find(saved, std::byte{'\n'}) - saved.begin());
  for (std::size_t at = head + 1; at < saved.size(); at += 31) {
    std::vector<std::byte> other = saved;
    other[at] ^= std::byte{4};
    try {  // a bit of the compression may mean nothing
      EXPECT_TRUE(save_world(restore_world(other)) == saved) << at;
    } catch (const InputError& error) {
      EXPECT_THAT(error.what(), testing::HasSubstr("truncated or damaged"));
    }
  }
  std::vector<std::byte> newer = saved;
  newer[13] = std::byte{'9'};
  refuses(newer, "the state was saved by version 9");
  std::vector<std::byte> other_build = saved;
  other_build[head - 1] ^= std::byte{1};
  refuses(other_build, "only the build that saved a state can restore it");
}

TEST(World, ABallThatWasMovedStaysUnbreakable) {
  World world = make_world(empty_scene());
  Ball stone = ball(Vec3(0, 0.5, 0), Vec3::Zero(), 0.5);
  stone.material = material("stone");
  const BodyKey key = world.add(stone);
  world.move_to(key, {Vec3(0, 0.6, 0), Quat::Identity()}, 0.1);
  run(world, 0.2);
  world.release(key);
  world.add(ball(Vec3(3, 0.6, 0), Vec3(-40, 0, 0), 0.4));
  run(world, 0.5);
  EXPECT_EQ(world.size(), 2u);
  EXPECT_GT(world.body(key).motion.velocity_W.norm(), 1);
}

TEST(World, APlanarWorldRefusesToBeCopiedOrSaved) {
  const World world = make_world(parse_scene(
      "[scene]\ndescription = \"x\"\nplanar = true\n[[ball]]\nposition = [0, 5, 0]\n", "x.toml"));
  EXPECT_THROW(world.copy(), InputError);
  EXPECT_THROW(save_world(world), InputError);
}

TEST(World, ABadCallNamesItselfAndItsArgumentAndChangesNothing) {
  World world = make_world(empty_scene());
  const BodyKey key = world.add(box(Vec3(1, 1, 1), Vec3(0, 0.5, 0)));
  const BodyKey fixed = world.add(box(Vec3(1, 1, 1), Vec3(5, 0.5, 0), "concrete", true));
  const BodyKey gone = world.add(ball(Vec3(0, 9, 0)));
  world.remove(gone);
  const Vec3 bad(kNaN, 0, 0), up = Vec3::UnitY();
  const Pose bad_pose{bad, Quat::Identity()}, pose{up, Quat::Identity()};
  Material weightless = builtin_materials()[0];
  weightless.density_kg_m3 = -1;
  Joint to_gone;
  to_gone.a = gone.value;
  Solid empty;
  Blast blast;
  blast.radius_m = -1;
  Shot shot;
  shot.ball = ball(bad);
  const std::pair<const char*, std::function<void()>> calls[] = {
      {"World::step(): time_s is 0", [&] { world.step(0); }},
      {"World::step(): time_s is 1", [&] { world.step(1); }},
      {"World::step(): time_s is nan", [&] { world.step(kNaN); }},
      {"World::set_threads(): count", [&] { world.set_threads(-1); }},
      {"World::add(): material.density_kg_m3 is -1", [&] { world.add(weightless); }},
      {"World::add(): solid.compound has no convexes", [&] { world.add(empty); }},
      {"Asset(): compound has no convexes", [&] { Asset{Compound()}; }},
      {"World::add(): ball.center_W", [&] { world.add(ball(bad)); }},
      {"World::add(): there is no body 2", [&] { world.add(to_gone); }},
      {"World::add(): joint has no body", [&] { world.add(Joint()); }},
      {"World::shoot(): shot.ball.center_W", [&] { world.shoot(shot); }},
      {"World::blast(): blast.radius_m is -1", [&] { world.blast(blast); }},
      {"World::drive(): drive has no velocity", [&] { world.drive(Drive()); }},
      {"World::remove(): there is no body 2", [&] { world.remove(gone); }},
      {"World::remove(): there is no body none", [&] { world.remove(BodyKey()); }},
      {"World::remove(): there is no joint", [&] { world.remove(JointKey(7)); }},
      {"World::set_motion(): motion.X_WR",
       [&] {
         world.set_motion(key, {bad_pose, up, up});
       }},
      {"World::set_motion(): body 1 is anchored",
       [&] {
         world.set_motion(fixed, {pose, up, up});
       }},
      {"World::move_to(): duration_s is 0", [&] { world.move_to(key, pose, 0); }},
      {"World::move_to(): body 1 is anchored", [&] { world.move_to(fixed, pose, 1); }},
      {"World::release(): there is no body 2", [&] { world.release(gone); }},
      {"World::apply_impulse(): impulse_W", [&] { world.apply_impulse(key, bad, up); }},
      {"World::break_at(): direction_W is zero", [&] { world.break_at(key, up, 0 * up, 1); }},
      {"World::break_at(): energy_J is -1", [&] { world.break_at(key, up, up, -1); }},
      {"World::cast(): from_W", [&] { world.cast(bad, up, 1); }},
      {"World::cast(): direction_W is zero", [&] { world.cast(up, 0 * up, 1); }},
      {"World::cast(): most_m is -1", [&] { world.cast(up, up, -1); }},
      {"World::overlap(): radius_m is -1", [&] { world.overlap(up, -1); }},
      {"World::overlap(): box_W is empty",
       [&] {
         world.overlap(Box{up, -up});
       }},
      {"World::contacts(): there is no body 2", [&] { world.contacts(gone); }},
      {"World::report_hits(): least_m_s", [&] { world.report_hits(kNaN); }},
  };
  const std::uint64_t before = hash_of(world);
  for (const auto& [message, call] : calls) {
    try {
      call();
      ADD_FAILURE() << message;
    } catch (const InputError& error) {
      EXPECT_NE(std::string(error.what()).find(message), std::string::npos) << error.what();
    }
  }
  EXPECT_EQ(hash_of(world), before);
  EXPECT_EQ(world.size(), 2u);
}

}  // namespace
}  // namespace sunder::scenes
