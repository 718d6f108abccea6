// Tests that a simulation is made as its scene and its options define.
#include "scenes/make_simulation.h"

#include <algorithm>
#include <initializer_list>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/io/state_hash.h"
#include "engine/model/checks/scene_check.h"
#include "scenes/load.h"

namespace sunder::scenes {
namespace {

constexpr const char* kHead = "[scene]\ndescription = \"x\"\nduration_s = 1\n";

/// Returns the last frame of a scene.
FramePtr end_of(const Scene& scene, const SimulationOptions& options = {}) {
  const auto simulation = make_simulation(scene, options);
  FramePtr last;
  while (FramePtr frame = simulation->next()) last = std::move(frame);
  return last;
}

TEST(MakeSimulation, GivesTheSolverTheScenesGravity) {
  for (const char* planar : {"", "planar = true\n"}) {
    const Scene scene = parse_scene(
        std::string(kHead) + "gravity = [0, -2, 0]\n" + planar + "[[ball]]\nposition = [0, 5, 0]\n",
        "fall.toml");
    const FramePtr last = end_of(scene);
    EXPECT_EQ(last->index, 60u);
    for (const FrameBody& body : last->bodies) {
      if (body.is_static) continue;
      EXPECT_NEAR(body.X_WB.position.y(), 5 - 0.5 * 2, 0.03) << planar;
    }
  }
}

TEST(MakeSimulation, InspectionHasTheForcesOfContactsAndDoesNotChangeTheState) {
  for (const char* planar : {"", "planar = true\n"}) {
    const Scene scene =
        parse_scene(std::string(kHead) + planar +
                        "[[solid]]\nstructure = \"stack\"\ncount = 3\nmaterial = \"steel\"\n"
                        "[[solid]]\nstructure = \"stack\"\ncount = 1\nmaterial = \"steel\"\n"
                        "position = [5, 0, 0]\n",
                    "stack.toml");
    SimulationOptions inspecting;
    inspecting.inspect = true;
    const FramePtr last = end_of(scene, inspecting), plain = end_of(scene);
    EXPECT_EQ(hash_state(*last), hash_state(*plain));
    EXPECT_EQ(plain->inspection, nullptr);
    ASSERT_NE(last->inspection, nullptr);
    double up_N = 0;  // each contact counts once: the weight of 3 + 2 + 1 and of 1 boxes
    double on_ground_N = 0;
    for (const FrameContact& contact : last->inspection->contacts) {
      const bool is_of_ground = contact.key_a == kGroundKey || contact.key_b == kGroundKey;
      up_N += std::abs(double{contact.force_W.y()});
      on_ground_N += is_of_ground ? std::abs(double{contact.force_W.y()}) : 0;
      EXPECT_TRUE(is_of_ground ||
                  (contact.key_a < 4 && contact.key_b < 4 && contact.key_a != contact.key_b));
    }
    EXPECT_NEAR(on_ground_N, 9.81 * last->report.mass_kg, 0.02 * on_ground_N) << planar;
    EXPECT_NEAR(up_N, 7 * 9.81 * last->report.mass_kg / 4, 0.02 * up_N) << planar;
    ASSERT_EQ(last->bodies.size(), 4u);
    EXPECT_EQ(last->inspection->islands, (std::vector<std::uint32_t>{0, 0, 0, 3}));
    ASSERT_EQ(last->inspection->boxes.size(), 4u);
    for (const FrameBox& box : last->inspection->boxes) {
      const Vec3f at = last->bodies[box.body].X_WB.position.cast<float>();
      EXPECT_TRUE((box.min_W.head<2>().array() < at.head<2>().array() - 0.49f).all()) << planar;
      EXPECT_TRUE((box.max_W.head<2>().array() > at.head<2>().array() + 0.49f).all()) << planar;
    }
    EXPECT_EQ(last->inspection->stresses.size(), last->instances.size());
  }
}

/// Returns a scene in which a steel ball goes through a wall of brick.
Scene struck_wall(const std::string& limits = "") {
  return parse_scene(std::string(kHead) +
                         "[[solid]]\nstructure = \"box\"\nsize_m = [1, 1, 0.3]\n"
                         "anchored = \"bottom\"\nmaterial = \"brick\"\n"
                         "[[ball]]\nposition = [-1, 0.5, 0]\nvelocity = [40, 0, 0]\n"
                         "radius_m = 0.2\nmaterial = \"steel\"\n[limits]\n" +
                         limits,
                     "wall.toml");
}

TEST(MakeSimulation, CountingLoopsTimesThemAndDoesNotChangeTheState) {
  SimulationOptions counting;
  counting.count_loops = true;
  const FramePtr last = end_of(struck_wall(), counting), plain = end_of(struck_wall());
  EXPECT_EQ(hash_state(*last), hash_state(*plain));
  double counted_ms = 0;
  for (std::size_t stage = 0; stage < kStages; ++stage) {
    const LoopTimes& loops = last->report.stage_loops[stage];
    counted_ms += loops.work_ms;
    EXPECT_LE(loops.work_ms, last->report.stage_ms[stage]);
    EXPECT_LE(loops.span_ms, loops.work_ms);
    EXPECT_EQ(plain->report.stage_loops[stage].work_ms, 0);
  }
  EXPECT_GT(counted_ms, 0);
}

TEST(MakeSimulation, SmallPiecesAreBodiesOnlyAboveTheFactorOnTheirSize) {
  const FramePtr fine = end_of(struck_wall()),
                 coarse = end_of(struck_wall("piece_size_factor = 2\n"));
  EXPECT_LT(coarse->report.counts.bodies, fine->report.counts.bodies);
  EXPECT_GT(coarse->report.counts.bodies, 2u) << "the ball, and more than one piece";
  EXPECT_NEAR(coarse->report.mass_kg, fine->report.mass_kg, 1e-9 * fine->report.mass_kg);
  EXPECT_LT(coarse->report.volume_m3, fine->report.volume_m3) << "more debris";
  EXPECT_THROW(check_scene(struck_wall("piece_size_factor = 50\n")), InputError);
}

TEST(MakeSimulation, MeshesThatNoFrameDrawsAreFreed) {
  const auto simulation = make_simulation(load_scene("house", {"draft", {"scene.duration_s=4"}}));
  FramePtr before, last;
  while (const FramePtr frame = simulation->next()) {
    for (const FramePtr& drawn : {before, frame}) {
      if (!drawn) continue;
      for (const Instance& instance : drawn->instances)
        ASSERT_TRUE((*frame->meshes)[instance.mesh.value]) << frame->time_s;
    }
    before = last = frame;
  }
  std::size_t kept = 0;
  last->meshes->for_each([&](std::size_t) { ++kept; });
  EXPECT_GT(last->meshes->size() - kept, 1000u);
  EXPECT_LT(kept, 2 * last->instances.size() + 2000);
}

TEST(MakeSimulation, TheSmallestPieceGrowsWithTheBodiesAwakeAboveFullDetail) {
  const FramePtr all = end_of(struck_wall()), many = end_of(struck_wall("full_detail = 100000\n")),
                 few = end_of(struck_wall("full_detail = 1\n"));
  EXPECT_EQ(hash_state(*many), hash_state(*all)) << "never as many awake";
  EXPECT_LT(few->report.counts.bodies, all->report.counts.bodies);
  EXPECT_GT(few->report.counts.bodies, 2u) << "the ball, and more than one piece";
  EXPECT_NEAR(few->report.mass_kg, all->report.mass_kg, 1e-9 * all->report.mass_kg);
  EXPECT_LT(few->report.volume_m3, all->report.volume_m3) << "more debris";
  const Limits draft = parse_scene(kHead, "empty.toml", {"draft", {}}).limits;
  EXPECT_EQ(draft.full_detail, 200u);
  EXPECT_EQ(draft.chip_size_factor, 2);
  EXPECT_EQ(parse_scene(kHead, "empty.toml", {}).limits.full_detail, 0u);
}

TEST(MakeSimulation, SmallDebrisIsLeftOutBelowTheFactorOnItsSize) {
  const FramePtr all = end_of(struck_wall()), few = end_of(struck_wall("chip_size_factor = 2\n")),
                 least = end_of(struck_wall("chip_size_factor = 100\n"));
  // Pieces too small for a body are debris of any size.
  const std::size_t pieces = least->debris.size();
  ASSERT_GT(all->debris.size(), pieces + 200);
  const double kept = static_cast<double>(few->debris.size() - pieces) /
                      static_cast<double>(all->debris.size() - pieces);
  EXPECT_NEAR(kept, 0.25, 0.1);
  EXPECT_EQ(few->report.counts.bodies, all->report.counts.bodies);
}

TEST(MakeSimulation, ImpactsAreNotPassedOnIfTheLimitsSaySo) {
  // A ball strikes another that touches a block: without passing on, that breaks in a later step,
  // when the second ball moves.
  const auto breaks_at_s = [](const std::string& limits) {
    const Scene scene = parse_scene(
        std::string(kHead) + "gravity = [0, 0, 0]\n[limits]\n" + limits +
            "[[solid]]\nstructure = \"box\"\nsize_m = [0.3, 0.3, 0.3]\nmaterial = \"concrete\"\n"
            "[[ball]]\nposition = [-0.35, 0.15, 0]\nradius_m = 0.2\nmaterial = \"steel\"\n"
            "[[ball]]\nposition = [-1.2, 0.15, 0]\nvelocity = [60, 0, 0]\nradius_m = 0.2\n"
            "material = \"steel\"\n",
        "row.toml");
    const auto simulation = make_simulation(scene);
    while (const FramePtr frame = simulation->next())
      if (!frame->breaks.empty()) return frame->breaks[0].time_s;
    return 1e9;
  };
  EXPECT_LT(breaks_at_s(""), breaks_at_s("passed_impacts = false\n") - 1e-3);
}

TEST(MakeSimulation, InspectionHasTheLargestStressAtTheFootOfAColumn) {
  const Scene scene =
      parse_scene(std::string(kHead) +
                      "[[solid]]\nstructure = \"box\"\nsize_m = [0.3, 6, 0.3]\nblock_m = 1\n"
                      "anchored = \"bottom\"\n",
                  "column.toml");
  SimulationOptions inspecting;
  inspecting.inspect = true;
  const FramePtr first = make_simulation(scene, inspecting)->next();
  std::vector<std::pair<double, float>> by_height;
  for (std::size_t i = 0; i < first->instances.size(); ++i) {
    const Mesh& mesh = *(*first->meshes)[first->instances[i].mesh.value];
    by_height.emplace_back(mesh.origin_T.y(), first->inspection->stresses[i]);
  }
  std::ranges::sort(by_height);
  ASSERT_GE(by_height.size(), 6u);
  for (std::size_t i = 2; i < by_height.size(); ++i)
    EXPECT_LT(by_height[i].second, by_height[i - 1].second) << by_height[i].first;
  EXPECT_GT(by_height.back().second, 0);
  EXPECT_LT(by_height.front().second, 0.1);
}

TEST(MakeSimulation, RefusesAPlanarSceneMadeInCodeThatLeavesThePlane) {
  Scene scene = parse_scene(std::string(kHead) + "[[ball]]\nposition = [0, 5, 1]\n", "x.toml");
  scene.planar = true;
  EXPECT_THROW(make_simulation(scene), InputError);
}

TEST(MakeSimulation, WarnsOfAPresetThatIsTooCoarse) {
  const Scene scene =
      parse_scene(std::string(kHead) + "[[solid]]\nstructure = \"stack\"\ncount = 200\n",
                  "tower.toml", {"draft", {}});
  std::vector<std::string> warnings;
  SimulationOptions options;
  options.warn = [&](const std::string& warning) { warnings.push_back(warning); };
  make_simulation(scene, options);
  ASSERT_EQ(warnings.size(), run_info(scene, "draft").warnings.size());
  for (const std::string& warning : warnings)
    EXPECT_TRUE(warning.starts_with("tower: ")) << warning;
}

/// Returns true if a warning of the scene has all of these words.
bool has_warning(const Scene& scene, std::initializer_list<const char*> words) {
  for (const std::string& warning : run_info(scene).warnings)
    if (std::all_of(words.begin(), words.end(),
                    [&](const char* word) { return warning.find(word) != std::string::npos; }))
      return true;
  return false;
}

TEST(MakeSimulation, RefusesInvalidOptionsAndScenes) {
  Scene scene = parse_scene(std::string(kHead) + "[[ball]]\n", "x.toml");
  SimulationOptions less_than_none;
  less_than_none.threads = -5;
  EXPECT_THROW(make_simulation(scene, less_than_none), InputError);
  scene.balls[0].material = {};
  EXPECT_THROW(run_info(scene), InputError);
  EXPECT_THROW(make_simulation(scene), InputError);
}

TEST(MakeSimulation, WarnsOfAStepThatIsLongerThanAFrame) {
  Scene scene = parse_scene(std::string(kHead) + "[[ball]]\n", "x.toml", {"draft", {}});
  EXPECT_FALSE(has_warning(scene, {"longer than a frame"}));
  scene.accuracy.dt_s = 0.1;
  EXPECT_TRUE(has_warning(scene, {"0.1 s", "longer than a frame", "accuracy.dt_s"}));
}

TEST(MakeSimulation, WarnsOfBodiesTooFarFromTheOriginForDebris) {
  const auto ball_at = [](const char* x) {
    return parse_scene(
        std::string(kHead) + "[[ball]]\nname = \"far\"\nposition = [" + x + ", 1, 0]\n", "x.toml");
  };
  EXPECT_TRUE(run_info(ball_at("-30000")).warnings.empty());
  EXPECT_TRUE(has_warning(ball_at("-1e5"), {"'far' is 1e+05 m from the origin", "position"}));
}

TEST(MakeSimulation, WarnsOfBodiesThatTheHeaviestWouldCrush) {
  const auto under = [](const char* size_m, std::vector<std::string> set = {}) {
    return parse_scene(std::string(kHead) +
                           "[accuracy]\n[[ball]]\nname = \"marble\"\nradius_m = 0.01\n"
                           "[[solid]]\nstructure = \"box\"\nname = \"block\"\nposition = [9, 1, "
                           "0]\nsize_m = " +
                           size_m,
                       "x.toml", {"draft", std::move(set)});
  };
  EXPECT_TRUE(run_info(under("[0.03, 0.03, 0.03]")).warnings.empty());
  const Scene heavy = under("[2, 2, 2]");
  EXPECT_TRUE(has_warning(heavy, {"'block' weighs", "'marble'", "64 substeps of dt 1/2340 s"}));
  const Scene bears =
      under("[2, 2, 2]", {"accuracy.substeps=64", "accuracy.dt_s=0.000427350427350"});
  EXPECT_FALSE(has_warning(bears, {"weighs"}));
}

TEST(MakeSimulation, WarningsNameAnUnnamedBallOrShotByItsIndex) {
  const Scene heavy = parse_scene(std::string(kHead) +
                                      "[[ball]]\nradius_m = 0.01\n[[ball]]\nradius_m = 2\n"
                                      "position = [9, 2, 0]\n",
                                  "x.toml", {"draft", {}});
  EXPECT_TRUE(has_warning(heavy, {"'ball.1' weighs", "as much as 'ball.0'"}));
  const Scene far = parse_scene(std::string(kHead) +
                                    "[[solid]]\nstructure = \"box\"\nsize_m = [1, 1, 1]\n"
                                    "[[script.shot]]\ntime_s = 1\nfrom = [0, 9, 9]\n"
                                    "velocity = [0, 0, -1]\n[[script.shot]]\ntime_s = 0\n"
                                    "from = [1e5, 9, 0]\nvelocity = [0, 0, -1]\n",
                                "x.toml", {"draft", {}});
  EXPECT_TRUE(has_warning(far, {"'shot.0' is 1e+05 m from the origin"}));
}

TEST(MakeSimulation, NoSceneOfTheCatalogueHasTheseWarnings) {
  for (const CatalogEntry& entry : catalog()) {
    const Scene scene = load_scene(entry.name, {"draft", {}});
    for (const char* word : {"longer than a frame", "weighs", "from the origin"})
      EXPECT_FALSE(has_warning(scene, {word})) << entry.name;
  }
}

}  // namespace
}  // namespace sunder::scenes
