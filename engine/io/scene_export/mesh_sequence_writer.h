// Writing of a run as one mesh file a frame.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/io/mesh/export_folder.h"
#include "engine/io/mesh/export_model.h"
#include "engine/model/frame.h"

namespace sunder {

enum class SequenceFormat : std::uint8_t { kObj, kPly };

/// Returns the format of a name, "obj" or "ply"; throws InputError for another.
SequenceFormat sequence_format(const std::string& name);

/// A sink that writes a folder with a file for each frame, frame_00000.obj or .ply, of the
/// triangles of all bodies in the world, in single precision. OBJ files have an object for each
/// body, and materials.mtl with the images of mesh files beside them; PLY files are binary, with
/// normals, and the colour and the key of the body at each vertex. The folder is written under a
/// temporary name and renamed by finish(); an existing folder is replaced if it has only such
/// files. Throws InputError if it has others, and FileError if it cannot be written.
class MeshSequenceWriter final : public FrameSink {
 public:
  /// `frames_per_s`: a divisor of 60.
  MeshSequenceWriter(const std::filesystem::path& folder, SequenceFormat format,
                     int frames_per_s = 60);
  void take(const FramePtr& frame) override;
  /// Gives the folder its name; without any frame, writes nothing.
  void finish() override;
  std::uint64_t frames() const { return frames_; }
  std::uint64_t bytes() const { return bytes_; }

 private:
  void write(const std::string& name, std::string_view content);
  void write_materials(const Frame& frame);

  ExportFolder folder_;
  SequenceFormat format_;
  std::uint64_t step_;
  std::vector<Model::Material> materials_;
  std::uint64_t taken_ = 0, frames_ = 0, bytes_ = 0;
};

}  // namespace sunder
