// Tests of applying a break's edit to an actor: the remainder, and the new pieces.
#include "engine/world/actors/replace.h"

#include <gtest/gtest.h>

#include "engine/world/actors/make_actor.h"
#include "tests/engine/scripted.h"

namespace sunder {
namespace {

using testing::ScriptedPhysics;

/// Returns a column of four unit boxes, anchored at both ends.
Compound column() {
  Compound compound;
  for (std::uint32_t i = 0; i < 4; ++i) {
    const Vec3 min(0, i, 0);
    compound.convexes.push_back(make_convex(make_box(min, min + Vec3::Ones()), MaterialIndex(0)));
    compound.anchored.push_back(i == 0 || i == 3);
    if (i > 0) compound.bonds.push_back({i - 1, i, 3, 2, 1});
  }
  return compound;
}

struct Column {
  WorldState world;
  ScriptedPhysics* physics;

  explicit Column(const Compound& compound = column())
      : Column(compound, std::make_unique<ScriptedPhysics>(nullptr)) {}
  Actor& actor(std::size_t i) { return world.actors[i]; }
  /// Removes the two upper boxes, which stay bonded to each other.
  void break_in_two() {
    const Structure& structure = actor(0).structure;
    BreakEdit edit;
    edit.changed = true;
    edit.removed = {ConvexSlot(2), ConvexSlot(3)};
    Compound piece;
    for (const ConvexSlot slot : edit.removed) piece.convexes.push_back(structure.convex(slot));
    piece.anchored = {0, 1};
    piece.bonds = {{0, 1, 3, 2, 1}};
    edit.loose.pieces = {piece};
    apply_break(world, actor(0).key, edit);
  }

 private:
  Column(const Compound& compound, std::unique_ptr<ScriptedPhysics> owned)
      : world(scene(), std::move(owned)), physics(static_cast<ScriptedPhysics*>(&*world.physics)) {
    const Solid solid{"column", compound, {}};
    add_compounds(world, std::span(&solid, 1));
  }
  static Scene scene() {
    Scene scene;
    Material stone;
    stone.density_kg_m3 = 1000;
    stone.toughness_J_m2 = 100;
    stone.tensile_Pa = 1e6;
    stone.pattern.kind = PatternSpec::Kind::kVoronoi;
    scene.materials = {stone};
    scene.accuracy = {1.0 / 60, 1};
    return scene;
  }
};

TEST(ApplyBreak, TheRemainderEqualsANewActorOfItsConvexes) {
  Column column;
  Actor& remainder = column.actor(0);
  const double whole_J = remainder.least_J;
  remainder.least_J = 1e6;  // the value after a plan that needed more energy
  remainder.stress.settled = true;
  remainder.stress.mean_forces = {{ConvexSlot(1)}, {ConvexSlot(3)}};
  column.break_in_two();
  ASSERT_EQ(column.world.actors.size(), 2u);
  const Actor& left = column.actor(0);
  const Actor same = make_actor(column.world, left.structure.compound());
  EXPECT_EQ(left.least_J, same.least_J);
  EXPECT_LT(left.least_J, whole_J);
  EXPECT_EQ(left.weight.mass_kg, same.weight.mass_kg);
  EXPECT_EQ(left.volume_m3, same.volume_m3);
  EXPECT_FALSE(left.stress.settled);
  ASSERT_EQ(left.stress.mean_forces.size(), 1u) << "forces on removed convexes are dropped";
  EXPECT_EQ(left.stress.mean_forces[0].convex, ConvexSlot(1));
  EXPECT_EQ(column.physics->bodies[0].desc.shapes.size(), 2u);
}

/// Returns three overlapping boxes along x, 3 m³ together; the last one is anchored.
Compound overlapping() {
  Compound compound;
  const double low[] = {0, 1, 0.5}, high[] = {2, 3, 1.5};
  const auto box = [](double from, double to) {
    return make_convex(make_box(Vec3(from, 0, 0), Vec3(to, 1, 1)), MaterialIndex(0));
  };
  for (std::size_t i = 0; i < 3; ++i) compound.convexes.push_back(box(low[i], high[i]));
  compound.anchored = {0, 0, 1};
  compound.ghosts = {{box(1, 2), {0, 1}, -1},
                     {box(1, 1.5), {0, 1, 2}, 1},
                     {box(0.5, 1.5), {0, 2}, -1},
                     {box(1, 1.5), {1, 2}, -1}};
  return compound;
}

TEST(ApplyBreak, SubtractsAnOverlapOnceHoweverManyOfItsConvexesAreRemoved) {
  Column column(overlapping());
  ASSERT_NEAR(column.actor(0).volume_m3, 3, 1e-12);
  BreakEdit edit;
  edit.changed = true;
  edit.removed = {ConvexSlot(0), ConvexSlot(1)};
  const Compound whole = overlapping();
  edit.loose.pieces = {{{whole.convexes[0], whole.convexes[1]}, {0, 0}, {}, {whole.ghosts[0]}}};
  apply_break(column.world, column.actor(0).key, edit);
  EXPECT_NEAR(column.actor(0).volume_m3, 1, 1e-12);
  EXPECT_NEAR(column.actor(0).weight.mass_kg, 1000, 1e-9);
  EXPECT_NEAR(column.actor(1).volume_m3, 3, 1e-12);
}

TEST(ApplyBreak, PiecesKeepTheStressCacheAndRootKeyOfTheirActor) {
  struct Marked final : StressCache {};
  Column column;
  const auto memory = std::make_shared<const Marked>();
  column.actor(0).stress.memory = memory;
  column.break_in_two();
  const Actor &left = column.actor(0), &piece = column.actor(1);
  EXPECT_EQ(piece.stress.memory, memory);
  EXPECT_EQ(left.stress.memory, memory);
  EXPECT_EQ(piece.root_key, left.key);
  EXPECT_EQ(piece.weight.mass_kg, 2000);
  EXPECT_EQ(column.physics->bodies[piece.body.slot].desc.tag, piece.key);
  EXPECT_EQ(column.world.log.debris_mass_kg, 0);
}

}  // namespace
}  // namespace sunder
