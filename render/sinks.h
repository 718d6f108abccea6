// Frames to files: video through the ffmpeg program, or PNG images.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"

namespace sunder::render {

struct RenderOptions {
  int width = 1280;
  int height = 720;
  std::string gl = "auto";  ///< auto | egl-device:N | egl-surfaceless | osmesa
  /// materials | convexes | compounds | asleep | wireframe | exploded
  std::string view_mode = "materials";
  /// Pictures that each is the mean of, in linear light: each a little aside, by less than a pixel,
  /// and, while the view's shutter is open, a little later.
  int samples = 1;
  /// Neither ground nor sky: what is not covered is transparent. Images only.
  bool transparent = false;
  std::vector<std::string> layers = {};  ///< Images beside each: layers.h.
  bool hud = false;                      ///< Frame number, time and counts in the corner.
  bool time_passes = false;  ///< Waits for the GPU after each pass, to fill pass_times().
  int frames_per_s = 60;     ///< Of a video.
};

/// Draws with OpenGL, off-screen, on the thread that makes it; renderer.h.
class Renderer;

/// `path` ending in .mp4 or .webm: a video; .png: the last frame taken; otherwise a directory of
/// frame_00000.png and so on; layers are X_depth.png, X_depth_m.exr and so on beside each. No file
/// stands there until it is complete. Throws InputError if ffmpeg is missing (naming the package)
/// or the options cannot be met, FileError if the place cannot be written.
std::unique_ptr<FrameSink> make_picture_sink(const std::filesystem::path& path,
                                             const RenderOptions& options);
/// The same with a renderer that is there already, and must outlive the sink; `resume`: pictures
/// that are in the directory stay as they are, and are not drawn.
std::unique_ptr<FrameSink> make_picture_sink(const std::filesystem::path& path, Renderer& renderer,
                                             bool resume = false, int frames_per_s = 60);
/// Makes the folder of a file that is to be written. Throws InputError if `path` is a folder
/// itself, FileError if that cannot be written to.
void check_place(const std::filesystem::path& path);

}  // namespace sunder::render
