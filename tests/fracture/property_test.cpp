// Tests of the invariants over thousands of random breaks; every failure prints its seed.
#include <algorithm>
#include <iterator>
#include <limits>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "engine/geometry/hull.h"
#include "tests/fracture/break_compound.h"
#include "tests/fracture/ring.h"
#include "tests/fracture/solids.h"
#include "tests/fracture/truths.h"

namespace sunder::fracture {
namespace {

ConvexPolyhedron random_hull(Random& random, double size) {
  for (;;) {
    std::vector<Vec3> points;
    const std::uint32_t count = 4 + random.below(12);
    const Vec3 stretch(random.uniform(.05, 1), random.uniform(.05, 1), random.uniform(.05, 1));
    for (std::uint32_t i = 0; i < count; ++i) {
      points.push_back(size * random.direction().cwiseProduct(stretch));
    }
    ConvexPolyhedron hull = make_hull(points);
    if (!hull.empty()) return hull;
  }
}

Compound random_solid(Random& random, std::uint64_t seed) {
  const double size = std::pow(10.0, random.uniform(-2, 2));
  switch (random.below(6)) {
    case 0:
      return box_compound(Vec3::Zero(),
                          size * Vec3(random.uniform(.01, 1), random.uniform(.01, 1), 1), 1);
    case 1:
      return make_compound({{random_hull(random, size), MaterialIndex(0u), 0}});
    case 2:
      return grid_compound(1 + static_cast<int>(random.below(4)), 3, 2,
                           size * Vec3(.4, .2, random.uniform(.1, .3)), true);
    case 3:
      return ring_compound(3 + static_cast<int>(random.below(9)), .5 * size, size, .4 * size);
    case 4:
      return split_islands(compound_of(random_boxes(random, 2 + random.below(5))))[0];
    default:
      return voronoi_compound(2 + static_cast<int>(random.below(12)), seed);
  }
}

PatternSpec random_pattern(Random& random) {
  using Kind = PatternSpec::Kind;
  constexpr Kind kKinds[] = {Kind::kVoronoi, Kind::kVoronoi, Kind::kWeb, Kind::kRadial,
                             Kind::kBrick,   Kind::kSlabs,   Kind::kGrid};
  PatternSpec spec;
  spec.kind = kKinds[random.below(7)];
  spec.cells = spec.kind == Kind::kGrid ? 3 : 4 + static_cast<int>(random.below(2)) * 12;
  spec.rings = 2;
  spec.spokes = 5;
  spec.colors = random.below(4) == 0 ? 3 : 0;
  return spec;
}

/// Returns a random break; a third of them are snapped to the solid's corners, faces and axes,
/// where planes of the pattern go through vertices and along faces.
BreakCommand random_impact(Random& random, const Compound& solid, std::uint64_t event) {
  BreakCommand command;
  command.event = event;
  command.seed = random.bits();
  command.pattern = random_pattern(random);
  const Box box = bounds(solid);
  Vec3 place(random.uniform(-.1, 1.1), random.uniform(-.1, 1.1), random.uniform(-.1, 1.1));
  const bool snapped = random.below(3) == 0;
  if (snapped) place = (place * 2).array().round() / 2;
  command.X_RP.position = box.min + place.cwiseProduct(box.extent());
  const Vec3 axis = random.direction();
  if (!snapped) {
    command.X_RP.rotation = Quat(random.uniform(-1, 1), axis.x(), axis.y(), axis.z()).normalized();
  }
  const double size = box.extent().norm();
  command.radius_m =
      snapped ? box.extent().x() / (1 + random.below(4)) * 1.5 : size * random.uniform(.05, .8);
  command.pattern.brick_m = Vec3(1, .5, .5) / 3 * command.radius_m;
  if (random.below(5) == 0) command.radius_m = std::numeric_limits<double>::infinity();
  if (random.below(4) == 0) {
    command.stretch_P = Vec3(random.uniform(.3, 3), random.uniform(.3, 3), 1).asDiagonal();
  }
  return command;
}

TEST(Invariants, hold_over_ten_thousand_random_breaks) {
  constexpr std::size_t kBreaks = 10000;
  std::vector<std::string> problems(kBreaks);
  std::vector<std::uint32_t> pieces(kBreaks), failed(kBreaks);
  std::vector<double> debris(kBreaks);
  for_chunks(kBreaks, 50, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t seed = begin; seed < end; ++seed) {
      Random random(seed, 11);
      const Compound solid = random_solid(random, seed);
      const BreakCommand command = random_impact(random, solid, seed + 1);
      const BreakPlan plan = break_compound(solid, command);
      problems[seed] = find_violation(solid, plan);
      pieces[seed] = static_cast<std::uint32_t>(plan.pieces.size());
      failed[seed] = plan.failed;
      debris[seed] = plan.debris_volume_m3 / volume(solid);
    }
  });
  std::size_t total = 0, failures = 0;
  double most_debris = 0;
  for (std::size_t seed = 0; seed < kBreaks; ++seed) {
    EXPECT_EQ(problems[seed], "") << "seed " << seed;
    total += pieces[seed];
    failures += failed[seed];
    most_debris = std::max(most_debris, debris[seed]);
  }
  EXPECT_GT(total, 5 * kBreaks);
  EXPECT_EQ(failures, 0u);
  EXPECT_LT(most_debris, 1e-5);
  RecordProperty("pieces", static_cast<int>(total));
  std::printf("%zu pieces, %zu convexes left whole, at most %.1e of a solid became debris\n", total,
              failures, most_debris);
}

