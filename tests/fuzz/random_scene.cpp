// Text of random scenes. Begin reading at random_scene(), at the end.
#include "tests/fuzz/random_scene.h"

#include <array>
#include <cstdio>
#include <filesystem>
#include <vector>

#include "engine/base/random.h"
#include "engine/base/types.h"
#include "scenes/file/text_file.h"
#include "scenes/load.h"

namespace sunder::fuzz {
namespace {

constexpr std::array kMaterials = {"brick", "clay", "concrete", "glass", "steel", "stone", "wood"};
constexpr std::array kMeshes = {"torus:0.8,0.25", "voronoi:12",   "hall:4",
                                "grid:2,2,2",     "column:0.3,2", "box:1,0.7,1.3"};
constexpr std::array kJoints = {"ball", "hinge", "fixed", "rope", "distance"};
constexpr std::array kPresets = {"draft", "realtime", "accurate", "reference"};

/// Writes the text of a scene, with random values.
class SceneWriter {
 public:
  explicit SceneWriter(std::uint64_t seed) : random_(seed, 7) {}

  template <class List>
  const char* one_of(const List& list) {
    return list[random_.below(static_cast<std::uint32_t>(list.size()))];
  }
  double between(double low, double high) { return random_.uniform(low, high); }
  int whole(int low, int high) {
    return low + static_cast<int>(random_.below(static_cast<std::uint32_t>(high - low + 1)));
  }
  bool chance(double share) { return random_.uniform() < share; }
  std::string name() { return "thing " + std::to_string(++things_); }
  /// Returns one of the names that name() has returned so far.
  std::string some_name() { return "thing " + std::to_string(whole(1, things_)); }
  int things() const { return things_; }

  void line(const std::string& text) { text_ += text + "\n"; }
  void number(const char* key, double value) {
    char text[80];
    std::snprintf(text, sizeof text, "%s = %.6g", key, value);
    line(text);
  }
  void count(const char* key, int value) { line(std::string(key) + " = " + std::to_string(value)); }
  void word(const char* key, const std::string& value) { line(key + (" = \"" + value + "\"")); }
  void vector(const char* key, const Vec3& value) {
    char text[160];
    std::snprintf(text, sizeof text, "%s = [%.6g, %.6g, %.6g]", key, value.x(), value.y(),
                  value.z());
    line(text);
  }
  const std::string& text() const { return text_; }

