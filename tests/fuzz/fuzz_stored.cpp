// Any bytes as what the program stores and reads back: takes, frames, compounds, break cases and
// figures. Reading ends with something sound, or with an InputError.
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

/// A file for as long as it is read; in memory where there is such a place.
class Stored {
 public:
  explicit Stored(const std::vector<std::byte>& bytes) {
    const fs::path memory = "/dev/shm";
    path_ = (fs::exists(memory) ? memory : fs::temp_directory_path()) /
            ("sunder-fuzz-" + std::to_string(getpid()));
    write_file(path_, bytes);
  }
  ~Stored() { fs::remove(path_); }
  Stored(const Stored&) = delete;
  Stored& operator=(const Stored&) = delete;
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
  for (const auto& mesh : *frame.meshes) {
    SUNDER_CHECK(mesh->material.value < frame.materials->size());
    for (const std::uint32_t index : mesh->indices) SUNDER_CHECK(index < mesh->vertices.size());
    const std::size_t paints = frame.paints ? frame.paints->size() : 0;
    for (const Mesh::Vertex& vertex : mesh->vertices)
      SUNDER_CHECK(vertex.look < Mesh::kFirstPaint + paints);
    SUNDER_CHECK(mesh->uvs.empty() || mesh->uvs.size() == mesh->vertices.size());
  }
  for (const FrameDebris& chip : frame.debris)
    SUNDER_CHECK(chip.material.value < frame.materials->size());
  for (const FrameDust& puff : frame.dust)
    SUNDER_CHECK(puff.material.value < frame.materials->size());
}

void play(const std::vector<std::byte>& file) {
  const Stored stored(file);
  try {
    RecordingReader take(stored.path());
    while (const FramePtr frame = take.next()) check_frame(*frame);
    take.seek(take.frames() / 2);
    while (const FramePtr frame = take.next()) check_frame(*frame);
  } catch (const InputError&) {
  }
}

void play_file(std::span<const std::uint8_t> bytes) { play(bytes_of(bytes)); }

/// A take whose sums are right, whatever its blocks hold: each is given as its kind, its number,
/// the length of its content in two bytes, and that. With 128 more the first kind says that it is
/// one of the newest version, else of the oldest.
void play_blocks(std::span<const std::uint8_t> bytes) {
  ByteWriter out;
  for (std::size_t i = 0; i < kRecordingMagicLength; ++i) out.put(kRecordingMagic[i]);
  out.put(bytes.empty() || bytes[0] < 128 ? kOldestVersion
                                          : kRecordingMagic[kRecordingMagicLength]);
  Packer frames, others;
  for (std::size_t at = 0; at + 4 <= bytes.size();) {
    const auto kind = static_cast<BlockKind>(bytes[at] % 128);
    const std::size_t said = bytes[at + 2] | bytes[at + 3] << 8;
    const std::size_t size = std::min(said, bytes.size() - at - 4);
    const std::vector<std::byte> content = bytes_of(bytes.subspan(at + 4, size));
    Packer& packer = kind == BlockKind::kKeyFrame || kind == BlockKind::kFrame ? frames : others;
    if (kind != BlockKind::kFrame) packer.restart();
    const auto block = make_block(kind, bytes[at + 1], size, packer.pack(content));
    out.bytes.insert(out.bytes.end(), block.begin(), block.end());
    at += 4 + size;
  }
  play(out.bytes);
}

/// A frame file whose sums are right, of any content: in zstd as it is (RFC 8878, 3.1.1), of the
/// version that the first byte says.
void show(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes.size() > 1 << 16) return;
  const std::vector<std::byte> content = bytes_of(bytes.subspan(1));
  const auto size = static_cast<std::uint32_t>(content.size());
  ByteWriter body;
  body.put(std::uint64_t{size});
  body.put(std::uint32_t{0xfd2fb528}, std::uint8_t{0xa0},
           size);                             // one segment, its size in 4 bytes
  const std::uint32_t block = size << 3 | 1;  // the last, as it is
  for (int i = 0; i < 3; ++i) body.put(static_cast<std::uint8_t>(block >> 8 * i));
  body.bytes.insert(body.bytes.end(), content.begin(), content.end());
  ByteWriter file;
  for (const char c : {'S', 'U', 'N', 'D', 'E', 'R', 'F'}) file.put(c);
  file.put(static_cast<char>('1' + bytes[0] % 3));
  file.put(hash_bytes(body.bytes));
  file.bytes.insert(file.bytes.end(), body.bytes.begin(), body.bytes.end());
  const Stored stored(file.bytes);
  try {
    check_frame(*read_frame(stored.path()));
  } catch (const InputError& error) {
    SUNDER_CHECK(std::string(error.what()).find("decompressed") == std::string::npos);
  }
}

void show_file(std::span<const std::uint8_t> bytes) {
  const Stored stored(bytes_of(bytes));
  try {
    check_frame(*read_frame(stored.path()));
  } catch (const InputError&) {
  }
}

/// What is read is written as it was.
void recall_compound(std::span<const std::uint8_t> bytes) {
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
    {"take", play_blocks},     {"take_file", play_file},      {"frame", show},
    {"frame_file", show_file}, {"compound", recall_compound}, {"case", read_break_case},
    {"figures", read_json},    {"nodes", read_node_file}};

}  // namespace
}  // namespace sunder