constexpr MaterialIndex kUnbreakable[] = {MaterialIndex(1u), MaterialIndex(3u)};

bool is_unbreakable(const Convex& convex) {
  return std::ranges::count(kUnbreakable, convex.material) > 0;
}

/// Returns the solid with four materials, two of which are unbreakable.
Compound with_mixed_materials(Compound solid, Random& random) {
  for (ConvexPtr& convex : solid.convexes) {
    convex = make_convex(convex->polyhedron, MaterialIndex(random.below(4)));
  }
  return solid;
}

/// Returns the area of bonds between convexes of which exactly `count` (0 to 2) are unbreakable.
double bonded_m2(const Compound& compound, int count) {
  double area = 0;
  for (const Bond& bond : compound.bonds) {
    const bool a = is_unbreakable(*compound.convexes[bond.a]),
               b = is_unbreakable(*compound.convexes[bond.b]);
    if (a + b == count) area += bond.area_m2;
  }
  return area;
}

/// Returns an empty string if a break kept all unbreakable convexes and counted the area broken off
/// them; otherwise the violation.
std::string find_unbreakable_violation(const Compound& parent, const BreakPlan& plan) {
  std::vector<ConvexPtr> before, after;
  const auto note = [](const Compound& compound, std::vector<ConvexPtr>& all) {
    std::ranges::copy_if(compound.convexes, std::back_inserter(all),
                         [](const ConvexPtr& convex) { return is_unbreakable(*convex); });
  };
  note(parent, before);
  double both_m2 = bonded_m2(parent, 2), parted_m2 = bonded_m2(parent, 1), exposed_m2 = 0;
  for (const Compound& piece : plan.pieces) {
    note(piece, after);
    both_m2 -= bonded_m2(piece, 2);
    parted_m2 -= bonded_m2(piece, 1);
  }
  std::ranges::sort(before);
  std::ranges::sort(after);
  if (before != after) return "an unbreakable convex was replaced";
  double sides_m2 = 0;
  for (const ExposedFace& face : plan.exposed) {
    const Convex& convex = *plan.pieces[face.piece].convexes[face.convex];
    if (std::ranges::count(kUnbreakable, face.material) > 0) return "an unbreakable convex cracked";
    if (is_unbreakable(convex)) exposed_m2 += face.area_m2;
    sides_m2 += face.area_m2;
  }
  // Contacts may be too small to count.
  const double least_m2 = 1e-4 * bounds(parent).extent().squaredNorm();
  if (std::abs(sides_m2 - 2 * plan.new_area_m2) > least_m2) return "a crack with one side";
  if (!parent.ghosts.empty()) return {};  // Bonds count overlaps twice.
  if (std::abs(both_m2) > least_m2) return "unbreakable convexes were separated";
  if (std::abs(parted_m2 - exposed_m2) > least_m2)
    return "area broken off an unbreakable convex is not counted";
  return {};
}

