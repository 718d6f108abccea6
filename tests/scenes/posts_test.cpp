// Tests of the warnings of posts that would buckle by Euler's formula.
#include <cmath>
#include <numbers>
#include <string>

#include <gtest/gtest.h>

#include "engine/model/checks/scene_posts.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

constexpr double kPi2 = std::numbers::pi * std::numbers::pi, kGravity = 9.81;

Scene parse(const std::string& solids) {
  return parse_scene("[scene]\ndescription = \"x\"\n" + solids, "post.toml", {});
}

/// Returns a steel cube of this mass, with its foot at this height.
std::string cube(double mass_kg, double x_m, double height_m) {
  const std::string side = std::to_string(std::cbrt(mass_kg / 7800));
  return "[[solid]]\nstructure = \"box\"\nname = \"load\"\nmaterial = \"steel\"\nsize_m = [" +
         side + ", " + side + ", " + side + "]\nposition = [" + std::to_string(x_m) + ", " +
         std::to_string(height_m) + ", 0]\n";
}

struct Shape {
  const char* material;
  double youngs_Pa, density_kg_m3;
  bool round;
  double width_m, height_m;

  std::string text(const char* anchored = "bottom") const {
    const std::string width = std::to_string(round ? width_m / 2 : width_m);
    const std::string height = std::to_string(height_m);
    return std::string("[[solid]]\nname = \"post\"\nmaterial = \"") + material +
           "\"\nanchored = \"" + anchored + "\"\n" +
           (round
                ? "structure = \"column\"\nsides = 48\nradius_m = " + width +
                      "\nheight_m = " + height + "\n"
                : "structure = \"box\"\nsize_m = [" + width + ", " + height + ", " + width + "]\n");
  }
  double bending_Nm2() const {
    const double w4 = std::pow(width_m, 4);
    return youngs_Pa * (round ? std::numbers::pi * w4 / 64 : w4 / 12);
  }
  double weight_kg() const {
    const double area = width_m * width_m * (round ? std::numbers::pi / 4 : 1);
    return density_kg_m3 * area * height_m;
  }
  /// Critical load on the free head of a post with a clamped foot. The self-weight alone would
  /// buckle the post at 7.84 EI/L².
  double critical_kg() const {
    const double euler_kg = kPi2 * bending_Nm2() / (4 * height_m * height_m * kGravity);
    return euler_kg - kPi2 / 4 / 7.837 * weight_kg();
  }
};

TEST(Posts, AreWarnedOfAtTwiceEulersLoadAndNotAtHalfOfIt) {
  for (const bool round : {false, true}) {
    for (const double width_m : {0.05, 0.12}) {
      for (const double height_m : {3.0, 6.0}) {
        for (const Shape& post : {Shape{"steel", 2e11, 7800, round, width_m, height_m},
                                  Shape{"concrete", 3e10, 2400, round, width_m, height_m},
                                  Shape{"wood", 1.1e10, 600, round, width_m, height_m}}) {
          for (const char* anchored : {"bottom", "none"}) {
            for (const double part : {0.5, 0.9, 1.1, 2.0}) {
              const Scene scene =
                  parse(post.text(anchored) + cube(part * post.critical_kg(), 0, height_m));
              const std::vector<Post> posts = find_posts(scene);
              ASSERT_EQ(posts.size(), 1u);
              EXPECT_EQ(posts[0].length_factor, 2);
              EXPECT_NEAR(posts[0].critical_kg / post.critical_kg(), 1, round ? 0.015 : 2e-3);
              EXPECT_NEAR(posts[0].load_kg, part * post.critical_kg(), 1e-4 * posts[0].load_kg);
              EXPECT_EQ(post_warning(scene).empty(), part < 1)
                  << post.material << " " << width_m << " x " << height_m << " m at " << part;
            }
          }
        }
      }
    }
  }
}

TEST(Posts, OfFiveCentimetresAndSixMetresDoNotBearSixTonnes) {
  const Shape post{"steel", 2e11, 7800, false, 0.05, 6};
  const Scene scene = parse(post.text() + cube(6000, 0, 6));
  const RunInfo info = run_info(scene, "realtime");
  bool told = false;
  for (const std::string& warning : info.warnings) {
    told |= warning.starts_with(
        "the post 'post' carries 6e+03 kg and would buckle: Euler's critical load is 691 kg for a "
        "height of 6 m, clamped at the foot and free at its head (K = 2.0)");
  }
  EXPECT_TRUE(told) << post_warning(scene);
}

TEST(Posts, ThatAreStockyHaveNoWarning) {
  const Shape pillar{"concrete", 3e10, 2400, false, 1, 3},
      column{"concrete", 3e10, 2400, true, 0.5, 3};
  EXPECT_TRUE(find_posts(parse(pillar.text() + cube(1e6, 0, 3))).empty());
  EXPECT_TRUE(post_warning(parse(column.text() + cube(1e5, 0, 3))).empty());
}

