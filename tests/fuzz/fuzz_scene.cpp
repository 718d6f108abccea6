// Fuzz target: any bytes as a scene file, and those after a zero as a --set, give a scene whose
// first frames are finite, or an InputError.
#include <cstdint>
#include <string>

#include "engine/base/check.h"
#include "engine/model/frame.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"
#include "tests/fuzz/fuzz_target.h"

namespace sunder {
namespace {

/// True if the scene is small enough for a fuzzer to simulate.
bool is_small(const Scene& scene) {
  std::size_t convexes = 0, cells = 0;
  for (const Solid& solid : scene.solids) convexes += solid.compound.convexes.size();
  for (const Material& material : scene.materials)
    cells = std::max(cells, static_cast<std::size_t>(material.pattern.cells));
  return scene.solids.size() + scene.balls.size() <= 20 && convexes <= 100 && cells <= 500 &&
         scene.accuracy.dt_s >= 1.0 / 241 && scene.accuracy.substeps <= 8 &&
         scene.solver.sweeps <= 4;
}

void check_finite(const Frame& frame) {
  for (const FrameBody& body : frame.bodies) {
    SUNDER_CHECK(body.X_WB.position.allFinite() && body.X_WB.rotation.coeffs().allFinite());
    SUNDER_CHECK(body.velocity_W.allFinite() && body.angular_velocity_W.allFinite());
  }
}

void load(std::span<const std::uint8_t> bytes) {
  if (bytes.size() > 4096) return;
  std::string text(bytes.begin(), bytes.end());
  scenes::LoadOptions options;
  if (const std::size_t end = text.find('\0'); end != std::string::npos) {
    options.set.push_back(text.substr(end + 1));
    text.resize(end);
  }
  if (text.find("mesh") != std::string::npos)
    return;  // meshes have their own targets, and their cache is on disk
  try {
    const Scene scene = scenes::parse_scene(text, "no_such_folder/fuzz.toml", options);
    for (const Solid& solid : scene.solids) SUNDER_CHECK(!solid.compound.convexes.empty());
    SUNDER_CHECK(!scenes::run_info(scene).modelled.empty());
    if (!is_small(scene)) return;
    const auto simulation = scenes::make_simulation(scene);
    for (int i = 0; i < 3; ++i)
      if (const FramePtr frame = simulation->next()) check_finite(*frame);
  } catch (const InputError&) {
  }
}

const fuzz::Registration scene_target("scene", load);

}  // namespace
}  // namespace sunder