 private:
  Random random_;
  int things_ = 0;
  std::string text_;
};

Vec3 random_position(SceneWriter& w, double spread_m, double low_m, double high_m) {
  return {w.between(-spread_m, spread_m), w.between(low_m, high_m), w.between(-spread_m, spread_m)};
}

void put_head(SceneWriter& w, bool planar) {
  w.line("[scene]");
  w.word("description", "Made by chance.");
  w.number("duration_s", w.between(1, 3));
  w.count("seed", w.whole(0, 1000));
  if (planar) w.line("planar = true");
  if (w.chance(0.1)) w.vector("gravity", Vec3(w.between(-3, 3), w.between(-20, 0), 0));
  w.line("[limits]");
  if (w.chance(0.2)) w.count("bodies", w.whole(300, 600));
  if (w.chance(0.2)) w.count("ageing", w.whole(50, 200));
  if (w.chance(0.2)) w.count("parts_a_frame", w.whole(1, 200));
  if (w.chance(0.2)) w.count("debris", w.whole(0, 50));
  if (w.chance(0.2)) w.count("dust", w.whole(0, 20));
  w.line("[ground]");
  w.number("friction", w.between(0, 1.5));
  if (w.chance(0.2)) w.number("restitution", w.between(0, 1));
}

/// Writes the parts of a compound on one line, since the solid's own keys follow: piers on a slab,
/// an arch between them and beams over them.
void put_parts(SceneWriter& w) {
  char text[600];
  std::snprintf(text, sizeof text,
                "part = [{ structure = \"box\", size_m = [4, 0.2, 1], material = \"%s\" }, "
                "{ structure = \"%s\", position = [%.6g, 0.2, 0], rotation_deg = [0, %.6g, 0], "
                "mirror = \"x\" }, { structure = \"arch\", position = [0, 0.2, 0] }, "
                "{ structure = \"box\", size_m = [3, 0.3, %.6g], position = [0, 3.2, 0], "
                "repeat = { count = %d, step_m = [0, 0.3, 0], turn_deg = %.6g } }]",
                w.one_of(kMaterials), w.chance(0.5) ? "column" : "reinforced", w.between(0.4, 1.2),
                w.between(-90, 90), w.between(0.1, 0.6), w.whole(1, 3), w.between(-30, 30));
  w.line(text);
}

/// Writes the keys of a small structure, with its material.
void put_structure(SceneWriter& w) {
  switch (w.whole(0, 9)) {
    case 0:
      w.word("structure", "box");
      w.word("material", w.one_of(kMaterials));
      w.vector("size_m", Vec3(w.between(0.2, 3), w.between(0.2, 3), w.between(0.1, 1)));
      w.number("block_m", w.between(0.4, 2));
      break;
    case 1:
      w.word("structure", "brick_wall");
      w.word("material", w.one_of(kMaterials));
      w.count("bricks", w.whole(2, 8));
      w.count("courses", w.whole(1, 8));
      break;
    case 2:
      w.word("structure", "column");
      w.word("material", w.one_of(kMaterials));
      w.count("sides", w.whole(3, 20));
      break;
    case 3:
      w.word("structure", "pane");
      w.number("thickness_m", w.between(0.004, 0.05));
      break;
    case 4:
      w.word("structure", "reinforced");
      break;
    case 5:
      w.word("structure", "stack");
      w.word("material", w.one_of(kMaterials));
      w.count("count", w.whole(1, 8));
      w.vector("size_m", Vec3(w.between(0.2, 1), w.between(0.1, 1), w.between(0.2, 1)));
      break;
    case 6:
      w.word("structure", "bridge");
      w.count("spans", 1);
      w.number("span_m", w.between(2, 5));
      break;
    case 7:
      w.word("structure", "wheel");
      w.count("rings", w.whole(1, 3));
      w.count("sectors", w.whole(6, 24));
      break;
    case 8:
      w.word("structure", "compound");
      put_parts(w);
      break;
    default:
      w.word("structure", "house");
      w.number("width_m", w.between(4, 6));
      w.number("depth_m", w.between(4, 5));
      w.count("storeys", 1);
      w.count("windows", w.whole(0, 1));
  }
}

void put_solid(SceneWriter& w) {
  const bool mesh = w.chance(0.2);
  w.line(mesh ? "[[body]]" : "[[solid]]");
  if (mesh) {
    w.word("mesh", w.one_of(kMeshes));
    w.word("material", w.one_of(kMaterials));
  } else {
    put_structure(w);
  }
  w.word("name", w.name());
  w.vector("position", random_position(w, 4, 0, w.chance(0.3) ? 3 : 0));
  const double turned = w.between(0, 1);
  if (turned < 0.1) w.vector("rotation_deg", 90 * random_position(w, 1, -1, 1));
  if (turned > 0.5) w.vector("rotation_deg", Vec3(0, w.between(-180, 180), 0));
  if (w.chance(0.1)) w.vector("velocity", random_position(w, 10, -5, 5));
  if (w.chance(0.1)) w.vector("angular_velocity", random_position(w, 10, -10, 10));
  if (w.chance(0.5)) w.word("anchored", w.chance(0.1) ? "all" : "bottom");
  if (w.chance(0.1)) w.line("repeat = { count = 2, step_m = [0.5, 4, 0], turn_deg = 20 }");
  if (w.chance(0.1)) w.word("mirror", "z");
}

/// Writes a ball in a joint with the world.
void put_hanging(SceneWriter& w) {
  const Vec3 at = random_position(w, 4, 2, 5);
  w.line("[[ball]]");
  const std::string ball = w.name();
  w.word("name", ball);
  w.vector("position", at);
  w.number("radius_m", w.between(0.05, 0.4));
  w.line("[[joint]]");
  const std::string kind = w.one_of(kJoints);
  w.word("kind", kind);
  w.word("a", ball);
  w.vector("at", at);
  if (kind == "rope" || kind == "distance") w.vector("to", at + random_position(w, 1, 0.5, 2));
  if (w.chance(0.5)) w.number("breaking_N", w.between(10, 1e5));
}

void put_shot(SceneWriter& w) {
  w.line("[[script.shot]]");
  w.number("time_s", w.between(0, 1.5));
  w.vector("from", random_position(w, 8, 1, 6));
  w.vector("at", random_position(w, 3, 0.3, 2));
  w.number("speed_m_s", w.chance(0.1) ? w.between(100, 1000) : w.between(5, 60));
  w.number("radius_m", w.between(0.05, 0.5));
  w.word("name", w.name());
}

void put_blast(SceneWriter& w) {
  w.line("[[script.blast]]");
  w.number("time_s", w.between(0, 1.5));
  w.vector("at", random_position(w, 4, 0, 3));
  w.number("radius_m", w.between(0.5, 6));
  w.number("impulse_Ns_m2", w.between(10, 8000));
}

void put_wrecking_ball(SceneWriter& w) {
  const Vec3 hook = random_position(w, 3, 5, 8);
  w.line("[[script.wrecking_ball]]");
  w.vector("hangs_from", hook);
  w.vector("from", hook + 4 * Vec3(w.chance(0.5) ? 1 : -1, w.between(-1, 0.2), w.between(-1, 1)));
  w.count("links", w.whole(0, 12));
  w.number("radius_m", w.between(0.2, 0.7));
  w.word("name", w.name());
}

void put_script(SceneWriter& w) {
  for (int i = w.whole(1, 5); i > 0; --i) put_shot(w);
  if (w.chance(0.4)) put_blast(w);
  if (w.chance(0.2)) put_wrecking_ball(w);
}

/// Writes stacks and brick walls of steel, and balls, for a planar scene.
void put_planar(SceneWriter& w) {
  for (int i = w.whole(1, 4); i > 0; --i) {
    w.line("[[solid]]");
    const bool wall = w.chance(0.5);
    w.word("structure", wall ? "brick_wall" : "stack");
    if (wall) w.count("bricks", w.whole(2, 10));
    w.count(wall ? "courses" : "count", w.whole(1, 10));
    w.word("material", "steel");
    w.word("name", w.name());
    w.vector("position", Vec3(w.between(-6, 6), w.between(0, 2), 0));
  }
  for (int i = w.whole(1, 4); i > 0; --i) {
    w.line("[[ball]]");
    w.word("name", w.name());
    w.number("radius_m", w.between(0.1, 0.8));
    w.vector("position", Vec3(w.between(-9, 9), w.between(1, 6), 0));
    w.vector("velocity", Vec3(w.between(-30, 30), w.between(-10, 10), 0));
  }
}

}  // namespace

RandomScene random_scene(std::uint64_t seed) {
  SceneWriter w(seed);
  RandomScene scene{"made", "", "made.toml", w.one_of(kPresets)};
  if (w.chance(0.25)) {
    std::vector<scenes::CatalogEntry> shipped = scenes::catalog();
    std::erase_if(shipped, [](const auto& entry) { return entry.name == "arena"; });  // too large
    const auto& entry = shipped[static_cast<std::size_t>(w.whole(0, int(shipped.size()) - 1))];
    scene.name = entry.name, scene.file = entry.file.string();
    scene.text = scenes::read_text(entry.file) + "\n";
    if (entry.name != "planar_wall") put_script(w);
  } else if (w.chance(0.1)) {
    put_head(w, true);
    put_planar(w);
  } else {
    put_head(w, false);
    for (int i = w.whole(1, 4); i > 0; --i) put_solid(w);
    if (w.chance(0.4)) put_hanging(w);
    put_script(w);
  }
  scene.text += w.text();
  return scene;
}

}  // namespace sunder::fuzz
