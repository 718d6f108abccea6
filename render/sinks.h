// Sinks that render frames to files: video by the ffmpeg program, or PNG images.
#pragma once

#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"

namespace sunder::render {

/// Size, view and layers of images.
struct RenderOptions {
  int width = 1280;
  int height = 720;
  std::string gl = "auto";  ///< auto | egl-device:N | egl-surfaceless | osmesa
  /// materials | convexes | compounds | asleep | wireframe | exploded | contacts | stress | islands
  /// | broadphase; the last four need Frame::inspection.
  std::string view_mode = "materials";
  /// Number of samples per image, averaged in linear light: each is offset by less than a pixel
  /// and, within the time the view's shutter is open, in time.
  int samples = 1;
  /// Leaves out ground and sky and makes uncovered pixels transparent. Images only.
  bool transparent = false;
  std::vector<std::string> layers = {};  ///< Names of data layers to write, see layers.h.
  bool hud = false;                      ///< Draws frame number, time and counts into the corner.
  bool time_passes = false;  ///< Waits for the GPU after each pass to fill pass_times().
  int frames_per_s = 60;     ///< Frame rate of a video.
};

class Renderer;  // renderer.h

/// Makes a sink that renders frames to `path`. Ending in .mp4 or .webm: a video; in .png: an image
/// of the last frame; otherwise: a folder of frame_00000.png and so on. Layers are written beside
/// each image as X_depth.png, X_depth_m.exr and so on. A file exists only when it is complete.
/// Throws InputError if ffmpeg is missing (naming the package) or the options cannot be met,
/// FileError if the path cannot be written. The sink draws on the thread that makes it.
std::unique_ptr<FrameSink> make_picture_sink(const std::filesystem::path& path,
                                             const RenderOptions& options);
/// Makes a sink that uses `renderer`, which must outlive it. With `resume`, images that exist in
/// the folder are kept and not drawn again. For `is_stopped` see Encoder (image/encoder.h).
std::unique_ptr<FrameSink> make_picture_sink(const std::filesystem::path& path, Renderer& renderer,
                                             bool resume = false, int frames_per_s = 60,
                                             std::function<bool()> is_stopped = {});
/// Makes the folder of a file to be written. Throws InputError if `path` is a folder itself,
/// FileError if the folder cannot be made or written.
void check_output_path(const std::filesystem::path& path);

}  // namespace sunder::render
