// Writing of a whole run as animated glTF 2.0 (GLB).
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>

#include "engine/model/frame.h"

namespace sunder {

/// Number of times a second that the debris of a file moves.
inline constexpr int kChipFramesPerSecond = 15;

struct GltfSceneOptions {
  std::string scene;           ///< Name of the scene.
  double tolerance_m = 1e-3;   ///< Largest distance of an interpolated position; above 0.
  double tolerance_deg = 0.1;  ///< Largest angle of an interpolated rotation; from 0.01 on.
  int frames_per_s = 60;       ///< A divisor of 60.
  bool particles = false;  ///< True to write debris, as it is kChipFramesPerSecond times a second.
};

/// Sizes of what was written.
struct GltfSceneFigures {
  std::uint64_t frames = 0, bodies = 0, meshes = 0, breaks = 0;
  std::uint64_t chips = 0;    ///< Instances of debris in all its frames.
  std::uint64_t samples = 0;  ///< Poses of bodies in all frames.
  std::uint64_t keys = 0;     ///< Keys of positions and rotations that were kept of these.
  std::uint64_t bytes = 0;
};

/// A sink that writes a run as a GLB: a node for each body with keys of its motion, which appears
/// and disappears by scale; the meshes in 16-bit coordinates; camera, sun, materials and images.
/// docs/exchange.md describes the file. Data that grow with the run are kept in temporary files
/// beside it; it is written by finish(), under a temporary name, and renamed. Throws FileError.
class GltfSceneWriter final : public FrameSink {
 public:
  explicit GltfSceneWriter(const std::filesystem::path& path, const GltfSceneOptions& options = {});
  ~GltfSceneWriter() override;
  void take(const FramePtr& frame) override;
  /// Writes the file; without any frame, writes nothing.
  void finish() override;
  /// Returns the figures; complete after finish().
  const GltfSceneFigures& figures() const;

 private:
  class Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace sunder
