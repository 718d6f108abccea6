// Tests that two bent halves of a beam become a compound equal to one that was made bent.
#include "fracture/rejoin.h"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

#include "fracture/adjacency/adjacency.h"
#include "tests/engine/geometry_fixtures.h"
#include "tests/fracture/bent_beam.h"
#include "tests/fracture/break_compound.h"
#include "tests/fracture/frames.h"
#include "tests/fracture/solids.h"
#include "tests/fracture/truths.h"

namespace sunder::fracture {
namespace {

const Plane kMiddle = Plane::through(Vec3::Zero(), Vec3::UnitX());

/// A beam along x from −1 to 1 that is anchored at its beginning.
struct Beam {
  int along = 8, tall = 2, wide = 2;
  double depth_m = 0.4, width_m = 0.3;

  Compound compound(const std::vector<Box>& more = {}) const {
    std::vector<Part> parts;
    const Vec3 size(2.0 / along, depth_m / tall, width_m / wide);
    for (int i = 0; i < along; ++i) {
      for (int j = 0; j < tall; ++j) {
        for (int k = 0; k < wide; ++k) {
          const Vec3 low = Vec3(-1, 0, 0) + size.cwiseProduct(Vec3(i, j, k));
          parts.push_back({make_box(low, low + size), MaterialIndex(0u), i == 0});
        }
      }
    }
    for (const Box& box : more)
      parts.push_back({make_box(box.min, box.max), MaterialIndex(0u), false});
    return make_compound(std::move(parts));
  }
  Halves halves(const std::vector<Box>& more = {}) const {
    return split_at_plane(compound(more), kMiddle);
  }
};

Beam random_beam(Random& random) {
  Beam beam;
  beam.along = 2 * (1 + static_cast<int>(random.below(5)));
  beam.tall = 1 + static_cast<int>(random.below(4));
  beam.wide = 1 + static_cast<int>(random.below(3));
  beam.depth_m = random.uniform(0.1, 0.5);
  beam.width_m = random.uniform(0.1, 0.5);
  return beam;
}

/// Returns a bend of 1e-6 rad to 120°, uniform in its logarithm, about an axis across the beam.
Quat random_bend(Random& random) {
  const double angle = 1e-6 * std::pow(120 * kRadian / 1e-6, random.uniform(0, 1));
  Vec3 axis = Vec3::Unit(1 + random.below(2));
  if (random.below(2) == 0) {
    const double slant = random.uniform(0, 6.28);
    axis = Vec3(0, std::cos(slant), std::sin(slant));
  }
  return Quat(Eigen::AngleAxisd(angle, axis));
}

/// Expects bonds between the same faces, with the same areas.
void expect_same_bonds(const std::vector<Bond>& bonds, const std::vector<Bond>& expected) {
  ASSERT_EQ(bonds.size(), expected.size());
  for (std::size_t i = 0; i < bonds.size(); ++i) {
    const Bond &x = bonds[i], &y = expected[i];
    EXPECT_EQ(std::tie(x.a, x.b, x.face_a, x.face_b), std::tie(y.a, y.b, y.face_a, y.face_b));
    EXPECT_NEAR(x.area_m2, y.area_m2, 1e-9 * y.area_m2);
  }
}

double mass_kg(const Compound& compound) { return mass_of(compound, stone()).mass_kg; }

/// Returns the halves as one compound, checked for invariants, or nothing if they stay two.
std::optional<Compound> rejoined(const Bent& bent) {
  const Rejoined result = rejoin_bent(bent.pair);
  if (!result.edit.changed) return std::nullopt;
  Structure structure = bent.a;
  structure.apply(result.edit);
  Compound one = structure.compound();
  for (const ConvexPtr& convex : one.convexes) {
    EXPECT_TRUE(is_closed(convex->polyhedron));
    EXPECT_TRUE(test::is_convex(convex->polyhedron, 1e-12));
  }
  EXPECT_EQ(split_islands(one).size(), 1u);
  expect_same_bonds(one.bonds, find_contacts(one.convexes));
  // The reference does not depend on plane ids.
  expect_same_bonds(one.bonds, contacts_by_distance(one, 1e-12));
  const double before_kg = mass_kg(bent.a.compound()) + mass_kg(bent.b.compound());
  EXPECT_NEAR(mass_kg(one), before_kg, 1e-12 * before_kg);
  EXPECT_EQ(result.slot_of_b.size(), bent.b.slot_count());
  bent.b.for_each([&](ConvexSlot slot, const Convex& convex) {
    const ConvexSlot now = result.slot_of_b[slot.value];
    if (now.none()) return;
    const Convex& moved = *structure.convex(now);
    EXPECT_LT((moved.solid.centroid - bent.pair.X_AB * convex.solid.centroid).norm(), 1e-12);
    EXPECT_LT((moved.X_RT.position - (bent.pair.X_AB * convex.X_RT).position).norm(), 1e-12);
  });
  return one;
}

double volume_of_polyhedra(const Compound& compound) {
  double sum = 0;
  for (const ConvexPtr& convex : compound.convexes) sum += test::volume(convex->polyhedron);
  return sum;
}

TEST(Rejoin, AnyBentBeamHasTheBondsAndMassOfOneMadeBent) {
  for (std::uint64_t seed = 1; seed <= 300; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 3);
    const Beam beam = random_beam(random);
    const Compound whole = beam.compound();
    const Halves halves = split_at_plane(whole, kMiddle);
    const Bent bent(halves, rotate_about_section(halves.section, random_bend(random)), seed);
    const double bend = Eigen::AngleAxisd(bent.pair.X_AB.rotation).angle();
    const double reach_m = std::hypot(beam.depth_m, beam.width_m) / 2 * std::tan(bend / 2);
    const auto one = rejoined(bent);
    if (!one && reach_m > 1 - 2.0 / beam.along) continue;  // Anchored convexes would be cut away.
    ASSERT_TRUE(one);
    // A beam long enough for the mitre loses on the inside what it gains on the outside.
    if (reach_m < 1) {
      EXPECT_NEAR(volume_of_polyhedra(*one), volume_of_polyhedra(whole), 1e-12);
    }
    std::size_t held = 0;
    for (const std::uint8_t anchored : one->anchored) held += anchored != 0;
    if (reach_m < 1 - 2.0 / beam.along) {
      EXPECT_EQ(held, static_cast<std::size_t>(beam.tall * beam.wide));
    }
    for (int i = 0; i < 200; ++i) {
      const Vec3 point = halves.section.centroid_A + test::random_point(random, 0.5);
      EXPECT_LE(cover(*one, point), 1);
    }
  }
}

TEST(Rejoin, ATwistedAndElongatedBeamKeepsItsMass) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 4);
    const Beam beam = random_beam(random);
    const Halves halves = beam.halves();
    const Quat twist(Eigen::AngleAxisd(random.uniform(-1, 1), Vec3::UnitX()));
    const Quat bend(Eigen::AngleAxisd(random.uniform(0, 1.5), Vec3::UnitY()));
    const Vec3 gap = 0.02 * beam.depth_m * Vec3(random.uniform(0, 1), random.uniform(-1, 1), 0);
    EXPECT_TRUE(
        rejoined(Bent(halves, rotate_about_section(halves.section, bend * twist, gap), seed)));
  }
}