TEST(Invariants, hold_where_some_materials_do_not_break) {
  constexpr std::size_t kBreaks = 2000;
  std::vector<std::string> problems(kBreaks);
  std::vector<double> parted(kBreaks), kept(kBreaks);
  for_chunks(kBreaks, 50, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t seed = begin; seed < end; ++seed) {
      Random random(seed, 41);
      const Compound solid = with_mixed_materials(random_solid(random, seed), random);
      BreakCommand command = random_impact(random, solid, seed + 1);
      command.unbreakable.assign(std::begin(kUnbreakable), std::end(kUnbreakable));
      const BreakPlan plan = break_compound(solid, command);
      problems[seed] = find_violation(solid, plan);
      if (problems[seed].empty()) problems[seed] = find_unbreakable_violation(solid, plan);
      if (plan.failed > 0) problems[seed] += " a convex failed";
      const double bonded = bonded_m2(solid, 1);
      if (bonded == 0 || !solid.ghosts.empty()) continue;
      for (const Compound& piece : plan.pieces) kept[seed] += bonded_m2(piece, 1) / bonded;
      parted[seed] = 1 - kept[seed];
    }
  });
  double all_parted = 0, all_kept = 0;
  for (std::size_t seed = 0; seed < kBreaks; ++seed) {
    EXPECT_EQ(problems[seed], "") << "seed " << seed;
    all_parted += parted[seed];
    all_kept += kept[seed];
  }
  EXPECT_GT(all_parted, 0.1 * kBreaks);
  EXPECT_GT(all_kept, 0.1 * kBreaks);
  std::printf("%.0f of bonds parted, %.0f kept\n", all_parted, all_kept);
}

/// Breaks pieces of overlapping convexes again and again; the ghosts have to fit after each.
TEST(Invariants, hold_where_convexes_overlap_over_three_generations) {
  std::size_t pieces = 0, ghosts = 0;
  for (std::uint64_t seed = 0; seed < 400; ++seed) {
    Random random(seed, 31);
    std::vector<Compound> solids =
        split_islands(compound_of(random_boxes(random, 2 + random.below(5))));
    double before = 0, after = 0;
    for (const Compound& solid : solids) before += volume(solid);
    for (std::uint64_t generation = 1; generation <= 3; ++generation) {
      const std::size_t which = random.below(static_cast<std::uint32_t>(solids.size()));
      const Compound target = solids[which];
      const BreakCommand command = random_impact(random, target, 10 * seed + generation);
      const BreakPlan plan = break_compound(target, command);
      ASSERT_EQ(find_violation(target, plan), "")
          << "seed " << seed << " generation " << generation;
      EXPECT_EQ(plan.failed, 0u);
      after += plan.debris_volume_m3;
      solids[which] = plan.pieces[0];
      solids.insert(solids.end(), plan.pieces.begin() + 1, plan.pieces.end());
    }
    for (const Compound& piece : solids) {
      after += volume(piece);
      ghosts += piece.ghosts.size();
    }
    EXPECT_NEAR(after, before, 1e-11 * before);
    pieces += solids.size();
  }
  EXPECT_GT(pieces, 8000u);
  EXPECT_GT(ghosts, 2000u);
}

TEST(Invariants, hold_over_five_levels_of_breaks) {
  std::vector<Compound> solids{box_compound(Vec3(-1, -1, -1), Vec3(1, 1, 1))};
  double debris = 0;
  std::uint64_t event = 0;
  for (int level = 0; level < 5; ++level) {
    std::vector<Compound> next;
    for (const Compound& solid : solids) {
      Random random(++event, 12);
      BreakCommand command;
      command.event = command.seed = event;
      command.pattern.kind = PatternSpec::Kind::kVoronoi;
      command.pattern.cells = 10;
      command.pattern.falloff = 1;
      command.X_RP.position = bounds(solid).center() + 1e-3 * random.direction();
      command.radius_m = std::numeric_limits<double>::infinity();
      const BreakPlan plan = break_compound(solid, command);
      ASSERT_EQ(find_violation(solid, plan), "") << "event " << event;
      ASSERT_EQ(plan.failed, 0u) << "event " << event;
      debris += plan.debris_volume_m3;
      next.insert(next.end(), plan.pieces.begin(), plan.pieces.end());
    }
    solids = std::move(next);
    if (solids.size() > 20000) break;
  }
  double sum = debris;
  for (const Compound& solid : solids) sum += volume(solid);
  EXPECT_NEAR(sum, 8, 8e-12);
  EXPECT_GT(solids.size(), 5000u);
  std::printf("%zu pieces, volume off by %.1e, debris %.1e\n", solids.size(), (sum - 8) / 8,
              debris / 8);
}

}  // namespace
}  // namespace sunder::fracture
