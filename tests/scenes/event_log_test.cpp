// Tests that the events of a run tell what its frames show.
#include "engine/io/event_log.h"

#include <fstream>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/base/parallel.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"
#include "tests/scenes/program.h"

namespace sunder::tests::event_log_test {
namespace {

using Json = nlohmann::json;

/// A wall on the ground that a ball breaks, whose pieces come to rest.
constexpr const char* kScene =
    "[scene]\ndescription = \"A wall.\"\nduration_s = 4\n"
    "[[solid]]\nname = \"the wall\"\nstructure = \"box\"\nsize_m = [2, 1, 0.2]\n"
    "material = \"brick\"\n"
    "[[ball]]\nname = \"the ball\"\nposition = [0, 0.5, -2]\nvelocity = [0, 0, 30]\n"
    "radius_m = 0.2\nmaterial = \"steel\"\n";

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Writes the events of the scene to a file; returns the last frame.
FramePtr run(const std::string& file) {
  const auto simulation = scenes::make_simulation(scenes::parse_scene(kScene, "wall.toml"));
  EventLog log(file);
  FramePtr last;
  while (FramePtr frame = simulation->next()) log.take(last = frame);
  log.finish();
  return last;
}

std::vector<Json> events_in(const std::string& file) {
  std::vector<Json> events;
  std::ifstream in(file);
  for (std::string line; std::getline(in, line);) events.push_back(Json::parse(line));
  return events;
}

TEST(EventLog, LeadsFromTheFirstFrameToTheBodiesOfTheLast) {
  const Folder folder;
  const FramePtr last = run(folder / "e.jsonl");
  std::map<std::uint64_t, bool> asleep;
  std::map<std::uint64_t, double> mass_kg;
  double broken = 0, woken = 0, time_s = 0;
  std::set<std::uint64_t> children;
  for (const Json& event : events_in(folder / "e.jsonl")) {
    EXPECT_GE(event.at("time_s"), time_s - 1. / 60);
    time_s = event.at("time_s");
    const std::string kind = event.at("event");
    const std::uint64_t body = event.at("body");
    if (kind == "appear") {
      EXPECT_TRUE(asleep.try_emplace(body, false).second) << body << " appears twice";
      mass_kg[body] = event.at("mass_kg");
      EXPECT_TRUE(time_s == 0 || children.contains(body)) << body << " comes from a break";
    } else if (kind == "break") {
      ++broken;
      EXPECT_GT(event.at("energy_J"), 0);
      EXPECT_EQ(event.at("name"), "the wall");
      EXPECT_EQ(event.at("material"), "brick");
      EXPECT_GE(event.at("pieces"), event.at("children").size());
      for (const std::uint64_t child : event.at("children")) children.insert(child);
      asleep.erase(body);
    } else if (kind == "sleep" || kind == "wake") {
      ASSERT_TRUE(asleep.contains(body)) << body;
      EXPECT_EQ(asleep[body], kind == "wake") << body;
      asleep[body] = kind == "sleep";
      if (kind == "wake") ++woken;
    } else {
      EXPECT_EQ(kind, "disappear");
      EXPECT_EQ(asleep.erase(body), 1u);
    }
  }
  EXPECT_GT(broken, 3);
  EXPECT_GT(woken, 0);
  ASSERT_EQ(asleep.size(), last->bodies.size());
  for (const FrameBody& body : last->bodies) {
    ASSERT_TRUE(asleep.contains(body.key)) << body.key;
    EXPECT_EQ(asleep[body.key], body.asleep) << body.key;
    EXPECT_EQ(mass_kg[body.key], body.mass_kg) << body.key;
  }
}

TEST(EventLog, IsTheSameForAnyNumberOfThreads) {
  const Folder folder;
  const int before = threads();
  std::string first;
  for (const int count : {1, 2, 3}) {
    set_threads(count);
    run(folder / "e.jsonl");
    const std::string text = text_of(folder / "e.jsonl");
    if (first.empty()) first = text;
    EXPECT_TRUE(text == first) << count;
  }
  set_threads(before);
}

TEST(EventLog, IsWrittenBySimulate) {
  const Folder folder;
  std::ofstream(folder / "wall.toml") << kScene;
  run(folder / "library.jsonl");
  const Outcome outcome = sunder("simulate " + (folder / "wall.toml") + " --threads 1 --events " +
                                 (folder / "new/program.jsonl"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.err;
  EXPECT_TRUE(text_of(folder / "new/program.jsonl") == text_of(folder / "library.jsonl"));
  EXPECT_NE(outcome.out.find(" events\n"), std::string::npos) << outcome.out;
}

TEST(EventLog, ThatCannotBeWrittenIsRefused) {
  const Outcome outcome = sunder("simulate brick_wall --events /proc/nowhere/e.jsonl");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("/proc/nowhere/e.jsonl: cannot be written"), std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace sunder::tests::event_log_test