TEST(Rejoin, GhostsBesideTheSectionAreKept) {
  const Beam beam;
  const Compound whole = beam.compound({{Vec3(0.8, -0.05, 0.1), Vec3(0.95, 0.45, 0.2)}});
  ASSERT_GT(whole.ghosts.size(), 1u);
  const Halves halves = split_at_plane(whole, kMiddle);
  const Bent bent(halves,
                  rotate_about_section(halves.section, Quat(Eigen::AngleAxisd(1, Vec3::UnitZ()))));
  const Rejoined result = rejoin_bent(bent.pair);
  ASSERT_TRUE(result.edit.changed);
  Structure structure = bent.a;
  structure.apply(result.edit);
  const Compound one = structure.compound();
  ASSERT_EQ(one.ghosts.size(), halves.b.ghosts.size());
  for (std::size_t i = 0; i < one.ghosts.size(); ++i) {
    const Ghost &now = one.ghosts[i], &before = halves.b.ghosts[i];
    EXPECT_EQ(now.sign, before.sign);
    EXPECT_NEAR(now.convex->solid.volume_m3, before.convex->solid.volume_m3, 1e-15);
    EXPECT_LT((now.convex->solid.centroid - bent.pair.X_AB * before.convex->solid.centroid).norm(),
              1e-12);
    ASSERT_EQ(now.of.size(), before.of.size());
    for (std::size_t k = 0; k < now.of.size(); ++k) {
      const Vec3 moved = bent.pair.X_AB * halves.b.convexes[before.of[k]]->solid.centroid;
      EXPECT_LT((one.convexes[now.of[k]]->solid.centroid - moved).norm(), 1e-12);
    }
  }
  EXPECT_NEAR(mass_kg(one), mass_kg(whole), 1e-12 * mass_kg(whole));
  EXPECT_EQ(split_islands(one).size(), 1u);
}

