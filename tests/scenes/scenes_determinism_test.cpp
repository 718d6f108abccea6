// Tests of every scene: the same bits on any number of threads and lanes, and small residuals of
// energy, momentum and friction.
#include <map>

#include <gtest/gtest.h>

#include "engine/io/figures.h"
#include "scenes/load.h"
#include "tests/scenes/program.h"

namespace sunder::tests {
namespace {

class EveryScene : public testing::TestWithParam<std::string> {};

std::string state_hash(const std::string& arguments) {
  const Outcome outcome = sunder("simulate " + arguments + " --quiet --json -");
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  return std::get<std::string>(parse_figures(outcome.out, arguments).at("/state_hash"));
}

/// Returns the frames to run: up to a break into hundreds of pieces, or two impacts in the arena.
int frames_to_run(const std::string& scene) {
  const std::map<std::string, int> shorter = {
      {"temple", 60},   {"pile", 60},   {"arena", 40},   {"apartments", 40}, {"chimney", 45},
      {"street", 40},   {"bunker", 45}, {"crusher", 45}, {"tower", 60},      {"steel_hall", 60},
      {"hillside", 60}, {"shed", 60},   {"vase", 60}};
  const auto given = shorter.find(scene);
  return given == shorter.end() ? 120 : given->second;
}

TEST_P(EveryScene, HasTheSameStateOnAnyThreadsAndLanes) {
  const std::string run = GetParam() + " --preset draft --frames " +
                          std::to_string(frames_to_run(GetParam())) + " --threads ";
  const std::string one = state_hash(run + "1");
  EXPECT_EQ(state_hash(run + "2 --set solver.lanes=1"), one);
  EXPECT_EQ(state_hash(run + "4 --set solver.lanes=4"), one);
  EXPECT_EQ(state_hash(run + "7 --set solver.lanes=8"), one);
}

TEST_P(EveryScene, HasSmallResidualsOfEnergyMomentumAndFrictionAtEveryPreset) {
  const std::pair<const char*, int> presets[] = {// and divisor of the frames
                                                 {"draft", 1},
                                                 {"realtime", 1},
                                                 {"accurate", 2},
                                                 {"reference", 4}};
  for (const auto& [preset, part] : presets) {
    const std::string run = GetParam() + " --preset " + preset + " --frames " +
                            std::to_string(frames_to_run(GetParam()) / part);
    const Outcome outcome = sunder("simulate " + run + " --quiet --json -");
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    const Figures figures = parse_figures(outcome.out, run);
    const auto figure = [&](const std::string& name) { return number_at(figures, name); };
    EXPECT_LT(figure("/energy_residual"), 1e-6) << run;
    EXPECT_LT(figure("/momentum_residual"), 1e-4) << run;
    EXPECT_LT(figure("/friction_excess"), 0.01) << run;
    // Accuracy to which contacts and friction are separated.
    const double noise_J = 0.03 * figure("/energy_J/moved") + 1e-5 * figure("/mass_kg/initial");
    for (const char* taken : {"cracks", "crushing", "contacts", "friction", "bending", "debris"})
      EXPECT_GE(figure(std::string("/energy_flows_J/") + taken), -noise_J) << run << ", " << taken;
  }
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (const scenes::CatalogEntry& entry : scenes::catalog()) all.push_back(entry.name);
  return all;
}

INSTANTIATE_TEST_SUITE_P(Catalogue, EveryScene, testing::ValuesIn(names()),
                         [](const auto& scene) { return scene.param; });

}  // namespace
}  // namespace sunder::tests
