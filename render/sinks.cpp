// The three kinds of picture sinks: a video, an image of the last frame, a folder of images.
#include "render/sinks.h"

#include <unistd.h>

#include <cstdio>
#include <utility>

#include "engine/base/check.h"
#include "engine/io/file_ending.h"
#include "render/image/encoder.h"
#include "render/image/exr.h"
#include "render/renderer.h"

namespace sunder::render {
namespace {

/// Makes `folder` if it does not exist. Throws FileError if that fails or it cannot be written.
void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  if (!folder.empty()) std::filesystem::create_directories(folder, error);
  if (error)
    throw FileError(folder.string() + ": the folder cannot be created: " + error.message());
  if (!folder.empty() && ::access(folder.c_str(), W_OK) != 0) {
    throw FileError(folder.string() + ": the folder cannot be written to; check its permissions");
  }
}

/// Draws frames in order, each with the previous one for motion blur.
class FrameDrawer {
 public:
  explicit FrameDrawer(Renderer& renderer) : renderer_(renderer) {}
  void take(const FramePtr& frame) { before_ = std::exchange(frame_, frame); }
  /// Returns true if no frame was taken yet.
  bool empty() const { return !frame_; }
  Image picture() { return renderer_.draw(*frame_, before_.get()); }
  /// Writes the layers, then the image, so that the image exists only when all files do.
  void write(const std::filesystem::path& path) {
    const Image image = picture();
    for (const Layer& layer : renderer_.layers()) {
      const std::filesystem::path file =
          path.parent_path() / (path.stem().string() + "_" + layer.name);
      if (layer.metres.empty()) {
        write_png(file.string() + ".png", layer.image);
      } else {
        write_exr(file.string() + ".exr", layer.metres, image.width, image.height);
      }
    }
    write_png(path, image);
  }

 private:
  Renderer& renderer_;
  FramePtr before_, frame_;
};

class VideoSink final : public FrameSink {
 public:
  VideoSink(const std::filesystem::path& path, Renderer& renderer, int frames_per_s,
            std::function<bool()> is_stopped)
      : drawer_(renderer),
        encoder_(path, renderer.width(), renderer.height(), frames_per_s, std::move(is_stopped)) {}
  void take(const FramePtr& frame) override {
    drawer_.take(frame);
    encoder_.add(drawer_.picture());
  }
  void finish() override { encoder_.finish(); }

 private:
  FrameDrawer drawer_;
  Encoder encoder_;
};

class LastImageSink final : public FrameSink {
 public:
  LastImageSink(std::filesystem::path path, Renderer& renderer)
      : path_(std::move(path)), drawer_(renderer) {}
  void take(const FramePtr& frame) override { drawer_.take(frame); }
  void finish() override {
    if (!drawer_.empty()) drawer_.write(path_);
  }

 private:
  std::filesystem::path path_;
  FrameDrawer drawer_;
};

class ImagesSink final : public FrameSink {
 public:
  ImagesSink(std::filesystem::path folder, Renderer& renderer, bool resume)
      : folder_(std::move(folder)), drawer_(renderer), resume_(resume) {
    make_folder(folder_);
  }

  void take(const FramePtr& frame) override {
    char name[32];
    std::snprintf(name, sizeof name, "frame_%05llu.png",
                  static_cast<unsigned long long>(frame->index));
    const std::filesystem::path picture = folder_ / name;
    drawer_.take(frame);
    if (!resume_ || !std::filesystem::exists(picture)) drawer_.write(picture);
  }
  void finish() override {}

 private:
  std::filesystem::path folder_;
  FrameDrawer drawer_;
  bool resume_;
};

/// A sink that owns its renderer.
class RenderingSink final : public FrameSink {
 public:
  RenderingSink(const std::filesystem::path& path, const RenderOptions& options)
      : renderer_(options),
        sink_(make_picture_sink(path, renderer_, false, options.frames_per_s)) {}
  void take(const FramePtr& frame) override { sink_->take(frame); }
  void finish() override { sink_->finish(); }

 private:
  Renderer renderer_;
  std::unique_ptr<FrameSink> sink_;
};

}  // namespace

void check_output_path(const std::filesystem::path& path) {
  if (std::filesystem::is_directory(path)) {
    throw InputError(path.string() + ": is a folder; give a file name");
  }
  make_folder(path.parent_path());
}

std::unique_ptr<FrameSink> make_picture_sink(const std::filesystem::path& path,
                                             const RenderOptions& options) {
  return std::make_unique<RenderingSink>(path, options);
}

std::unique_ptr<FrameSink> make_picture_sink(const std::filesystem::path& path, Renderer& renderer,
                                             bool resume, int frames_per_s,
                                             std::function<bool()> is_stopped) {
  const std::string extension = path.extension().string();
  const bool is_video = has_ending(extension, ".mp4") || has_ending(extension, ".webm");
  if (is_video || has_ending(extension, ".png")) {
    if (resume) throw InputError(path.string() + ": only images in a folder (DIR/) can be resumed");
    const RenderOptions& options = renderer.options();
    if (is_video && (options.transparent || !options.layers.empty())) {
      throw InputError(
          path.string() +
          ": a video cannot have transparency or layers; write images to a folder (DIR/)");
    }
    check_output_path(path);
    if (is_video)
      return std::make_unique<VideoSink>(path, renderer, frames_per_s, std::move(is_stopped));
    return std::make_unique<LastImageSink>(path, renderer);
  }
  const std::filesystem::path folder = path.has_filename() ? path : path.parent_path();
  if (!extension.empty() && !std::filesystem::is_directory(folder)) {
    throw InputError(path.string() +
                     ": unknown kind of output; use .mp4, .webm, .png, or a folder (ending in /)");
  }
  return std::make_unique<ImagesSink>(folder, renderer, resume);
}

}  // namespace sunder::render
