// Tests of the strength of sections against plastic theory, and of their loads against statics.
#include "fracture/stress/section.h"

#include <cmath>
#include <numbers>

#include <gtest/gtest.h>

#include "engine/geometry/hull.h"
#include "tests/fracture/steel.h"

namespace sunder::fracture {
namespace {

constexpr double kShear_Pa = kYield_Pa * std::numbers::inv_sqrt3;

/// A compound under loads, and its sections.
struct Loaded {
  explicit Loaded(Compound of, const std::vector<ConvexLoad>& loads = {})
      : compound(std::move(of)), system(system_of(compound, materials)) {
    system.solve(loads, Vec3::Zero(), 1e-8, 2000, displacements);
  }
  Section at(const Vec3& point_R, double facing_x = 0) {
    return Sections(compound, system, displacements, materials)
        .at(bond_at(system, point_R, facing_x));
  }

  std::vector<Material> materials = steel();
  Compound compound;
  StressSystem system;
  std::vector<Displacement> displacements;
};

/// Returns a beam along x of one section in boxes, anchored at x = 0 and free at `length`.
Compound extruded(const std::vector<Box>& section, double length, int along) {
  std::vector<Part> parts;
  for (int i = -1; i < along; ++i) {
    for (Box box : section) {
      box.min.x() = length * i / along;
      box.max.x() = length * (i + 1) / along;
      parts.push_back({make_box(box.min, box.max), MaterialIndex(i < 0 ? 1 : 0), i < 0});
    }
  }
  return make_compound(std::move(parts));
}

Box flat(double y_0, double y_1, double z_0, double z_1) {
  return {Vec3(0, y_0, z_0), Vec3(0, y_1, z_1)};
}

/// Divides a box in y and z.
std::vector<Box> divided(const Box& whole, int tall, int wide) {
  std::vector<Box> boxes;
  const Vec3 step = whole.extent().cwiseQuotient(Vec3(1, tall, wide));
  for (int j = 0; j < tall; ++j) {
    for (int k = 0; k < wide; ++k) {
      const Vec3 low = whole.min + step.cwiseProduct(Vec3(0, j, k));
      boxes.push_back({low, low + step});
    }
  }
  return boxes;
}

TEST(Section, OfBlocksBearsAsARectangleForAnyDivision) {
  const double h = 0.6, b = 0.3, length = 4, force = 1e4;
  for (const int tall : {1, 2, 3, 4, 6}) {
    for (const int wide : {1, 2}) {
      SCOPED_TRACE(testing::Message() << tall << " tall, " << wide << " wide");
      Compound beam = extruded(divided(flat(0, h, 0, b), tall, wide), length, 8);
      const auto loads = pull_at_end(beam, Vec3(0, -force, 0));
      Loaded loaded(std::move(beam), loads);
      const Section root = loaded.at(Vec3(0, 0, b / 4));
      EXPECT_EQ(root.crossings.size(), static_cast<std::size_t>(tall * wide));
      EXPECT_NEAR(root.area_m2, b * h, 1e-12);
      EXPECT_LT((root.centroid_R - Vec3(0, h / 2, b / 2)).norm(), 1e-12);
      const SectionStrength& strength = root.strength;
      EXPECT_NEAR(strength.axial_N / (kYield_Pa * b * h), 1, 1e-9);
      EXPECT_NEAR(strength.shear_N / (kShear_Pa * b * h), 1, 1e-9);
      EXPECT_NEAR(strength.moment_Nm[0] / (kShear_Pa * b * b * (3 * h - b) / 6), 1, 1e-5);
      EXPECT_NEAR(strength.moment_Nm[1] / (kYield_Pa * b * h * h / 4), 1, 1e-6);
      EXPECT_NEAR(strength.moment_Nm[2] / (kYield_Pa * h * b * b / 4), 1, 1e-5);
      EXPECT_NEAR(std::abs(strength.axes_R(2, 1)), 1, 1e-6) << "bent about z";
      EXPECT_NEAR(strength.axes_R.determinant(), 1, 1e-12);
      EXPECT_NEAR(root.wrench_R.moment_Nm.norm() / (force * length), 1, 1e-5);
      EXPECT_LT((root.wrench_R.force_N - root.normal_R().x() * Vec3(0, -force, 0)).norm(),
                1e-5 * force);
    }
  }
}

TEST(Section, OfProfilesHasTheirPlasticModulus) {
  const double b = 0.2, h = 0.3, flange = 0.02, web = 0.01;  // m
  struct Profile {
    const char* name;
    std::vector<Box> boxes;
    double modulus_m3;  ///< Plastic modulus about z.
  };
  const double low = (b - web) / 2, high = (b + web) / 2;
  const double of_i = b * flange * (h - flange) + web * std::pow(h - 2 * flange, 2) / 4;
  // The plastic neutral axis of this T is in its flange, where half of the area is below.
  const double stem = web * (h - flange), part = (b * flange - stem) / 2 / b;
  const double of_t = stem * (part + (h - flange) / 2) + b * part * part / 2 +
                      b * (flange - part) * (flange - part) / 2;
  const double inner_b = b - 2 * web, inner_h = h - 2 * web;
  const std::vector<Profile> profiles = {
      {"I",
       {flat(0, flange, 0, low), flat(0, flange, low, high), flat(0, flange, high, b),
        flat(flange, h - flange, low, high), flat(h - flange, h, 0, low),
        flat(h - flange, h, low, high), flat(h - flange, h, high, b)},
       of_i},
      {"I in three",
       {flat(0, flange, 0, b), flat(flange, h - flange, low, high), flat(h - flange, h, 0, b)},
       of_i},
      {"T", {flat(0, h - flange, low, high), flat(h - flange, h, 0, b)}, of_t},
      {"tube",
       {flat(0, web, 0, b), flat(h - web, h, 0, b), flat(web, h - web, 0, web),
        flat(web, h - web, b - web, b)},
       (b * h * h - inner_b * inner_h * inner_h) / 4}};
  for (const Profile& profile : profiles) {
    SCOPED_TRACE(profile.name);
    double area = 0;
    for (const Box& box : profile.boxes) area += box.extent().y() * box.extent().z();
    Compound beam = extruded(profile.boxes, 3, 10);
    const auto loads = pull_at_end(beam, Vec3(0, -1e3, 0));
    const Section root = Loaded(std::move(beam), loads).at(Vec3(0, h, b / 2));
    EXPECT_EQ(root.crossings.size(), profile.boxes.size());
    EXPECT_NEAR(root.strength.axial_N / (kYield_Pa * area), 1, 1e-9);
    EXPECT_NEAR(root.strength.shear_N / (kShear_Pa * area), 1, 1e-9);
    EXPECT_NEAR(root.strength.moment_Nm[1] / (kYield_Pa * profile.modulus_m3), 1, 0.01);
  }
}

TEST(Section, OfAThinTubeBearsTorsionByBredtsFormula) {
  const double b = 0.2, wall = 0.004, middle = b - wall;
  const Section root =
      Loaded(extruded({flat(0, wall, 0, b), flat(b - wall, b, 0, b), flat(wall, b - wall, 0, wall),
                       flat(wall, b - wall, b - wall, b)},
                      2, 10))
          .at(Vec3(0.4, 0, 0));
  EXPECT_NEAR(root.strength.moment_Nm[0] / (2 * kShear_Pa * middle * middle * wall), 1, 0.01);
}

TEST(Section, IsFullyPlasticInTensionAndBendingAsARectangle) {
  const double h = 0.4, length = 4, plastic = kYield_Pa * h * h * h / 4;
  for (const double n : {-0.9, -0.5, 0.0, 0.3, 0.7, 0.95}) {
    const double full = plastic * (1 - n * n) / length;
    Compound beam = extruded(divided(flat(0, h, 0, h), 4, 2), length, 8);
    const auto loads = pull_at_end(beam, Vec3(n * kYield_Pa * h * h, -full, 0));
    const Section root = Loaded(std::move(beam), loads).at(Vec3(0, h / 4, h / 2));
    const SectionLoad load = relative_load(root.strength, root.wrench_R);
    EXPECT_NEAR(load.axial, n, 1e-4);
    EXPECT_NEAR(root.utilisation, 1, 0.02) << n << ": it is sheared besides";
  }
}

TEST(Section, OfVoronoiCellsBearsAsTheCrossSectionOfTheBar) {
  const double length = 9, force = 1e3;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    Compound bar = voronoi_bar_of(60 + 70 * static_cast<int>(seed % 3), length, 1, seed);
    const auto loads = pull_at_end(bar, Vec3(0, -force, 0));
    Loaded loaded(std::move(bar), loads);
    for (const double x : {2.0, 3.0, 4.0, 5.0, 6.0}) {
      SCOPED_TRACE(testing::Message() << seed << ", " << x);
      const Section section = loaded.at(Vec3(x, 0.5, 0.5), 0.6);
      const SectionStrength& strength = section.strength;
      EXPECT_NEAR(strength.axial_N / kYield_Pa, 1, 0.05);
      EXPECT_NEAR(strength.shear_N / kShear_Pa, 1, 0.05);
      EXPECT_NEAR(strength.moment_Nm[1] / (kYield_Pa / 4), 1, 0.08);
      EXPECT_NEAR(strength.moment_Nm[2] / (kYield_Pa / 4), 1, 0.08);
      const double arm = length - section.centroid_R.x();
      EXPECT_NEAR(section.utilisation / (force * arm / (kYield_Pa / 4)), 1, 0.05);
    }
  }
}

TEST(Section, OfAMitreIsProjectedAlongItsMember) {
  const double h = 0.3, tilt = std::tan(0.6);
  std::vector<Part> parts;
  for (int k = 0; k < 2; ++k) {
    const double low = k * h / 2, high = low + h / 2;
    std::vector<Vec3> left, right;
    for (const double z : {0.0, h}) {
      for (const double y : {low, high}) {
        left.insert(left.end(), {Vec3(-1, y, z), Vec3(tilt * y, y, z)});
        right.insert(right.end(), {Vec3(1, y, z), Vec3(tilt * y, y, z)});
      }
    }
    parts.push_back({make_hull(left), MaterialIndex(1), 1});
    parts.push_back({make_hull(right), MaterialIndex(0), 0});
  }
  Loaded loaded(make_compound(std::move(parts)));
  const Section mitre = loaded.at(Vec3(tilt * h / 4, h / 4, h / 2));
  EXPECT_EQ(mitre.crossings.size(), 2u);
  EXPECT_NEAR(mitre.normal_R().x(), 1, 1e-9);
  EXPECT_NEAR(mitre.area_m2, h * h, 1e-9);
  EXPECT_NEAR(mitre.strength.moment_Nm.tail<2>().maxCoeff() / (kYield_Pa * h * h * h / 4), 1, 1e-6);
}

TEST(Section, DoesNotReachIntoOtherMembers) {
  // Two columns on one footing under one beam.
  std::vector<Part> parts;
  add_grid(Vec3(0, -1, 0), Vec3(5, 0, 1), 5, 1, 1, true, parts);
  for (const double x : {0.0, 4.0})
    add_grid(Vec3(x, 0, 0), Vec3(x + 1, 6, 1), 2, 6, 2, false, parts);
  add_grid(Vec3(0, 6, 0), Vec3(5, 7, 1), 5, 1, 1, false, parts);
  Loaded loaded(make_compound(std::move(parts)));
  const Section column = loaded.at(Vec3(0.25, 3, 0.25));
  EXPECT_EQ(column.crossings.size(), 4u);
  EXPECT_NEAR(column.area_m2, 1, 1e-12);
  const Section beam = loaded.at(Vec3(2, 6.5, 0.5));
  EXPECT_EQ(beam.crossings.size(), 1u) << "and not the footing below it";
}

TEST(Section, IsEmptyIfAMaterialInItCannotYield) {
  std::vector<Part> parts;
  add_grid(Vec3(0, 0, 0), Vec3(4, 1, 1), 4, 1, 1, false, parts);
  add_grid(Vec3(0, 1, 0), Vec3(4, 2, 1), 4, 1, 1, false, parts);
  for (std::size_t i = 4; i < 8; ++i) parts[i].material = MaterialIndex(1);
  Loaded loaded(make_compound(std::move(parts)));
  EXPECT_EQ(loaded.at(Vec3(2, 0.5, 0.5)).crossings.size(), 2u);
  loaded.materials[1].yield_Pa = 0;
  EXPECT_TRUE(loaded.at(Vec3(2, 0.5, 0.5)).crossings.empty());
}

}  // namespace
}  // namespace sunder::fracture
