// Layout: "SUNDERF" and the version, XXH3 of the rest (8 bytes), content size (8 bytes), zstd data.
#include "engine/io/frame_file.h"

#include <algorithm>
#include <cstring>

#include <xxhash.h>
#include <zstd.h>

#include "engine/io/bytes.h"
#include "engine/io/frame_parts.h"
#include "engine/io/particle_codes.h"

namespace sunder {
namespace {

constexpr char kMagic[8] = {'S', 'U', 'N', 'D', 'E', 'R', 'F', '6'};
constexpr std::size_t kHeaderBytes = sizeof kMagic + 8;
constexpr std::uint64_t kMaxContentBytes = 1ull << 31;  // largest accepted content
constexpr int kCompressionLevel = 19;                   // files are written once and kept for years

void put(ByteWriter& out, const FrameBody& body) {
  out.put(body.key, body.X_WB.position, body.X_WB.rotation.coeffs(), body.com_R,
          static_cast<std::uint8_t>((body.is_static ? 1 : 0) | (body.asleep ? 2 : 0)));
}

FrameBody take_body(ByteReader& in) {
  FrameBody body;
  in.take_to(body.key, body.X_WB.position, body.X_WB.rotation.coeffs(), body.com_R);
  const auto flags = in.take<std::uint8_t>();
  body.is_static = (flags & 1) != 0;
  body.asleep = (flags & 2) != 0;
  body.previous_key = body.key;
  return body;
}

template <class Particle>
void put_codes(ByteWriter& out, const std::vector<Particle>& particles) {
  out.put(static_cast<std::uint32_t>(particles.size()));
  for (const Particle& particle : particles) out.put(encode(particle));
}
template <class Particle>
std::vector<Particle> take_codes(ByteReader& in, const std::string& file, std::size_t materials,
                                 Particle (*decode)(const ParticleCode&)) {
  std::vector<Particle> particles(in.take_count(sizeof(ParticleCode)));
  for (Particle& particle : particles) {
    particle = decode(in.take<ParticleCode>());
    if (particle.material.value >= materials) {
      throw InputError(file + ": corrupt: a particle has an invalid material");
    }
  }
  return particles;
}

void put(ByteWriter& out, const Inspection& inspection) {
  out.put(static_cast<std::uint32_t>(inspection.contacts.size()));
  for (const FrameContact& contact : inspection.contacts)
    out.put(contact.point_W, contact.force_W, contact.key_a, contact.key_b);
  out.put(static_cast<std::uint32_t>(inspection.boxes.size()));
  for (const FrameBox& box : inspection.boxes) out.put(box.min_W, box.max_W, box.body);
  out.put_list(inspection.islands);
  out.put_list(inspection.stresses);
}

std::shared_ptr<const Inspection> take_inspection(ByteReader& in, const std::string& file,
                                                  const Frame& frame) {
  auto inspection = std::make_shared<Inspection>();
  inspection->contacts.resize(in.take_count(40));
  for (FrameContact& contact : inspection->contacts)
    in.take_to(contact.point_W, contact.force_W, contact.key_a, contact.key_b);
  inspection->boxes.resize(in.take_count(28));
  for (FrameBox& box : inspection->boxes) in.take_to(box.min_W, box.max_W, box.body);
  inspection->islands = in.take_list<std::uint32_t>();
  inspection->stresses = in.take_list<float>();
  const auto is_body = [&](std::uint32_t body) { return body < frame.bodies.size(); };
  if (inspection->islands.size() != frame.bodies.size() ||
      inspection->stresses.size() != frame.instances.size() ||
      !std::ranges::all_of(inspection->islands, is_body) ||
      !std::ranges::all_of(inspection->boxes, is_body, &FrameBox::body)) {
    throw InputError(file + ": corrupt: the inspection data does not match the bodies");
  }
  return inspection;
}

/// Appends the indices of the meshes that are drawn to `drawn`; returns the new index of each mesh.
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
  out.put(frame.index, frame.time_s);
  put(out, frame.view);
  put(out, *frame.materials);
  std::vector<std::uint32_t> drawn;
  const auto new_of_old = drawn_meshes(frame, drawn);
  out.put(static_cast<std::uint32_t>(drawn.size()));
  for (const std::uint32_t mesh : drawn) put(out, *(*frame.meshes)[mesh]);
  out.put(static_cast<std::uint32_t>(frame.bodies.size()));
  for (const FrameBody& body : frame.bodies) put(out, body);
  out.put(static_cast<std::uint32_t>(frame.instances.size()));
  for (const Instance& instance : frame.instances) {
    out.put(new_of_old[instance.mesh.value], instance.body);
  }
  put_codes(out, frame.debris);
  put_codes(out, frame.dust);
  put(out, frame.appearances ? *frame.appearances : std::vector<Appearance>());
  std::vector<std::shared_ptr<const Mesh>> meshes;
  for (const std::uint32_t mesh : drawn) meshes.push_back((*frame.meshes)[mesh]);
  put_uvs(out, meshes);
  out.put(static_cast<std::uint8_t>(frame.inspection ? 1 : 0));
  if (frame.inspection) put(out, *frame.inspection);
  return std::move(out.bytes);
}

FramePtr frame_of(const std::vector<std::byte>& content, const std::string& file) {
  ByteReader in(content, file);
  auto frame = std::make_shared<Frame>();
  in.take_to(frame->index, frame->time_s);
  frame->view = take_view(in);
  std::vector<Material> materials = take_materials(in);
  std::vector<Mesh> meshes(in.take_count(kMinMeshBytes));
  for (Mesh& mesh : meshes) mesh = take_mesh(in, file, materials.size());
  frame->bodies.resize(in.take_count(89));
  for (FrameBody& body : frame->bodies) body = take_body(in);
  frame->instances.resize(in.take_count(8));
  for (Instance& instance : frame->instances) {
    in.take_to(instance.mesh, instance.body);
    if (instance.mesh.value >= meshes.size() || instance.body >= frame->bodies.size()) {
      throw InputError(file + ": corrupt: an instance has an invalid mesh or body");
    }
  }
  frame->debris = take_codes(in, file, materials.size(), decode_debris);
  frame->dust = take_codes(in, file, materials.size(), decode_dust);
  std::vector<Appearance> appearances = take_appearances(in, file);
  take_uvs(in, file, meshes);
  for (const Mesh& mesh : meshes) check_appearances(mesh, file, appearances.size());
  if (in.take<std::uint8_t>() != 0) frame->inspection = take_inspection(in, file, *frame);
  if (!in.at_end()) throw InputError(file + ": corrupt: unexpected bytes at the end");
  frame->materials = std::make_shared<const std::vector<Material>>(std::move(materials));
  if (!appearances.empty())
    frame->appearances = std::make_shared<const std::vector<Appearance>>(std::move(appearances));
  auto store = std::make_shared<MeshStore>();
  for (Mesh& mesh : meshes) store->push_back(std::make_shared<const Mesh>(std::move(mesh)));
  frame->meshes = std::move(store);
  return frame;
}

}  // namespace

