// Layout: "SUNDERF1", XXH3 of the rest (8 bytes), size of the content (8 bytes), content in zstd.
#include "engine/io/frame_file.h"

#include <cstring>

#include <xxhash.h>
#include <zstd.h>

#include "engine/io/bytes.h"

namespace sunder {
namespace {

constexpr char kMagic[8] = {'S', 'U', 'N', 'D', 'E', 'R', 'F', '1'};
constexpr std::size_t kHeader = sizeof kMagic + 8;
constexpr std::uint64_t kLargest = 1ull << 31;  // content beyond this is refused
constexpr int kLevel = 19;                      // written once, kept for years

void put(ByteWriter& out, const Vec3& v) {
  for (int i = 0; i < 3; ++i) out.put(v[i]);
}
void put(ByteWriter& out, const Vec3f& v) {
  for (int i = 0; i < 3; ++i) out.put(v[i]);
}
void put(ByteWriter& out, const Look& look) {
  out.put(look.texture);
  put(out, look.color);
}
Vec3 take_vec3(ByteReader& in) {
  Vec3 v;
  for (int i = 0; i < 3; ++i) v[i] = in.take<double>();
  return v;
}
Vec3f take_vec3f(ByteReader& in) {
  Vec3f v;
  for (int i = 0; i < 3; ++i) v[i] = in.take<float>();
  return v;
}
Look take_look(ByteReader& in) {
  Look look;
  look.texture = in.take<Texture>();
  look.color = take_vec3f(in);
  return look;
}

void put(ByteWriter& out, const View& view) {
  put(out, view.eye_W);
  put(out, view.target_W);
  put(out, view.to_sun_W);
  put(out, view.ground_color);
  out.put(view.fov_rad);
  out.put(view.ground_m);
}
View take_view(ByteReader& in) {
  View view;
  view.eye_W = take_vec3(in);
  view.target_W = take_vec3(in);
  view.to_sun_W = take_vec3(in);
  view.ground_color = take_vec3f(in);
  view.fov_rad = in.take<double>();
  view.ground_m = in.take<double>();
  return view;
}

void put(ByteWriter& out, const Mesh& mesh) {
  put(out, mesh.origin_R);
  out.put(mesh.material.value);
  out.put(static_cast<std::uint32_t>(mesh.vertices.size()));
  for (const Mesh::Vertex& vertex : mesh.vertices) {
    put(out, vertex.position);
    put(out, vertex.normal);
    out.put(vertex.interior);
  }
  out.put(static_cast<std::uint32_t>(mesh.indices.size()));
  for (const std::uint32_t index : mesh.indices) out.put(index);
}
Mesh take_mesh(ByteReader& in, const std::string& file, std::size_t materials) {
  Mesh mesh;
  mesh.origin_R = take_vec3(in);
  mesh.material = MaterialIndex(in.take<std::uint32_t>());
  mesh.vertices.resize(in.take_count(28));
  for (Mesh::Vertex& vertex : mesh.vertices) {
    vertex.position = take_vec3f(in);
    vertex.normal = take_vec3f(in);
    vertex.interior = in.take<std::uint32_t>();
  }
  mesh.indices.resize(in.take_count(4));
  for (std::uint32_t& index : mesh.indices) {
    index = in.take<std::uint32_t>();
    if (index >= mesh.vertices.size())
      throw InputError(file + ": corrupt: a triangle has no corner");
  }
  if (mesh.material.value >= materials)
    throw InputError(file + ": corrupt: a mesh has no material");
  return mesh;
}

void put(ByteWriter& out, const FrameBody& body) {
  out.put(body.key);
  put(out, body.X_WB.position);
  for (int i = 0; i < 4; ++i) out.put(body.X_WB.rotation.coeffs()[i]);
  put(out, body.com_R);
  out.put(static_cast<std::uint8_t>(body.is_static));
}
FrameBody take_body(ByteReader& in) {
  FrameBody body;
  body.key = in.take<std::uint64_t>();
  body.X_WB.position = take_vec3(in);
  for (int i = 0; i < 4; ++i) body.X_WB.rotation.coeffs()[i] = in.take<double>();
  body.com_R = take_vec3(in);
  body.is_static = in.take<std::uint8_t>() != 0;
  return body;
}

/// Only the meshes that the frame draws; `new_of_old` numbers them.
std::vector<std::uint32_t> drawn_meshes(const Frame& frame, std::vector<std::uint32_t>& drawn) {
  std::vector<std::uint32_t> new_of_old(frame.meshes->size(), MeshIndex::kNone);
  for (const Instance& instance : frame.instances) {
    std::uint32_t& renumbered = new_of_old[instance.mesh.value];
    if (renumbered != MeshIndex::kNone) continue;
    renumbered = static_cast<std::uint32_t>(drawn.size());
    drawn.push_back(instance.mesh.value);
  }
  return new_of_old;
}

std::vector<std::byte> content_of(const Frame& frame) {
  ByteWriter out;
  out.put(frame.index);
  out.put(frame.time_s);
  put(out, frame.view);
  out.put(static_cast<std::uint32_t>(frame.materials->size()));
  for (const Material& material : *frame.materials) {
    out.put(material.name);
    put(out, material.surface);
    put(out, material.interior);
  }
  std::vector<std::uint32_t> drawn;
  const auto new_of_old = drawn_meshes(frame, drawn);
  out.put(static_cast<std::uint32_t>(drawn.size()));
  for (const std::uint32_t mesh : drawn) put(out, *(*frame.meshes)[mesh]);
  out.put(static_cast<std::uint32_t>(frame.bodies.size()));
  for (const FrameBody& body : frame.bodies) put(out, body);
  out.put(static_cast<std::uint32_t>(frame.instances.size()));
  for (const Instance& instance : frame.instances) {
    out.put(new_of_old[instance.mesh.value]);
    out.put(instance.body);
  }
  return std::move(out.bytes);
}

FramePtr frame_of(const std::vector<std::byte>& content, const std::string& file) {
  ByteReader in(content, file);
  auto frame = std::make_shared<Frame>();
  frame->index = in.take<std::uint64_t>();
  frame->time_s = in.take<double>();
  frame->view = take_view(in);
  std::vector<Material> materials(in.take_count(30));
  for (Material& material : materials) {
    material.name = in.take_text();
    material.surface = take_look(in);
    material.interior = take_look(in);
  }
  auto meshes = std::make_shared<MeshStore>(in.take_count(36));
  for (auto& mesh : *meshes) {
    mesh = std::make_shared<const Mesh>(take_mesh(in, file, materials.size()));
  }
  frame->bodies.resize(in.take_count(89));
  for (FrameBody& body : frame->bodies) body = take_body(in);
  frame->instances.resize(in.take_count(8));
  for (Instance& instance : frame->instances) {
    instance.mesh = MeshIndex(in.take<std::uint32_t>());
    instance.body = in.take<std::uint32_t>();
    if (instance.mesh.value >= meshes->size() || instance.body >= frame->bodies.size()) {
      throw InputError(file + ": corrupt: an instance names no mesh or body");
    }
  }
  if (!in.at_end()) throw InputError(file + ": corrupt: bytes are left over");
  frame->materials = std::make_shared<const std::vector<Material>>(std::move(materials));
  frame->meshes = std::move(meshes);
  return frame;
}

}  // namespace

void write_frame(const std::filesystem::path& path, const Frame& frame) {
  const std::vector<std::byte> content = content_of(frame);
  std::vector<std::byte> packed(ZSTD_compressBound(content.size()));
  const std::size_t size =
      ZSTD_compress(packed.data(), packed.size(), content.data(), content.size(), kLevel);
  SUNDER_CHECK(!ZSTD_isError(size));
  packed.resize(size);

  ByteWriter body;
  body.put(static_cast<std::uint64_t>(content.size()));
  body.bytes.insert(body.bytes.end(), packed.begin(), packed.end());
  ByteWriter file;
  for (const char c : kMagic) file.put(c);
  file.put(static_cast<std::uint64_t>(XXH3_64bits(body.bytes.data(), body.bytes.size())));
  file.bytes.insert(file.bytes.end(), body.bytes.begin(), body.bytes.end());
  write_file(path, file.bytes);
}

FramePtr read_frame(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::vector<std::byte> file = read_file(path);
  if (file.size() < kHeader + 8 || std::memcmp(file.data(), kMagic, sizeof kMagic) != 0) {
    throw InputError(name + ": not a frame file of this version of sunder; record it again");
  }
  ByteReader header(file, name);
  for (std::size_t i = 0; i < sizeof kMagic; ++i) header.take<char>();
  const auto expected = header.take<std::uint64_t>();
  if (XXH3_64bits(file.data() + kHeader, file.size() - kHeader) != expected) {
    throw InputError(name + ": corrupt: the checksum does not match; record it again");
  }
  const auto size = header.take<std::uint64_t>();
  if (size > kLargest) throw InputError(name + ": corrupt: it claims to be too large");
  std::vector<std::byte> content(size);
  const std::size_t got = ZSTD_decompress(content.data(), content.size(), file.data() + kHeader + 8,
                                          file.size() - kHeader - 8);
  if (ZSTD_isError(got) || got != size) throw InputError(name + ": corrupt: cannot be unpacked");
  return frame_of(content, name);
}

}  // namespace sunder
