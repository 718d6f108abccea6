// Fuzz targets: any bytes as a file that the program stores and reads back (recordings, frames,
// compounds, break cases, figures) give valid data or an InputError.
#include <unistd.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "engine/base/check.h"
#include "engine/io/bytes.h"
#include "engine/io/compound_file.h"
#include "engine/io/figures.h"
#include "engine/io/frame_file.h"
#include "engine/io/recording/recording.h"
#include "engine/io/recording/recording_blocks.h"
#include "fracture/check/case_file.h"
#include "fracture/vacd/vacd.h"
#include "tests/fuzz/fuzz_target.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;

/// Temporary file with the given bytes, in /dev/shm if it exists; removed by the destructor.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::vector<std::byte>& bytes) {
    const fs::path memory = "/dev/shm";
    path_ = (fs::exists(memory) ? memory : fs::temp_directory_path()) /
            ("sunder-fuzz-" + std::to_string(getpid()));
    write_file(path_, bytes);
  }
  ~TemporaryFile() { fs::remove(path_); }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

std::vector<std::byte> bytes_of(std::span<const std::uint8_t> bytes) {
  const auto raw = std::as_bytes(bytes);
  return {raw.begin(), raw.end()};
}

void check_frame(const Frame& frame) {
  for (const Instance& instance : frame.instances) {
    SUNDER_CHECK(instance.body < frame.bodies.size());
    SUNDER_CHECK(instance.mesh.value < frame.meshes->size());
  }
  frame.meshes->for_each([&](std::size_t i) {
    const std::shared_ptr<const Mesh>& mesh = (*frame.meshes)[i];
    SUNDER_CHECK(mesh->material.value < frame.materials->size());
    for (const std::uint32_t index : mesh->indices) SUNDER_CHECK(index < mesh->vertices.size());
    const std::size_t appearances = frame.appearances ? frame.appearances->size() : 0;
    for (const Mesh::Vertex& vertex : mesh->vertices)
      SUNDER_CHECK(vertex.look < Mesh::kFirstAppearance + appearances);
    SUNDER_CHECK(mesh->uvs.empty() || mesh->uvs.size() == mesh->vertices.size());
  });
  for (const FrameDebris& chip : frame.debris)
    SUNDER_CHECK(chip.material.value < frame.materials->size());
  for (const FrameDust& puff : frame.dust)
    SUNDER_CHECK(puff.material.value < frame.materials->size());
}

void play_recording(const std::vector<std::byte>& file) {
  const TemporaryFile stored(file);
  try {
    RecordingReader take(stored.path());
    while (const FramePtr frame = take.next()) check_frame(*frame);
    take.seek(take.frames() / 2);
    while (const FramePtr frame = take.next()) check_frame(*frame);
  } catch (const InputError&) {
  }
}

void play_file(std::span<const std::uint8_t> bytes) { play_recording(bytes_of(bytes)); }

/// Plays a recording with correct checksums and any content of blocks. Each block is given as its
/// kind, its number, the length of its content in two bytes, and the content.
void play_blocks(std::span<const std::uint8_t> bytes) {
  ByteWriter out;
  for (const char c : kRecordingMagic) out.put(c);
  Packer frames, others;
  for (std::size_t at = 0; at + 4 <= bytes.size();) {
    const auto kind = static_cast<BlockKind>(bytes[at]);
    const std::size_t said = bytes[at + 2] | bytes[at + 3] << 8;
    const std::size_t size = std::min(said, bytes.size() - at - 4);
    const std::vector<std::byte> content = bytes_of(bytes.subspan(at + 4, size));
    Packer& packer = kind == BlockKind::kKeyFrame || kind == BlockKind::kFrame ? frames : others;
    if (kind != BlockKind::kFrame) packer.restart();
    const auto block = make_block(kind, bytes[at + 1], size, packer.pack(content));
    out.bytes.insert(out.bytes.end(), block.begin(), block.end());
    at += 4 + size;
  }
  play_recording(out.bytes);
}

/// Reads a frame file with a correct checksum and any content, stored uncompressed in a zstd frame
/// (RFC 8878, 3.1.1).
void read_frame_content(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes.size() > 1 << 16) return;
  const std::vector<std::byte> content = bytes_of(bytes);
  const auto size = static_cast<std::uint32_t>(content.size());
  ByteWriter body;
  body.put(std::uint64_t{size});
  body.put(std::uint32_t{0xfd2fb528}, std::uint8_t{0xa0},
           size);                             // one segment, with its size in 4 bytes
  const std::uint32_t block = size << 3 | 1;  // last block, uncompressed
  for (int i = 0; i < 3; ++i) body.put(static_cast<std::uint8_t>(block >> 8 * i));
  body.bytes.insert(body.bytes.end(), content.begin(), content.end());
  ByteWriter file;
  for (const char c : {'S', 'U', 'N', 'D', 'E', 'R', 'F', '6'}) file.put(c);
  file.put(hash_bytes(body.bytes));
  file.bytes.insert(file.bytes.end(), body.bytes.begin(), body.bytes.end());
  const TemporaryFile stored(file.bytes);
  try {
    check_frame(*read_frame(stored.path()));
  } catch (const InputError& error) {
    SUNDER_CHECK(std::string(error.what()).find("decompressed") == std::string::npos);
  }
}

void read_frame_file(std::span<const std::uint8_t> bytes) {
  const TemporaryFile stored(bytes_of(bytes));
  try {
    check_frame(*read_frame(stored.path()));
  } catch (const InputError&) {
  }
}

/// Checks that a compound that can be read is written and read again to the same bytes.
void reread_compound(std::span<const std::uint8_t> bytes) {
  const std::vector<std::byte> content = bytes_of(bytes);
  try {
    ByteReader in(content, "fuzz");
    const Compound compound = take_compound(in, "fuzz");
    ByteWriter once, twice;
    put(once, compound);
    ByteReader again(once.bytes, "fuzz");
    put(twice, take_compound(again, "fuzz"));
    SUNDER_CHECK(once.bytes == twice.bytes);
  } catch (const InputError&) {
  }
}

void read_break_case(std::span<const std::uint8_t> bytes) {
  std::istringstream text(std::string(bytes.begin(), bytes.end()));
  try {
    std::stringstream once, twice;
    fracture::write_case(once, fracture::read_case(text, "fuzz.case"));
    fracture::write_case(twice, fracture::read_case(once, "again.case"));
    SUNDER_CHECK(once.str() == twice.str());
  } catch (const InputError&) {
  }
}

void read_json(std::span<const std::uint8_t> bytes) {
  try {
    const Figures figures = parse_figures({bytes.begin(), bytes.end()}, "fuzz.json");
    const Figures again = parse_figures(format_figures(figures), "again.json");
    SUNDER_CHECK(again.size() <= figures.size());
  } catch (const InputError&) {
  }
}

void read_node_file(std::span<const std::uint8_t> bytes) {
  std::istringstream text(std::string(bytes.begin(), bytes.end()));
  try {
    for (const Vec3& node : fracture::read_nodes(text, "fuzz.nodes"))
      SUNDER_CHECK(node.allFinite());
  } catch (const InputError&) {
  }
}

const fuzz::Registration stored_targets[] = {
    {"take", play_blocks},           {"take_file", play_file},      {"frame", read_frame_content},
    {"frame_file", read_frame_file}, {"compound", reread_compound}, {"case", read_break_case},
    {"figures", read_json},          {"nodes", read_node_file}};

}  // namespace
}  // namespace sunder
