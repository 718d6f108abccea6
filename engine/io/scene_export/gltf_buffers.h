// Accessors and buffer views of a glTF document whose data do not fit in memory.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <vector>

#include "engine/io/scene_export/motion_keys.h"
#include "engine/io/scene_export/quantized_mesh.h"
#include "engine/io/scene_export/spool.h"
#include "engine/io/text_writer.h"

namespace sunder {

/// The binary data of a glTF document and their description. Each kind of data has one buffer view,
/// in a temporary file until the document is written; accessors are numbered in the order of calls.
class GltfBuffers {
 public:
  using Accessor = std::uint32_t;
  struct MeshAccessors {
    Accessor positions = 0, normals = 0;
    std::optional<Accessor> uvs;
    std::vector<Accessor> indices;  ///< For each part of the mesh.
  };

  /// `path`: the document, which is named in errors; throws FileError if its folder is not
  /// writable.
  GltfBuffers(const std::filesystem::path& path, int frames_per_s);

  MeshAccessors add_mesh(const QuantizedMesh& mesh);
  /// Returns the accessor of the times of frames, ascending; equal lists may share one.
  Accessor add_times(std::span<const std::uint32_t> frames);
  Accessor add_vectors(std::span<const Vec3f> vectors);
  Accessor add_rotations(std::span<const RotationKeys::Key> rotations);

  /// Completes the data: the times of `frames` frames. Nothing may be added afterwards.
  void finish(std::uint32_t frames);
  /// Appends the elements of "accessors".
  void describe_accessors(TextWriter& out) const;
  /// Appends the elements of "bufferViews", first those of the data, then one for each size in
  /// `more`. Returns the length of the buffer.
  std::uint64_t describe_views(TextWriter& out, std::span<const std::size_t> more) const;
  /// Returns the number of views of the data.
  std::size_t views() const;
  /// Passes the data on in the order of the views.
  void read(const std::function<void(std::span<const std::byte>)>& take);

 private:
  enum View { kVertices, kUvs, kShortIndices, kIndices, kFrameTimes, kTimes, kVectors, kRotations };
  static constexpr std::size_t kViews = 8;
  enum class Kind : std::uint8_t {
    kPosition,
    kNormal,
    kUv,
    kShortIndex,
    kIndex,
    kFrameTime,
    kTime,
    kVector,
    kRotation
  };
  struct Description {
    Kind kind = Kind::kTime;
    std::uint32_t count = 0;
    std::uint64_t offset = 0;
    std::array<float, 6> bounds = {};  ///< Least and greatest values of positions and times.
  };

  Accessor add(Kind kind, std::size_t count, std::uint64_t offset,
               const std::array<float, 6>& bounds = {});
  void describe(const Description& accessor, TextWriter& out) const;
  /// Returns the number of a view among those that are not empty.
  std::size_t number_of(View view) const;
  float time_s(std::uint32_t frame) const;
  std::uint64_t add_indices(const std::vector<std::uint32_t>& indices, bool is_short);

  std::vector<Spool> data_;  ///< By View.
  double frames_per_s_;
  std::vector<Description> accessors_;
  /// Accessors of times that are likely to be used again.
  std::map<std::vector<std::uint32_t>, Accessor> times_;
};

}  // namespace sunder
