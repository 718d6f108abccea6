// Tests of yielding under loads against plastic theory.
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <set>
#include <tuple>

#include <gtest/gtest.h>

#include "engine/base/parallel.h"
#include "fracture/solids.h"
#include "fracture/stress/stress_breaks.h"
#include "fracture/stress/yielding.h"
#include "tests/fracture/solids.h"
#include "tests/fracture/steel.h"

namespace sunder::fracture {
namespace {

constexpr double kLength = 4, kWidth = 0.4;
constexpr double kPlasticMoment_Nm = kYield_Pa * kWidth * kWidth * kWidth / 4;
constexpr std::uint64_t kUnlimitedWork = std::uint64_t{1} << 40;

std::vector<AppliedForce> by_slots(const std::vector<ConvexLoad>& loads) {
  std::vector<AppliedForce> result;
  for (const ConvexLoad& load : loads)
    result.push_back({ConvexSlot(load.convex), load.force_N, load.point_R, load.torque_Nm});
  return result;
}

/// Returns equal forces on the convexes whose centroid is in a box, with the sum `force_N`.
std::vector<AppliedForce> spread(const Compound& compound, const Box& where, const Vec3& force_N) {
  std::vector<AppliedForce> loads;
  for (std::uint32_t c = 0; c < compound.convexes.size(); ++c) {
    const Vec3& at = compound.convexes[c]->solid.centroid;
    if (where.overlaps({at, at})) loads.push_back({ConvexSlot(c), force_N, at});
  }
  for (AppliedForce& load : loads) load.force_N /= static_cast<double>(loads.size());
  return loads;
}

using BondNames =
    std::multiset<std::tuple<const Convex*, const Convex*, std::uint32_t, std::uint32_t>>;

void add_name(const Convex& a, const Convex& b, const Bond& bond, BondNames& names) {
  names.insert(std::min(std::tuple(&a, &b, bond.face_a, bond.face_b),
                        std::tuple(&b, &a, bond.face_b, bond.face_a)));
}

void add_names(const Compound& compound, BondNames& names) {
  for (const Bond& bond : compound.bonds)
    add_name(*compound.convexes[bond.a], *compound.convexes[bond.b], bond, names);
}

/// Expects that every convex is in one piece, and every bond in one piece, in one hinge, or cut.
void expect_conserved(const Compound& before, const BreakEdit& edit) {
  Structure structure(before);
  structure.apply(edit);
  std::vector<Compound> pieces = {structure.compound()};
  pieces.insert(pieces.end(), edit.loose.pieces.begin(), edit.loose.pieces.end());
  std::multiset<const Convex*> convexes, all;
  BondNames bonds, known;
  for (const Compound& piece : pieces) {
    for (const ConvexPtr& convex : piece.convexes) convexes.insert(convex.get());
    add_names(piece, bonds);
  }
  for (const ConvexPtr& convex : before.convexes) all.insert(convex.get());
  EXPECT_EQ(convexes, all);
  const auto convex_of = [&](std::uint32_t piece, std::uint32_t c) -> const Convex& {
    return piece > 0 ? *pieces.at(piece).convexes.at(c) : *structure.convex(ConvexSlot(c));
  };
  for (const PlasticHinge& hinge : edit.hinges) {
    EXPECT_NE(hinge.piece_a, hinge.piece_b);
    EXPECT_FALSE(pieces[hinge.piece_a].is_anchored() && pieces[hinge.piece_b].is_anchored());
    const SectionStrength& strength = hinge.section.strength;
    Vec3 leads = Vec3::Zero();
    for (const Bond& bond : hinge.bonds) {
      const Convex& a = convex_of(hinge.piece_a, bond.a);
      add_name(a, convex_of(hinge.piece_b, bond.b), bond, bonds);
      leads += bond.area_m2 * a.polyhedron.faces.at(bond.face_a).plane.normal;
    }
    EXPECT_GT(leads.dot(strength.axes_R.col(0)), 0) << "from a to b";
    EXPECT_GT(strength.axial_N, 0);
    EXPECT_GT(strength.moment_Nm.minCoeff(), 0);
    EXPECT_TRUE(strength.moment_Nm.allFinite());
    EXPECT_NEAR((strength.axes_R.transpose() * strength.axes_R - Mat3::Identity()).norm(), 0, 1e-9);
    EXPECT_GT(hinge.section.reach_m.minCoeff(), 0);
    EXPECT_GT(hinge.section.gauge_m, 0);
    EXPECT_GT(hinge.section.yield_Pa, 0);
  }
  for (const Bond& bond : edit.cut)
    add_name(*before.convexes[bond.a], *before.convexes[bond.b], bond, bonds);
  add_names(before, known);
  EXPECT_EQ(bonds, known);
}

StressResult evaluate(const Compound& compound, const std::vector<AppliedForce>& loads,
                      const Vec3& gravity_R = Vec3::Zero(),
                      const std::vector<Material>& materials = steel(),
                      std::span<const ConvexSlot> hinged = {}) {
  LoadCase load;
  load.materials = materials;
  load.loads = loads;
  load.gravity_R = gravity_R;
  load.most_work = kUnlimitedWork;
  load.hinged.assign(hinged.begin(), hinged.end());
  StressResult answer = break_by_stress(Structure(compound), load);
  expect_conserved(compound, answer.edit);
  return answer;
}

void expect_unchanged(const StressResult& answer) {
  EXPECT_TRUE(answer.settled);
  EXPECT_FALSE(answer.edit.changed);
  EXPECT_TRUE(answer.edit.hinges.empty());
  EXPECT_TRUE(answer.edit.cut.empty());
}

TEST(Yield, TheSearchForBondsThatYieldCountsAsWork) {
  const Compound compound = bar(kLength, kWidth, 10, 1);
  const auto loads =
      by_slots(pull_at_end(compound, Vec3(0, -0.5 * kPlasticMoment_Nm / kLength, 0)));
  std::vector<Material> brittle = steel();
  for (Material& material : brittle) {
    material.tensile_Pa = material.compressive_Pa = 10 * kYield_Pa;
    material.yield_Pa = 0;
  }
  const StressResult yields = evaluate(compound, loads);
  const StressResult cracks = evaluate(compound, loads, Vec3::Zero(), brittle);
  expect_unchanged(yields);
  expect_unchanged(cracks);
  EXPECT_GT(yields.work, cracks.work);
}

TEST(Yield, ACantileverYieldsAtItsRootAtThePlasticMoment) {
  for (const int across : {1, 2, 3, 4, 5, 6}) {
    SCOPED_TRACE(across);
    const Compound compound = bar(kLength, kWidth, 10 * across, across);
    const auto load = [&](double part) {
      return by_slots(pull_at_end(compound, Vec3(0, -part * kPlasticMoment_Nm / kLength, 0)));
    };
    const StressResult holds = evaluate(compound, load(0.96));
    expect_unchanged(holds);
    EXPECT_NEAR(holds.worst, 0.96, 0.03);
    const StressResult flows = evaluate(compound, load(1.04));
    ASSERT_EQ(flows.edit.hinges.size(), 1u);
    ASSERT_EQ(flows.edit.loose.pieces.size(), 1u);
    EXPECT_TRUE(flows.edit.cut.empty());
    EXPECT_TRUE(flows.edit.loose.exposed.empty());
    EXPECT_EQ(flows.edit.loose.new_area_m2, 0);
    const PlasticHinge& hinge = flows.edit.hinges[0];
    EXPECT_EQ(hinge.piece_a + hinge.piece_b, 1u);
    EXPECT_NEAR(hinge.section.centroid_R.x(), 0, 1e-9);
    EXPECT_EQ(hinge.bonds.size(), static_cast<std::size_t>(across * across));
    EXPECT_NEAR(hinge.section.strength.moment_Nm[1] / kPlasticMoment_Nm, 1, 1e-3);
    EXPECT_NEAR(hinge.section.gauge_m, 5.65 * kWidth, 1e-9);
    EXPECT_NEAR(hinge.section.reach_m.x(), kWidth * std::numbers::sqrt2 / 2, 1e-9);
    EXPECT_NEAR(hinge.section.reach_m.y(), kWidth / 2, 1e-3) << "across the axis it is bent about";
  }
}

TEST(Yield, ACantileverYieldsUnderItsSelfWeight) {
  std::vector<Material> materials = steel();
  materials[0].density_kg_m3 = 7850;
  // w L² / 2 = σ b h² / 4.
  const double length = std::sqrt(kYield_Pa * kWidth / (2 * 7850 * kGravity));
  expect_unchanged(evaluate(bar(0.97 * length, kWidth, 60, 2), {}, kDown, materials));
  EXPECT_EQ(evaluate(bar(1.03 * length, kWidth, 60, 2), {}, kDown, materials).edit.hinges.size(),
            1u);
}

TEST(Yield, ABarOfVoronoiCellsYieldsAsASolidBar) {
  for (std::uint64_t seed = 0; seed < 4; ++seed) {
    const Compound compound = voronoi_bar_of(200, 9, 1, seed);
    const double most_Nm = kYield_Pa / 4;
    double held_m = 0;  // Largest reach of the anchored cells.
    for (std::size_t c = 0; c < compound.convexes.size(); ++c)
      if (compound.anchored[c]) held_m = std::max(held_m, compound.convexes[c]->box.max.x());
    const auto load = [&](double moment_Nm, double arm_m) {
      return by_slots(pull_at_end(compound, Vec3(0, -moment_Nm / arm_m, 0)));
    };
    expect_unchanged(evaluate(compound, load(0.9 * most_Nm, 9)));
    const StressResult flows = evaluate(compound, load(1.1 * most_Nm, 9 - held_m));
    ASSERT_GE(flows.edit.hinges.size(), 1u) << seed;
    EXPECT_LT(flows.edit.hinges[0].section.centroid_R.x(), held_m + 1);
  }
}

TEST(Yield, ABarYieldsOnceInTensionAndThriceInCompression) {
  for (const int across : {1, 3}) {
    const Compound compound = bar(kLength, kWidth, 10 * across, across);
    const auto load = [&](double part) {
      return by_slots(pull_at_end(compound, Vec3(part * kYield_Pa * kWidth * kWidth, 0, 0)));
    };
    expect_unchanged(evaluate(compound, load(0.98)));
    expect_unchanged(evaluate(compound, load(-0.98)));
    const StressResult pulled = evaluate(compound, load(1.02));
    ASSERT_EQ(pulled.edit.hinges.size(), 1u);
    EXPECT_NEAR(pulled.edit.hinges[0].section.centroid_R.x(), kLength / 2, kLength / 8);
    const StressResult compressed = evaluate(compound, load(-1.02));
    EXPECT_EQ(compressed.edit.hinges.size(), 3u);
    EXPECT_EQ(compressed.edit.loose.pieces.size(), 3u);
  }
}

TEST(Yield, ABeamFixedAtBothEndsYieldsAtBoth) {
  const Compound compound = bar(kLength, kWidth, 20, 2, true);
  const Box everything = bounds(compound);
  // The elastic moment at the ends is w L² / 12.
  const auto load = [&](double part) {
    return spread(compound, everything, Vec3(0, -part * 12 * kPlasticMoment_Nm / kLength, 0));
  };
  expect_unchanged(evaluate(compound, load(0.9)));
  const StressResult answer = evaluate(compound, load(1.2));
  ASSERT_EQ(answer.edit.hinges.size(), 2u);
  EXPECT_NEAR(std::abs(answer.edit.hinges[0].section.centroid_R.x() -
                       answer.edit.hinges[1].section.centroid_R.x()),
              kLength, 1e-9);
}

TEST(Yield, ABeamOverloadedAtOneEndYieldsAtTheOtherToo) {
  const Compound compound = bar(kLength, kWidth, 20, 2, true);
  // A force P at L/4 gives the moment 9/64 P L at the near end, 3/64 P L at the far end, and
  // 54/1024·P·L below P.
  const double near = 9.0 / 64 * kLength;
  const Box where = {Vec3(kLength / 4 - 0.21, 0, 0), Vec3(kLength / 4 + 0.21, 1, 1)};
  const StressResult answer =
      evaluate(compound, spread(compound, where, Vec3(0, -1.1 * kPlasticMoment_Nm / near, 0)));
  ASSERT_GE(answer.edit.hinges.size(), 2u);
  double first = kLength;
  for (const PlasticHinge& hinge : answer.edit.hinges)
    first = std::min(first, hinge.section.centroid_R.x());
  EXPECT_NEAR(first, 0, 1e-9);
}

TEST(Yield, ASwayingPortalYieldsAtItsFeet) {
  std::vector<Part> parts;
  for (const double x : {0.0, 7.0}) {
    add_grid(Vec3(x, -0.5, 0), Vec3(x + 1, 0, 0.5), 2, 1, 1, true, parts);
    add_grid(Vec3(x, 0, 0), Vec3(x + 1, 6, 0.5), 2, 12, 1, false, parts);
  }
  add_grid(Vec3(0, 6, 0), Vec3(8, 7, 0.5), 16, 2, 1, false, parts);
  const Compound portal = make_compound(std::move(parts));
  const double full_Nm = kYield_Pa * 0.5 * 1 / 4;
  const Box corner = {Vec3(0, 6, 0), Vec3(0.5, 7, 1)};
  // Two columns that are fixed at both ends bear 4 M / h.
  const auto load = [&](double part) {
    return spread(portal, corner, Vec3(part * 4 * full_Nm / 6, 0, 0));
  };
  expect_unchanged(evaluate(portal, load(0.75)));
  const StressResult answer = evaluate(portal, load(1.1));
  ASSERT_EQ(answer.edit.hinges.size(), 2u);
  for (const PlasticHinge& hinge : answer.edit.hinges)
    EXPECT_NEAR(hinge.section.centroid_R.y(), 0, 1e-9);
  EXPECT_EQ(answer.edit.loose.pieces.size(), 2u) << "one foot, and the part above both";
}

TEST(Yield, APlateFixedAlongItsEdgesDoesNotYield) {
  std::vector<Part> parts;
  add_grid(Vec3::Zero(), Vec3(10, 0.2, 10), 10, 1, 10, false, parts);
  for (Part& part : parts) {
    const Box box = bounds(part.polyhedron);
    const bool edge =
        box.min.x() < 0.5 || box.min.z() < 0.5 || box.max.x() > 9.5 || box.max.z() > 9.5;
    part.anchored = edge ? 1 : 0;
  }
  const Compound plate = make_compound(std::move(parts));
  const StressResult answer = evaluate(plate, spread(plate, bounds(plate), Vec3(0, -2e9, 0)));
  EXPECT_GT(answer.worst, 2);
  expect_unchanged(answer);
}

TEST(Yield, ConvexesBesideAHingeDoNotYieldAgain) {
  const Compound compound = bar(kLength, kWidth, 10, 1);
  const auto loads =
      by_slots(pull_at_end(compound, Vec3(0, -1.04 * kPlasticMoment_Nm / kLength, 0)));
  const std::vector<ConvexSlot> root = {ConvexSlot(0), ConvexSlot(1)};
  const StressResult again = evaluate(compound, loads, Vec3::Zero(), steel(), root);
  expect_unchanged(again);
  EXPECT_LT(again.worst, 1);
  const auto more = by_slots(pull_at_end(compound, Vec3(0, -1.5 * kPlasticMoment_Nm / kLength, 0)));
  const StressResult beyond = evaluate(compound, more, Vec3::Zero(), steel(), root);
  ASSERT_EQ(beyond.edit.hinges.size(), 1u);
  EXPECT_NEAR(beyond.edit.hinges[0].section.centroid_R.x(), 0.2 * kLength, 1e-9);
}

TEST(Yield, ABondToAMaterialThatCannotYieldBreaksByStress) {
  // A bar of stone on a root of steel.
  std::vector<Material> materials = steel();
  materials[0].yield_Pa = 0;
  materials[0].tensile_Pa = 3e6;
  const Compound compound = bar(kLength, kWidth, 20, 2);
  const double snaps_N = 3e6 * kWidth * kWidth * kWidth / (6 * kLength);
  const auto load = [&](double part) {
    return by_slots(pull_at_end(compound, Vec3(0, -part * snaps_N, 0)));
  };
  expect_unchanged(evaluate(compound, load(0.9), Vec3::Zero(), materials));
  const StressResult answer = evaluate(compound, load(1.1), Vec3::Zero(), materials);
  EXPECT_TRUE(answer.edit.hinges.empty());
  materials[1].yield_Pa = 0;
  const StressResult ever = evaluate(compound, load(1.1), Vec3::Zero(), materials);
  EXPECT_TRUE(ever.edit.changed);
  EXPECT_EQ(sunder::fracture::hash_of(answer.edit.loose),
            sunder::fracture::hash_of(ever.edit.loose));
  EXPECT_EQ(answer.edit.cut.size(), ever.edit.cut.size());
}

TEST(Yield, StoneCracksBeforeItsSteelBarYields) {
  // Stone above a bar of steel, bonded to the bar: the stone cracks, and then the steel yields.
  std::vector<Part> parts;
  add_grid(Vec3(-0.4, 0, 0), Vec3(0, 0.4, 0.4), 1, 2, 1, true, parts);
  add_grid(Vec3(0, 0, 0), Vec3(4, 0.2, 0.4), 10, 1, 1, false, parts);
  for (Part& part : parts) part.material = MaterialIndex(0);
  add_grid(Vec3(0, 0.2, 0), Vec3(4, 0.4, 0.4), 10, 1, 1, false, parts);
  for (std::size_t i = 12; i < parts.size(); ++i) parts[i].material = MaterialIndex(1);
  parts[1].material = MaterialIndex(1);
  std::vector<Material> materials = steel();
  materials[1].yield_Pa = 0;
  materials[1].tensile_Pa = materials[1].shear_Pa = 2e6;
  const Compound compound = make_compound(std::move(parts));
  const double full_Nm = kYield_Pa * 0.4 * 0.2 * 0.2 / 4;
  const StressResult answer =
      evaluate(compound, by_slots(pull_at_end(compound, Vec3(0, -1.3 * full_Nm / 4, 0))),
               Vec3::Zero(), materials);
  EXPECT_FALSE(answer.edit.cut.empty());
  EXPECT_FALSE(answer.edit.hinges.empty());
}

TEST(Yield, AnImpactLoadBendsSteelWithoutACrack) {
  const Compound compound = bar(kLength, kWidth, 20, 2);
  const double kg = 1e5, stiffness = 3 * 2e11 * std::pow(kWidth, 4) / 12 / std::pow(kLength, 3);
  const double full_m_s =
      kPlasticMoment_Nm / kLength / std::sqrt(kg * stiffness);  // ½ m v² = F² / 2k
  const std::vector<Material> materials = steel();
  for (const double part : {0.95, 1.1}) {
    std::vector<AppliedForce> impulses =
        by_slots(pull_at_end(compound, Vec3(0, -kg * part * full_m_s, 0)));
    LoadCase load;
    load.materials = materials;
    load.most_work = kUnlimitedWork;
    load.impulsive_load = {impulses, 0.5 * kg * std::pow(part * full_m_s, 2), Vec3(kLength, 0, 0),
                           0};
    const StressResult answer = break_by_stress(Structure(compound), load);
    EXPECT_NEAR(answer.impulsive_stress.worst, part, 0.05);
    EXPECT_EQ(answer.edit.hinges.size(), part > 1 ? 1u : 0u);
    EXPECT_TRUE(answer.edit.cut.empty());
    expect_conserved(compound, answer.edit);
  }
}

std::uint64_t hash_of(const StressResult& answer) {
  std::uint64_t hash = sunder::fracture::hash_of(answer.edit.loose);
  hash = combine(hash, bits_of(answer.worst));
  for (const PlasticHinge& hinge : answer.edit.hinges) {
    hash = combine(hash, hinge.piece_a + (std::uint64_t{hinge.piece_b} << 32));
    for (int k = 0; k < 3; ++k) {
      hash = combine(hash, bits_of(hinge.section.centroid_R[k]));
      hash = combine(hash, bits_of(hinge.section.strength.moment_Nm[k]));
      hash = combine(hash, bits_of(hinge.section.reach_m[k]));
    }
    for (const Bond& bond : hinge.bonds)
      hash = combine(hash, bond.a + (std::uint64_t{bond.b} << 32));
  }
  return hash;
}

TEST(Yield, AnyCompoundKeepsItsConvexesAndBondsAndIsTheSameForAnyNumberOfThreads) {
  int hinges = 0, held = 0;
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    SCOPED_TRACE(seed);
    Random random(seed, 23);
    Compound compound = seed % 3 == 0
                            ? voronoi_bar_of(20 + static_cast<int>(random.below(100)), 5, 0.7, seed)
                            : voronoi_compound(2 + static_cast<int>(random.below(80)), seed);
    if (seed % 3 == 1)
      for (std::uint8_t& anchored : compound.anchored) anchored = random.uniform() < 0.1;
    const double brittle = seed % 4 == 0 ? 0.2 : 0;
    for (ConvexPtr& convex : compound.convexes)
      convex = make_convex(convex->polyhedron, MaterialIndex(random.uniform() < brittle ? 1 : 0));
    std::vector<Material> materials = steel();
    materials[0].yield_Pa = std::pow(10.0, random.uniform(2, 7));
    materials[1].yield_Pa = 0;
    materials[1].tensile_Pa = std::pow(10.0, random.uniform(2, 7));
    std::vector<AppliedForce> loads;
    for (int i = 0; i < 4; ++i) {
      const ConvexSlot convex(random.below(static_cast<std::uint32_t>(compound.convexes.size())));
      loads.push_back({convex, std::pow(10.0, random.uniform(2, 6)) * random.direction(),
                       compound.convexes[convex.value]->solid.centroid});
    }
    std::vector<std::uint64_t> hashes;
    for (const int count : {1, 3}) {
      set_threads(count);
      const StressResult answer = evaluate(compound, loads, kDown, materials);
      EXPECT_TRUE(answer.settled || answer.edit.changed || !answer.edit.cut.empty());
      EXPECT_TRUE(std::isfinite(answer.worst));
      hashes.push_back(hash_of(answer));
      hinges += static_cast<int>(answer.edit.hinges.size());
      held += answer.settled && answer.worst > 1 ? 1 : 0;
    }
    set_threads(0);
    EXPECT_EQ(hashes[0], hashes[1]);
  }
  EXPECT_GT(hinges, 100);
  EXPECT_GT(held, 0);
}

}  // namespace
}  // namespace sunder::fracture
