// A program that uses the installed library, as a game or a tool would: scenes made in code and
// from text, statistics, a recording, an image. Its exit code is 1 if a check fails.
#include <sunder/sunder.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <map>
#include <span>
#include <string>

namespace {

int wrong = 0;

void expect(bool right, const char* what) {
  if (right) return;
  std::printf("wrong: %s\n", what);
  ++wrong;
}

/// Simulates a steel box that falls from 10 m with 8 m/s² and comes to rest on the ground.
void a_scene_made_in_code() {
  sunder::Scene scene;
  scene.name = "falling box";
  scene.duration_s = 4;
  scene.gravity_W = sunder::Vec3(0, -8, 0);
  scene.materials = sunder::scenes::builtin_materials();
  sunder::Part part;
  part.polyhedron = sunder::make_box({-0.5, -0.5, -0.5}, {0.5, 0.5, 0.5});
  part.material = sunder::scenes::material_named(scene, "steel");
  sunder::Solid box;
  box.name = "box";
  box.compound = sunder::scenes::make_compound({part});
  box.X_WR.position = {0, 10, 0};
  scene.solids.push_back(box);
  const sunder::Vec3 corners[] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  expect(sunder::make_hull(corners).faces.size() == 4, "sunder.h has make_hull()");
  sunder::Solid ring;
  ring.name = "ring";
  ring.compound = sunder::scenes::make_compound("torus:1,0.3", part.material);
  ring.X_WR.position = {5, 1, 0};
  scene.solids.push_back(ring);

  const auto simulation = sunder::scenes::make_simulation(scene);
  double after_a_second = 0, at_the_end = 0;
  while (const sunder::FramePtr frame = simulation->next()) {
    for (const sunder::FrameBody& body : frame->bodies) {
      if (!body.is_static && std::abs(body.X_WB.position.x()) < 1) {
        at_the_end = body.X_WB.position.y();
      }
    }
    if (frame->index == 60) after_a_second = at_the_end;
  }
  std::printf("height after 1 s: %.3f m, at the end: %.3f m\n", after_a_second, at_the_end);
  expect(std::abs(after_a_second - (10 - 8.0 / 2)) < 0.1, "it falls by the scene's gravity");
  expect(std::abs(at_the_end - 0.5) < 0.02, "it rests on the ground");
}

constexpr const char* kShot = R"(
[scene]
description = "A steel ball breaks a pane."
duration_s = 1
[[solid]]
structure = "pane"
[[script.shot]]
time_s = 0
from = [0, 1.2, 4]
at = [0, 1, 0]
speed_m_s = 30
radius_m = 0.1
)";

/// Counts breaks by the name of the solid and its material.
class Breaks final : public sunder::FrameSink {
 public:
  void take(const sunder::FramePtr& frame) override {
    for (const sunder::BreakEvent& event : frame->breaks) {
      const std::string& name = (*frame->names)[event.name];
      ++counts_[name + " of " + (*frame->materials)[event.material.value].name];
    }
  }
  const std::map<std::string, int>& counts() const { return counts_; }

 private:
  std::map<std::string, int> counts_;
};

void a_scene_from_a_text() {
  const sunder::Scene scene = sunder::scenes::parse_scene(kShot, "shot.toml");
  sunder::scenes::SimulationOptions options;
  options.threads = 2;
  options.warn = [](const std::string& warning) { std::printf("%s\n", warning.c_str()); };
  sunder::Statistics statistics(sunder::scenes::run_info(scene));
  sunder::StateHash hash;
  sunder::RecordingWriter writer("shot.take");
  Breaks breaks;
  sunder::FrameSink* const sinks[] = {&statistics, &hash, &writer, &breaks};
  sunder::pump(*sunder::scenes::make_simulation(scene, options), sinks);
  std::printf("%sstate hash %s\n", statistics.table().c_str(), hash.hex().c_str());
  for (const auto& [what, count] : breaks.counts())
    std::printf("%s breaks %d times\n", what.c_str(), count);
  expect(breaks.counts().contains("pane of glass"), "the ball breaks the pane");
  expect(statistics.json(hash.hex(), false).find(hash.hex()) != std::string::npos,
         "the figures hold the state hash");

  sunder::RecordingReader reader("shot.take");
  sunder::StateHash played;
  sunder::FrameSink* const player[] = {&played};
  expect(reader.frames() == 61, "a take holds all frames");
  sunder::pump(reader, player);
  expect(played.hex() == hash.hex(), "a take is played as it was recorded");
}

/// Draws a recording into a PNG file, if there is a GL driver.
void a_picture() {
  sunder::RecordingReader reader("shot.take");
  sunder::render::RenderOptions options;
  options.width = 64;
  options.height = 48;
  try {
    const auto picture = sunder::render::make_picture_sink("shot.png", options);
    sunder::FrameSink* const sinks[] = {picture.get()};
    sunder::pump(reader, sinks);
    expect(std::filesystem::file_size("shot.png") > 0, "the last frame is drawn");
  } catch (const sunder::InputError& error) {
    std::printf("no picture: %s\n", error.what());
  }
}

/// Draws one frame into an image in memory, and writes it to a file, if there is a GL driver.
void a_frame_drawn() {
  sunder::RecordingReader reader("shot.take");
  reader.seek(30);
  const sunder::FramePtr frame = reader.next();
  sunder::render::RenderOptions options;
  options.width = 64;
  options.height = 48;
  options.layers = {"ids"};
  try {
    sunder::render::Renderer renderer(options);
    const sunder::render::Image image = renderer.draw(*frame);
    expect(image.width == 64 && image.height == 48 && image.rgb.size() == 3u * 64 * 48,
           "a frame is drawn in the size that was asked for");
    expect(std::ranges::adjacent_find(image.rgb, std::ranges::not_equal_to()) != image.rgb.end(),
           "there is something in the picture");
    expect(renderer.layers().size() == 1 && renderer.layers()[0].name == "ids",
           "its layers are those of the options");
    sunder::render::write_png("frame.png", image);
    expect(sunder::render::read_png("frame.png") == image, "a file has the same pixels");
  } catch (const sunder::InputError& error) {
    std::printf("no frame: %s\n", error.what());
  }
  options.width = 0;
  try {
    sunder::render::Renderer renderer(options);
    expect(false, "a picture without width is refused");
  } catch (const sunder::InputError& error) {
    std::printf("refused: %s\n", error.what());
  }
}

void scenes_by_name() {
  expect(sunder::scenes::catalog().size() >= 5, "the catalogue was installed");
  expect(sunder::scenes::load_scene("stack").name == "stack", "its scenes load by name");
  try {
    sunder::scenes::load_scene("stack", {}, "no/such/folder");
    expect(false, "without a catalogue a name is refused");
  } catch (const sunder::InputError& error) {
    std::printf("refused: %s\n", error.what());
  }
}

}  // namespace

int main() {
  a_scene_made_in_code();
  a_scene_from_a_text();
  a_picture();
  a_frame_drawn();
  scenes_by_name();
  return wrong == 0 ? 0 : 1;
}