TEST(Rejoin, ABeamBendsBackAndForthAtOneSection) {
  for (const int tall : {1, 3}) {
    Beam beam;
    beam.tall = tall;
    Compound one = beam.compound();
    const double before_kg = mass_kg(one);
    const std::size_t convexes = one.convexes.size();
    Plane section = kMiddle;
    Random random(7, static_cast<std::uint64_t>(tall));
    for (std::uint64_t time = 1; time <= 50; ++time) {
      SCOPED_TRACE(time);
      const Halves halves = split_at_plane(one, section);
      ASSERT_FALSE(halves.section.slots_a.empty());
      const double angle = (time % 2 == 0 ? 1 : -1) * random.uniform(0.1, 0.6);
      const Quat bend(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
      const Bent bent(halves, rotate_about_section(halves.section, bend), time);
      const auto next = rejoined(bent);
      ASSERT_TRUE(next);
      section = bent.midplane();
      one = *next;
    }
    EXPECT_LE(one.convexes.size(), convexes);
    EXPECT_NEAR(mass_kg(one), before_kg, 1e-12 * before_kg);
    EXPECT_NEAR(volume_of_polyhedra(one), volume(one), 1e-12);
  }
}

TEST(Rejoin, HalvesWithoutACommonMidplaneAreNotRejoined) {
  const Beam beam;
  const auto bent_by = [&](const Halves& halves, double angle) {
    return Bent(halves, rotate_about_section(halves.section,
                                             Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ()))));
  };
  const auto stays_two = [](const BentPair& pair) {
    const Rejoined result = rejoin_bent(pair);
    return !result.edit.changed && result.edit.added.empty() && result.edit.removed.empty();
  };
  const Halves halves = beam.halves();
  EXPECT_FALSE(stays_two(bent_by(halves, 149 * kRadian).pair));
  EXPECT_TRUE(stays_two(bent_by(halves, 151 * kRadian).pair));

  Bent twice = bent_by(halves, 0.1);
  twice.pair.sections.push_back(halves.section);
  EXPECT_TRUE(stays_two(twice.pair));

  for (const double x : {-0.2, 0.1})  // A box beside the section, on either side.
    EXPECT_TRUE(
        stays_two(bent_by(beam.halves({{Vec3(x, -0.05, 0), Vec3(x + 0.1, 0.45, 0.1)}}), 0.1).pair));
}

TEST(Rejoin, AnchorsAreKept) {
  Beam beam;  // One layer is anchored, and the section is beside it.
  beam.along = 20;
  const Compound whole = beam.compound();
  const Halves halves = split_at_plane(whole, Plane::through(Vec3(-0.9, 0, 0), Vec3::UnitX()));
  for (double angle = 0.1; angle < 2.5; angle += 0.1) {
    const Quat bend(Eigen::AngleAxisd(angle, Vec3::UnitZ()));
    const auto one = rejoined(Bent(halves, rotate_about_section(halves.section, bend)));
    if (!one) continue;
    std::size_t held = 0;
    for (const std::uint8_t anchored : one->anchored) held += anchored != 0;
    EXPECT_GT(held, 0u) << angle;
  }
}

TEST(Rejoin, EveryMaterialKeepsItsMass) {
  const Beam beam;
  Compound whole = beam.compound();
  for (ConvexPtr& convex : whole.convexes)
    if (convex->box.center().y() > 0.2) convex = make_convex(convex->polyhedron, MaterialIndex(1u));
  std::vector<Material> materials = stone();
  materials[1].density_kg_m3 = 7 * kDensity;
  const double before_kg = mass_of(whole, materials).mass_kg;
  const Halves halves = split_at_plane(whole, kMiddle);
  for (const double angle : {-1.5, -0.2, 0.3, 1.0}) {
    const Vec3 gap(0.01, 0, 0);
    const Bent bent(
        halves,
        rotate_about_section(halves.section, Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())), gap));
    const auto one = rejoined(bent);
    ASSERT_TRUE(one);
    EXPECT_NEAR(mass_of(*one, materials).mass_kg, before_kg, 1e-12 * before_kg) << angle;
  }
}