void write_frame(const std::filesystem::path& path, const Frame& frame) {
  const std::vector<std::byte> content = content_of(frame);
  std::vector<std::byte> packed(ZSTD_compressBound(content.size()));
  const std::size_t size = ZSTD_compress(packed.data(), packed.size(), content.data(),
                                         content.size(), kCompressionLevel);
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

FramePtr as_stored(const Frame& frame) { return frame_of(content_of(frame), "a frame"); }

bool is_stored_frame(const std::filesystem::path& path) {
  return begins_with(path, {kMagic, sizeof kMagic - 1});  // without the version
}

FramePtr read_frame(const std::filesystem::path& path) {
  const std::string name = path.string();
  const std::vector<std::byte> file = read_file(path, file_kinds::kFrame);
  if (file.size() < kHeaderBytes + 8 || std::memcmp(file.data(), kMagic, sizeof kMagic) != 0) {
    throw InputError(name + ": not a frame file of this version of sunder; record it again");
  }
  ByteReader header(file, name);
  for (std::size_t i = 0; i < sizeof kMagic; ++i) header.take<char>();
  const auto expected = header.take<std::uint64_t>();
  if (XXH3_64bits(file.data() + kHeaderBytes, file.size() - kHeaderBytes) != expected) {
    throw InputError(name + ": corrupt: the checksum does not match; record it again");
  }
  const auto size = header.take<std::uint64_t>();
  if (size > kMaxContentBytes) throw InputError(name + ": corrupt: the stored size is too large");
  std::vector<std::byte> content(size);
  const std::size_t got =
      ZSTD_decompress(content.data(), content.size(), file.data() + kHeaderBytes + 8,
                      file.size() - kHeaderBytes - 8);
  if (ZSTD_isError(got) || got != size)
    throw InputError(name + ": corrupt: cannot be decompressed");
  return frame_of(content, name);
}

}  // namespace sunder
