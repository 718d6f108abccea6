// Tests that the events of a run tell what its frames show.
#include "engine/io/event_log.h"

#include <algorithm>
#include <fstream>
#include <map>
#include <set>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "engine/base/parallel.h"
#include "engine/world/simulation.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"
#include "tests/scenes/program.h"

namespace sunder::tests::event_log_test {
namespace {

using Json = nlohmann::json;

/// A wall on the ground that a ball breaks, whose pieces come to rest, and one that falls on them.
constexpr const char* kScene =
    "[scene]\ndescription = \"A wall.\"\nduration_s = 4\n"
    "[[solid]]\nname = \"the wall\"\nstructure = \"box\"\nsize_m = [2, 1, 0.2]\n"
    "material = \"brick\"\n"
    "[[ball]]\nname = \"the ball\"\nposition = [0, 0.5, -2]\nvelocity = [0, 0, 30]\n"
    "radius_m = 0.2\nmaterial = \"steel\"\n"
    "[[ball]]\nposition = [0.5, 35, 0]\nradius_m = 0.2\nmaterial = \"steel\"\n";

std::string text_of(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), {}};
}

/// A ball on a rope that tears, and a post with anchors, which the files of kScene do not have.
constexpr const char* kMore =
    "[[ball]]\nname = \"the weight\"\nposition = [4, 1, 0]\nradius_m = 0.2\n"
    "[[joint]]\nkind = \"rope\"\na = \"the weight\"\nat = [4, 1, 0]\nto = [4, 2, 0]\n"
    "breaking_N = 1\n"
    "[[solid]]\nname = \"the post\"\nstructure = \"box\"\nsize_m = [2, 2, 0.3]\n"
    "position = [-4, 0, 0]\nmaterial = \"concrete\"\nanchored = \"bottom\"\n"
    "[[ball]]\nposition = [-4, 1.7, -2]\nvelocity = [0, 0, 60]\nradius_m = 0.2\n"
    "material = \"steel\"\n";

World world_of(const std::string& text) {
  return scenes::make_world(scenes::parse_scene(text, "wall.toml"));
}