TEST(Posts, OfStackedPartsAreAsStiffAsTheirPartsTogether) {
  // 2 m of steel under 2 m of wood, each 0.1 m wide.
  const double steel_Nm2 = 2e11 * 1e-4 / 12, wood_Nm2 = 1.1e10 * 1e-4 / 12;
  const auto beyond = [&](double load_N) {  // buckles at tan(k1 l1) tan(k2 l2) = k2/k1
    const double k1 = std::sqrt(load_N / steel_Nm2), k2 = std::sqrt(load_N / wood_Nm2);
    return k2 * 2 > std::numbers::pi / 2 || std::tan(2 * k1) * std::tan(2 * k2) > k2 / k1;
  };
  double low_N = 0, high_N = 1e6;
  for (int i = 0; i < 60; ++i)
    (beyond((low_N + high_N) / 2) ? high_N : low_N) = (low_N + high_N) / 2;
  const double exact_kg = low_N / kGravity;
  const std::string post =
      "[[solid]]\nstructure = \"compound\"\nname = \"post\"\nanchored = \"bottom\"\n"
      "[[solid.part]]\nstructure = \"box\"\nsize_m = [0.1, 1, 0.1]\nmaterial = \"steel\"\n"
      "repeat = { count = 2, step_m = [0, 1, 0] }\n"
      "[[solid.part]]\nstructure = \"box\"\nsize_m = [0.1, 2, 0.1]\nmaterial = \"wood\"\n"
      "position = [0, 2, 0]\n";
  const std::vector<Post> posts = find_posts(parse(post));
  ASSERT_EQ(posts.size(), 1u);
  std::printf("steel under wood: %.0f kg, exactly %.0f without self-weight\n", posts[0].critical_kg,
              exact_kg);
  const double weight_kg = 0.01 * (2 * 7800 + 2 * 600);
  EXPECT_NEAR((posts[0].critical_kg + 0.315 * weight_kg) / exact_kg, 1, 0.01);
  EXPECT_TRUE(post_warning(parse(post + cube(0.5 * exact_kg, 0, 4))).empty());
  EXPECT_FALSE(post_warning(parse(post + cube(2 * exact_kg, 0, 4))).empty());
}

TEST(Posts, ThatShareALoadBearTheirPartsOfItAndSwayTogether) {
  const std::string posts =
      "[[solid]]\nstructure = \"box\"\nname = \"post\"\nsize_m = [0.1, 4, 0.1]\n"
      "material = \"steel\"\nanchored = \"bottom\"\nposition = [-2, 0, -1]\n"
      "repeat = [{ count = 2, step_m = [4, 0, 0] }, { count = 2, step_m = [0, 0, 2] }]\n";
  const std::string slab =
      "[[solid]]\nstructure = \"box\"\nname = \"slab\"\nsize_m = [5, 0.2, 3]\n"
      "position = [0, 4, 0]\n";
  const double slab_kg = 5 * 0.2 * 3 * 2400;
  std::vector<Post> found = find_posts(parse(posts + slab));
  ASSERT_EQ(found.size(), 4u);
  for (const Post& post : found) {
    EXPECT_NEAR(post.load_kg, slab_kg / 4, 1e-6 * slab_kg);
    EXPECT_EQ(post.length_factor, 1);
  }
  // A block at a quarter of the span: the nearer pair bears three quarters of its weight.
  found = find_posts(parse(posts + slab + cube(1000, -1, 4.2)));
  EXPECT_NEAR(found[0].load_kg, slab_kg / 4 + 375, 1);
  EXPECT_NEAR(found[2].load_kg + found[3].load_kg + found[0].load_kg + found[1].load_kg,
              slab_kg + 1000, 1);
  // A pier keeps the heads in place.
  const std::string wall =
      "[[solid]]\nstructure = \"box\"\nname = \"pier\"\nsize_m = [1.5, 4, 1.5]\n";
  found = find_posts(parse(posts + slab + wall));
  ASSERT_EQ(found.size(), 4u);
  EXPECT_EQ(found[0].length_factor, 0.7);
}

TEST(Posts, ExcludeBodiesThatHangFallOrAreAnchoredOnAllSides) {
  const std::string rod =
      "[[solid]]\nstructure = \"box\"\nname = \"rod\"\nsize_m = [0.05, 4, 0.05]\n"
      "material = \"steel\"\n";
  EXPECT_EQ(find_posts(parse(rod)).size(), 1u);
  EXPECT_TRUE(find_posts(parse(rod + "position = [0, 1, 0]\n")).empty()) << "it falls";
  EXPECT_TRUE(find_posts(parse(rod + "anchored = \"all\"\n")).empty());
  EXPECT_TRUE(
      find_posts(parse(rod + "[[joint]]\nkind = \"ball\"\na = \"rod\"\nat = [0, 4, 0]\n")).empty());
  EXPECT_TRUE(find_posts(parse("gravity = [0, 0, 0]\n" + rod)).empty());
}

}  // namespace
}  // namespace sunder::scenes
