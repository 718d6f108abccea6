// The files of a golden, and the result of a comparison.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/model/frame.h"
#include "render/image/compare.h"

namespace sunder::app {

/// NAME.json: how the baseline was made and how far a picture may be from it.
struct Golden {
  std::filesystem::path folder;
  std::string name;
  int width = 640;
  int height = 360;
  render::Thresholds thresholds;
  std::string command;   ///< That remakes it.
  std::string hash;      ///< Of the baseline's pixels.
  std::string renderer;  ///< That drew the baseline.
  std::string cpu;       ///< On which.

  std::filesystem::path file(const char* extension) const { return folder / (name + extension); }
  std::filesystem::path frame_file() const { return file(".frame"); }
  std::filesystem::path picture_file() const { return file(".png"); }
};

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
  std::string verdict;
  bool passed = false;
};
/// As JSON.
std::string format_results(const std::vector<GoldenResult>& results);

/// 16 hexadecimal digits over size and pixels.
std::string pixel_hash(const render::Image& image);
/// The same picture in a smaller file: meshes that no instance shows are dropped.
Frame without_unused_meshes(const Frame& frame);

}  // namespace sunder::app