/// Writes the events of the scene to a file; returns the last frame.
FramePtr run(const std::string& file) {
  Simulation simulation(world_of(kScene));
  EventLog log(file, simulation.world());
  FramePtr last;
  while (FramePtr frame = simulation.next()) log.take(last = frame);
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
      EXPECT_GE(event.at("energy_J"), broken == 1 ? 1 : 0);  // 0: by load at rest
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

Json keys_of(const std::vector<BodyKey>& bodies, const std::set<std::uint64_t>& left_out = {}) {
  Json keys = Json::array();
  for (const BodyKey body : bodies)
    if (!left_out.contains(body.value)) keys.push_back(body.value);
  return keys;
}

Json vector_of(const Vec3& v) { return {v.x(), v.y(), v.z()}; }

TEST(EventLog, HasTheEventsOfTheWorld) {
  const Folder folder;
  Simulation simulation(world_of(std::string(kScene) + kMore));
  World& world = simulation.world();
  world.report_hits(0.5);
  EventLog log(folder / "e.jsonl", world);
  std::vector<std::string> expected;
  std::vector<FramePtr> frames;
  while (FramePtr frame = simulation.next()) {
    log.take(frame);
    frames.push_back(frame);
    const Events& events = world.events();
    Json hits = Json::array(), breaks = Json::array();
    std::set<std::uint64_t> broken;
    for (const Hit& hit : events.hits) {
      hits.push_back({hit.a.value, hit.b.none() ? Json() : Json(hit.b.value),
                      vector_of(hit.point_W), vector_of(hit.normal_W), hit.speed_m_s, hit.mass_kg});
    }
    for (const BreakEvent& at : events.breaks) {
      breaks.push_back({at.parent_key, at.child_keys});
      broken.insert(at.parent_key);
    }
    Json lost = Json::array();
    for (const JointKey joint : events.joints_lost) lost.push_back(joint.value);
    expected.push_back(Json({hits, breaks, keys_of(events.appeared), keys_of(events.fell_asleep),
                             keys_of(events.woke), keys_of(events.gone, broken), lost})
                           .dump());
  }
  log.finish();

  std::size_t hits = 0, on_ground = 0, lost = 0, rests = 0;
  std::vector<std::vector<Json>> found(frames.size(), std::vector<Json>(7, Json::array()));
  const std::map<std::string, std::size_t> places = {
      {"appear", 2}, {"sleep", 3}, {"wake", 4}, {"disappear", 5}};
  std::size_t frame = 0;
  for (const Json& event : events_in(folder / "e.jsonl")) {
    const std::string kind = event.at("event");
    // Breaks have times within a frame.
    while (event.at("time_s").get<double>() > frames[frame]->time_s + 1e-9) ++frame;
    if (kind == "hit") {
      ++hits;
      if (event.at("other").is_null()) ++on_ground;
      found[frame][0].push_back({event.at("body"), event.at("other"), event.at("point_m"),
                                 event.at("normal"), event.at("speed_m_s"), event.at("mass_kg")});
    } else if (kind == "break") {
      const std::uint64_t body = event.at("body");
      found[frame][1].push_back({body, event.at("children")});
      const auto& bodies = frames[frame]->bodies;
      const auto rest = std::ranges::find(bodies, body, &FrameBody::key);
      ASSERT_EQ(event.contains("rest_kg"), rest != bodies.end());
      if (rest == bodies.end()) continue;
      ++rests;
      EXPECT_EQ(event.at("rest_kg"), rest->mass_kg);
    } else if (kind == "joints lost") {
      lost += event.at("count").get<std::size_t>();
      found[frame][6] = event.at("joints");
    } else {
      found[frame][places.at(kind)].push_back(event.at("body"));
    }
  }
  // The first frame shows the bodies of the scene, which are no events of the world.
  EXPECT_EQ(found[0][2].size(), frames[0]->bodies.size());
  for (std::size_t i = 1; i < frames.size(); ++i)
    EXPECT_EQ(Json(found[i]).dump(), expected[i]) << "frame " << i;
  EXPECT_GT(hits, 10u);
  EXPECT_GT(on_ground, 0u);
  EXPECT_EQ(lost, 1u);
  EXPECT_GT(rests, 0u);
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

TEST(EventLog, HasHitsFromASpeedOnIfTheyAreRequested) {
  const Folder folder;
  std::ofstream(folder / "wall.toml") << kScene;
  const std::string simulate = "simulate " + (folder / "wall.toml") + " --frames 60 --events ";
  std::map<std::string, std::size_t> hits;
  for (const char* speed : {"", "--hits 0.5", "--hits 5"}) {
    const Outcome outcome = sunder(simulate + (folder / "e.jsonl") + " " + speed);
    ASSERT_EQ(outcome.exit_code, 0) << outcome.err;
    for (const Json& event : events_in(folder / "e.jsonl")) {
      if (event.at("event") != "hit") continue;
      ++hits[speed];
      EXPECT_GE(event.at("speed_m_s"), std::string(speed) == "--hits 5" ? 5 : 0.5);
    }
  }
  EXPECT_EQ(hits[""], 0u);
  EXPECT_GT(hits["--hits 5"], 0u);
  EXPECT_GT(hits["--hits 0.5"], hits["--hits 5"]);
  EXPECT_EQ(sunder("simulate " + (folder / "wall.toml") + " --hits 1").exit_code, 2);
  EXPECT_EQ(sunder(simulate + (folder / "e.jsonl") + " --hits -1").exit_code, 2);
  EXPECT_EQ(sunder(simulate + (folder / "e.jsonl") + " --hits nan").exit_code, 2);
}

TEST(EventLog, ThatCannotBeWrittenIsRefused) {
  const Outcome outcome = sunder("simulate brick_wall --events /proc/nowhere/e.jsonl");
  EXPECT_EQ(outcome.exit_code, 1) << outcome.err;
  EXPECT_NE(outcome.err.find("/proc/nowhere/e.jsonl: cannot be written"), std::string::npos)
      << outcome.err;
}

}  // namespace
}  // namespace sunder::tests::event_log_test
