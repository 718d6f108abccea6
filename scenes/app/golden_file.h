// The files of a golden, and the result of a comparison.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "bench/timing/frame_states.h"
#include "bench/timing/verdict.h"
#include "engine/model/scene.h"
#include "render/image/compare.h"
#include "render/sinks.h"

namespace sunder::app {

/// NAME.json: how frame and baseline were made, and how far a picture may be from it.
struct Golden {
  std::filesystem::path folder;
  std::string name;
  std::string scene;  ///< File (from the folder on) or name; or a stored frame, drawn differently.
  scenes::LoadOptions load;
  int frame = 0;  ///< Of the scene.
  int width = 640;
  int height = 360;
  std::string view_mode = "materials";  ///< One that looks inside: the frame says what is there.
  bool hud = false;
  render::Thresholds thresholds;
  std::string hash;      ///< Of the baseline's pixels.
  std::string renderer;  ///< That drew the baseline.
  std::string cpu;       ///< On which.

  std::filesystem::path file(const char* extension) const { return folder / (name + extension); }
  std::filesystem::path picture_file() const { return file(".png"); }
  std::filesystem::path hashes_file() const { return folder / "hashes.txt"; }
  /// Whether it is of a scene, and not another picture of a frame that a golden has.
  bool is_simulated() const { return !scene.ends_with(".frame"); }
  /// The scene's file, if it lies where the golden says, or its name.
  std::string scene_file() const;
  std::filesystem::path frame_file() const;
  /// What is simulated to be held against stored states.
  bench::GuardedRun run() const { return {name, scene_file(), load, frame}; }
  /// The commands that make it again, for a shell.
  std::string command() const;
  std::string accept_command() const;
};

/// That makes what there is now of these the baseline.
std::string accept_command(const std::filesystem::path& folder, const std::string& names);

/// Names of the goldens in a folder, sorted. Throws InputError if there are none.
std::vector<std::string> golden_names(const std::filesystem::path& folder);
/// Throws InputError if there is no such golden, naming those there are.
Golden read_golden(const std::filesystem::path& folder, const std::string& name);
void write_golden(const Golden& golden);

struct GoldenResult {
  Golden golden;
  render::Image baseline;
  render::Image actual;
  render::Difference difference;
  std::string renderer;
  /// The first is on the drawing; if a scene is simulated, the next is on how that is seen, and the
  /// others are on its simulations.
  std::vector<bench::Verdict> verdicts;

  bool drawing_passed() const;
  bool passed() const;
  /// Of drawing, scene and simulation, which are the same and how others differ.
  std::string sentence() const;
};
/// As JSON.
std::string format_results(const std::vector<GoldenResult>& results);

/// Names of what is seen otherwise in a scene than in a frame that was stored of it: parts of its
/// view, colours of its materials and paints, materials of its solids; empty if nothing is.
std::string seen_otherwise(const Frame& stored, const Scene& scene);
/// 16 hexadecimal digits over size and pixels.
std::string pixel_hash(const render::Image& image);
/// The same picture in a smaller file: meshes that no instance shows are dropped.
Frame without_unused_meshes(const Frame& frame);

}  // namespace sunder::app