TEST(Rejoin, TwoSectionsBendAtOnce) {
  // A portal, whose beam rests on its two legs displaced.
  std::vector<Part> parts;
  add_grid(Vec3(0, 0, 0), Vec3(0.5, 1, 0.5), 1, 2, 1, true, parts);
  add_grid(Vec3(0, 1, 0), Vec3(0.5, 2, 0.5), 1, 2, 1, false, parts);
  add_grid(Vec3(2.5, 1, 0), Vec3(3, 2, 0.5), 1, 2, 1, false, parts);
  add_grid(Vec3(2.5, 0, 0), Vec3(3, 1, 0.5), 1, 2, 1, true, parts);
  add_grid(Vec3(0.5, 0, 0), Vec3(2.5, 0.5, 0.5), 4, 1, 1, true, parts);
  add_grid(Vec3(0, 2, 0), Vec3(3, 2.5, 0.5), 6, 1, 1, false, parts);
  const Compound whole = make_compound(std::move(parts));
  Halves halves = split_at_plane(whole, Plane::through(Vec3(0, 1, 0), Vec3::UnitY()));
  BentSection left, right;
  const BentSection& both = halves.section;
  ASSERT_EQ(both.slots_a.size(), 2u);
  for (const std::size_t i : {std::size_t{0}, std::size_t{1}}) {
    const bool is_left = halves.a.convexes[both.slots_a[i]]->box.center().x() < 1;
    BentSection& section = is_left ? left : right;
    section = both;
    section.centroid_A = section.centroid_B = Vec3(is_left ? 0.25 : 2.75, 1, 0.25);
    section.reach_m = 0.36;
    section.areas_m2 = {both.areas_m2[i]};
    section.slots_a = {both.slots_a[i]}, section.faces_a = {both.faces_a[i]};
    section.slots_b = {both.slots_b[i]}, section.faces_b = {both.faces_b[i]};
  }
  Bent bent(halves, rotate_about_section(left, Quat(Eigen::AngleAxisd(0.01, Vec3::UnitX())),
                                         Vec3(0.02, 0, 0)));
  bent.pair.sections = {left, right};
  const auto one = rejoined(bent);
  ASSERT_TRUE(one);
  EXPECT_EQ(one->convexes.size(), whole.convexes.size());
  EXPECT_EQ(one->bonds.size(), whole.bonds.size());
}

TEST(Rejoin, ABentBeamHasTheStressOfOneMadeBent) {
  const Beam beam{20, 2, 2, 0.2, 0.2};
  const Halves halves = beam.halves();
  for (const double angle : {0.05, 0.7}) {
    const auto one =
        rejoined(Bent(halves, rotate_about_section(halves.section,
                                                   Quat(Eigen::AngleAxisd(angle, Vec3::UnitZ())))));
    ASSERT_TRUE(one);
    std::vector<Part> parts;
    for (std::size_t c = 0; c < one->convexes.size(); ++c) {
      const Convex& convex = *one->convexes[c];
      parts.push_back({convex.polyhedron, convex.material, one->anchored[c]});
    }
    const Compound made = make_compound(std::move(parts), 1e-9);
    expect_same_bonds(one->bonds, made.bonds);
    const BondStress x = worst_stress(*one, {}, kDown, 1e-10);
    const BondStress y = worst_stress(made, {}, kDown, 1e-10);
    EXPECT_NEAR(x.tension_Pa, y.tension_Pa, 1e-6 * y.tension_Pa);
    EXPECT_NEAR(x.shear_Pa, y.shear_Pa, 1e-6 * y.shear_Pa);
    EXPECT_GT(y.tension_Pa, 1e5);
  }
}

TEST(Rejoin, ABentBeamKeepsTheInvariantsWhenItBreaks) {
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 5);
    const Halves halves = random_beam(random).halves();
    // An elongated bar is thinner than its polyhedra.
    const Vec3 gap(seed % 2 == 0 ? 0 : 0.01, 0, 0);
    const Bent bent(halves, rotate_about_section(halves.section, random_bend(random), gap), seed);
    const auto one = rejoined(bent);
    ASSERT_TRUE(one);
    BreakCommand command;
    command.event = 1000 + seed, command.seed = seed;
    command.pattern.kind = PatternSpec::Kind::kVoronoi;
    command.pattern.cells = 30;
    command.X_RP.position = halves.section.centroid_A;
    const BreakPlan plan = break_compound(*one, command);
    EXPECT_TRUE(plan.broke());
    EXPECT_TRUE(plan.failed == 0 || !gap.isZero());
    EXPECT_EQ(find_violation(*one, plan), "");
  }
}

}  // namespace
}  // namespace sunder::fracture
