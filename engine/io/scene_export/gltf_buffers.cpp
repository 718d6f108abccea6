#include "engine/io/scene_export/gltf_buffers.h"

#include <cstddef>
#include <string_view>

namespace sunder {
namespace {

// Constants of the format.
constexpr int kByte = 5120, kShort = 5122, kUnsignedShort = 5123, kUnsigned = 5125, kFloat = 5126;
constexpr int kArrayBuffer = 34962, kElementBuffer = 34963;

/// The properties of accessors of a kind.
struct KindProperties {
  int component = kFloat;
  bool is_normalized = false;
  std::string_view type = "SCALAR";
  std::size_t bounds = 0;  ///< Number of components that have bounds in the file.
};

/// The properties of a view.
struct ViewProperties {
  std::size_t stride = 0;  ///< 0: none is given.
  int target = 0;          ///< 0: none.
};

constexpr std::uint32_t kLeastUnsignedVertices = 65536;  // number of vertices that need 32 bits

template <class Item>
std::span<const std::byte> bytes_of(std::span<const Item> items) {
  return std::as_bytes(items);
}

std::uint64_t aligned(std::uint64_t size) { return (size + 3) / 4 * 4; }

}  // namespace

GltfBuffers::GltfBuffers(const std::filesystem::path& path, int frames_per_s)
    : frames_per_s_(frames_per_s) {
  for (std::size_t view = 0; view < kViews; ++view) data_.emplace_back(path);
}

float GltfBuffers::time_s(std::uint32_t frame) const {
  return static_cast<float>(frame / frames_per_s_);
}

GltfBuffers::Accessor GltfBuffers::add(Kind kind, std::size_t count, std::uint64_t offset,
                                       const std::array<float, 6>& bounds) {
  accessors_.push_back({kind, static_cast<std::uint32_t>(count), offset, bounds});
  return static_cast<Accessor>(accessors_.size() - 1);
}

GltfBuffers::MeshAccessors GltfBuffers::add_mesh(const QuantizedMesh& mesh) {
  static_assert(sizeof(QuantizedMesh::Vertex) == 12);
  MeshAccessors made;
  const std::uint64_t offset = data_[kVertices].size();
  std::array<float, 6> bounds = {};
  for (std::size_t i = 0; i < 3; ++i) bounds[i] = mesh.low[i], bounds[i + 3] = mesh.high[i];
  made.positions = add(Kind::kPosition, mesh.vertices.size(), offset, bounds);
  made.normals =
      add(Kind::kNormal, mesh.vertices.size(), offset + offsetof(QuantizedMesh::Vertex, normal));
  data_[kVertices].write(bytes_of(std::span(mesh.vertices)));
  if (!mesh.uvs.empty()) {
    made.uvs = add(Kind::kUv, mesh.uvs.size(), data_[kUvs].size());
    data_[kUvs].write(bytes_of(std::span(mesh.uvs)));
  }
  const bool is_short = mesh.vertices.size() < kLeastUnsignedVertices;
  for (const QuantizedMesh::Part& part : mesh.parts) {
    made.indices.push_back(add(is_short ? Kind::kShortIndex : Kind::kIndex, part.indices.size(),
                               add_indices(part.indices, is_short)));
  }
  return made;
}

/// Writes indices; returns their offset in the view.
std::uint64_t GltfBuffers::add_indices(const std::vector<std::uint32_t>& indices, bool is_short) {
  Spool& data = data_[is_short ? kShortIndices : kIndices];
  const std::uint64_t offset = data.size();
  if (is_short) {
    const std::vector<std::uint16_t> narrow(indices.begin(), indices.end());
    data.write(bytes_of(std::span(narrow)));
  } else {
    data.write(bytes_of(std::span(indices)));
  }
  return offset;
}

GltfBuffers::Accessor GltfBuffers::add_times(std::span<const std::uint32_t> frames) {
  constexpr std::size_t kMaxShared = 4;  // longer lists are hardly ever equal
  const std::uint32_t first = frames.front(), last = frames.back();
  const bool is_run = last - first + 1 == frames.size();
  std::vector<std::uint32_t> name(frames.begin(), frames.end());
  if (is_run) name = {first, last, static_cast<std::uint32_t>(frames.size())};
  const bool is_shared = is_run || frames.size() <= kMaxShared;
  if (is_shared) {
    if (!is_run) name.push_back(0);  // unlike the name of any run
    const auto known = times_.find(name);
    if (known != times_.end()) return known->second;
  }
  std::uint64_t offset = sizeof(float) * first;
  if (!is_run) {
    offset = data_[kTimes].size();
    std::vector<float> times;
    for (const std::uint32_t frame : frames) times.push_back(time_s(frame));
    data_[kTimes].write(bytes_of(std::span<const float>(times)));
  }
  const Accessor made = add(is_run ? Kind::kFrameTime : Kind::kTime, frames.size(), offset,
                            {time_s(first), 0, 0, time_s(last)});
  if (is_shared) times_.emplace(std::move(name), made);
  return made;
}

GltfBuffers::Accessor GltfBuffers::add_vectors(std::span<const Vec3f> vectors) {
  static_assert(sizeof(Vec3f) == 12);
  const std::uint64_t offset = data_[kVectors].size();
  data_[kVectors].write(bytes_of(vectors));
  return add(Kind::kVector, vectors.size(), offset);
}

GltfBuffers::Accessor GltfBuffers::add_rotations(std::span<const RotationKeys::Key> rotations) {
  const std::uint64_t offset = data_[kRotations].size();
  data_[kRotations].write(bytes_of(rotations));
  return add(Kind::kRotation, rotations.size(), offset);
}

void GltfBuffers::finish(std::uint32_t frames) {
  std::vector<float> times;
  for (std::uint32_t frame = 0; frame < frames; ++frame) times.push_back(time_s(frame));
  data_[kFrameTimes].write(bytes_of(std::span<const float>(times)));
  for (Spool& data : data_) data.align();
}

std::size_t GltfBuffers::number_of(View view) const {
  std::size_t number = 0;
  for (std::size_t v = 0; v < view; ++v) number += data_[v].size() > 0;
  return number;
}

std::size_t GltfBuffers::views() const {
  std::size_t number = 0;
  for (const Spool& data : data_) number += data.size() > 0;
  return number;
}

void GltfBuffers::describe(const Description& accessor, TextWriter& out) const {
  static constexpr KindProperties kKinds[] = {{kShort, true, "VEC3", 3},
                                              {kByte, true, "VEC3", 0},
                                              {kFloat, false, "VEC2", 0},
                                              {kUnsignedShort},
                                              {kUnsigned},
                                              {kFloat, false, "SCALAR", 1},
                                              {kFloat, false, "SCALAR", 1},
                                              {kFloat, false, "VEC3", 0},
                                              {kShort, true, "VEC4", 0}};
  static constexpr View kViewOf[] = {kVertices,   kVertices, kUvs,     kShortIndices, kIndices,
                                     kFrameTimes, kTimes,    kVectors, kRotations};
  const auto kind = static_cast<std::size_t>(accessor.kind);
  const KindProperties& is = kKinds[kind];
  out << "{\"bufferView\":" << number_of(kViewOf[kind]) << ",\"byteOffset\":" << accessor.offset
      << ",\"componentType\":" << is.component << ",\"count\":" << accessor.count << ",\"type\":\""
      << is.type << "\"";
  if (is.is_normalized) out << ",\"normalized\":true";
  if (is.bounds > 0) {
    const Eigen::Map<const Eigen::VectorXf> low(accessor.bounds.data(),
                                                static_cast<Eigen::Index>(is.bounds));
    const Eigen::Map<const Eigen::VectorXf> high(accessor.bounds.data() + 3,
                                                 static_cast<Eigen::Index>(is.bounds));
    out << ",\"min\":[" << low << "],\"max\":[" << high << "]";
  }
  out << "}";
}

void GltfBuffers::describe_accessors(TextWriter& out) const {
  for (std::size_t a = 0; a < accessors_.size(); ++a) {
    if (a > 0) out << ",\n";
    describe(accessors_[a], out);
  }
}

std::uint64_t GltfBuffers::describe_views(TextWriter& out,
                                          std::span<const std::size_t> more) const {
  static constexpr ViewProperties kProperties[kViews] = {
      {sizeof(QuantizedMesh::Vertex), kArrayBuffer},
      {sizeof(Eigen::Vector2f), kArrayBuffer},
      {0, kElementBuffer},
      {0, kElementBuffer}};
  std::uint64_t offset = 0;
  const auto describe_view = [&](std::uint64_t size, const ViewProperties& is) {
    out << (offset > 0 ? ",\n" : "") << "{\"buffer\":0,\"byteOffset\":" << offset
        << ",\"byteLength\":" << size;
    if (is.stride > 0) out << ",\"byteStride\":" << is.stride;
    if (is.target > 0) out << ",\"target\":" << is.target;
    out << "}";
    offset += aligned(size);
  };
  for (std::size_t view = 0; view < kViews; ++view) {
    if (data_[view].size() > 0) describe_view(data_[view].size(), kProperties[view]);
  }
  for (const std::size_t size : more) describe_view(size, {});
  return offset;
}

void GltfBuffers::read(const std::function<void(std::span<const std::byte>)>& take) {
  for (Spool& data : data_) data.read(take);
}

}  // namespace sunder
