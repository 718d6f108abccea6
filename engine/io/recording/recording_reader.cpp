// Begin with the constructor, which finds the blocks, then next().
#include <algorithm>
#include <cstring>
#include <fstream>
#include <optional>

#include "engine/io/frame_parts.h"
#include "engine/io/recording/frame_coder.h"
#include "engine/io/recording/recording.h"
#include "engine/io/recording/recording_blocks.h"

namespace sunder {

bool is_recording(const std::filesystem::path& path) {
  return begins_with(path, {kRecordingMagic, kRecordingMagicLength});
}

/// State of a recording being played; implements the members of RecordingReader.
class RecordingReader::Playback {
 public:
  explicit Playback(const std::filesystem::path& path);
  FramePtr next();
  void seek(std::uint32_t frame);
  std::uint32_t frames() const { return static_cast<std::uint32_t>(frame_blocks_.size()); }
  const std::string& damage() const { return damage_; }
  bool is_complete() const { return complete_; }
  const std::vector<std::int32_t>& body_hashes() const { return body_hashes_; }

 private:
  struct Block {
    BlockHeader header;
    std::vector<std::byte> packed;
  };

  bool read_index();
  void scan();
  void register_block(const BlockPlace& place);
  std::optional<Block> block_at(std::uint64_t offset);
  std::vector<std::byte> content_at(const BlockPlace& place, Unpacker& unpacker);
  FramePtr decode(std::uint32_t frame);
  void read_meshes(std::uint32_t until);

  std::string file_;
  std::ifstream in_;
  std::uint64_t size_ = 0;
  bool complete_ = false;
  std::string damage_;

  std::optional<BlockPlace> materials_block_;
  std::vector<BlockPlace> mesh_blocks_, frame_blocks_;
  std::shared_ptr<const std::vector<Material>> materials_;
  std::shared_ptr<const std::vector<std::string>> names_;
  std::shared_ptr<const std::vector<Appearance>> appearances_;
  std::shared_ptr<MeshStore> meshes_ = std::make_shared<MeshStore>();
  std::size_t mesh_blocks_read_ = 0;

  std::uint32_t next_ = 0;
  std::optional<std::uint32_t> decoded_;  ///< The frame that `coder_` decoded last.
  FrameCoder coder_;
  Unpacker frame_unpacker_, other_unpacker_;
  std::vector<std::int32_t> body_hashes_;
};

RecordingReader::Playback::Playback(const std::filesystem::path& path) : file_(path.string()) {
  in_.open(path, std::ios::binary | std::ios::ate);
  if (!in_ || !std::filesystem::is_regular_file(path)) {
    throw InputError(file_ + ": cannot be read; check the name and permissions");
  }
  size_ = static_cast<std::uint64_t>(in_.tellg());
  char magic[sizeof kRecordingMagic] = {};
  in_.seekg(0);
  in_.read(magic, sizeof magic);
  const bool is_recording = in_ && std::memcmp(magic, kRecordingMagic, kRecordingMagicLength) == 0;
  const char version = magic[kRecordingMagicLength];
  if (!is_recording)
    throw InputError(file_ + ": not a recording; `sunder simulate --take FILE` makes one");
  if (version != kRecordingMagic[kRecordingMagicLength]) {
    throw InputError(file_ + ": a recording by another version of sunder (version " + version +
                     ", this program reads version " + kRecordingMagic[kRecordingMagicLength] +
                     "); record it again");
  }
  if (!read_index()) scan();
  if (!materials_block_ || frame_blocks_.empty()) {
    throw InputError(file_ + ": " + (damage_.empty() ? "the recording is truncated" : damage_) +
                     "; no frame can be read");
  }
  const auto content = content_at(*materials_block_, other_unpacker_);
  ByteReader in(content, file_);
  materials_ = std::make_shared<const std::vector<Material>>(take_materials(in));
  names_ = std::make_shared<const std::vector<std::string>>(take_names(in));
  if (!in.at_end())
    appearances_ = std::make_shared<const std::vector<Appearance>>(take_appearances(in, file_));
}

/// Registers a block. Blocks are in the order of the run, each with its frame or mesh index.
void RecordingReader::Playback::register_block(const BlockPlace& place) {
  const auto fail_order = [&] {
    throw InputError(file_ + ": corrupt: the blocks are out of order");
  };
  switch (place.kind) {
    case BlockKind::kMaterials:
      if (materials_block_) fail_order();
      materials_block_ = place;
      break;
    case BlockKind::kMeshes:
      mesh_blocks_.push_back(place);
      break;
    case BlockKind::kKeyFrame:
    case BlockKind::kFrame:
      if (place.first != frame_blocks_.size()) fail_order();
      if (frame_blocks_.empty() && place.kind != BlockKind::kKeyFrame) fail_order();
      frame_blocks_.push_back(place);
      break;
    case BlockKind::kIndex:
      complete_ = true;
      break;
  }
}

/// Reads the index; returns false if it is missing or invalid, in which case scan() is needed.
bool RecordingReader::Playback::read_index() {
  constexpr std::uint64_t kEnd = 8 + sizeof kIndexMagic;
  std::vector<std::byte> end(kEnd);
  if (size_ < sizeof kRecordingMagic + kEnd) return false;
  in_.clear();
  in_.seekg(static_cast<std::streamoff>(size_ - kEnd));
  in_.read(reinterpret_cast<char*>(end.data()), static_cast<std::streamsize>(kEnd));
  if (!in_ || std::memcmp(end.data() + 8, kIndexMagic, sizeof kIndexMagic) != 0) return false;
  ByteReader at(end, file_);
  const std::optional<Block> block = block_at(at.take<std::uint64_t>());
  if (!block || block->header.kind != BlockKind::kIndex) return false;
  try {
    other_unpacker_.restart();
    const auto content = other_unpacker_.unpack(block->packed, block->header.content_bytes, file_);
    ByteReader in(content, file_);
    while (!in.at_end()) {
      BlockPlace place;
      in.take_to(place.offset, place.kind, place.first);
      register_block(place);
    }
  } catch (const InputError&) {
    materials_block_.reset();
    mesh_blocks_.clear();
    frame_blocks_.clear();
    return false;
  }
  complete_ = true;
  return true;
}

/// Registers blocks one after another until the end of the file or the first invalid one.
void RecordingReader::Playback::scan() {
  complete_ = false;
  for (std::uint64_t at = sizeof kRecordingMagic; at < size_ && !complete_;) {
    const std::optional<Block> block = block_at(at);
    if (!block) {
      const std::string frame = frame_blocks_.empty()
                                    ? "before the first frame"
                                    : "after frame " + std::to_string(frame_blocks_.size() - 1);
      damage_ =
          "the recording is truncated or corrupt " + frame + " (byte " + std::to_string(at) + ")";
      return;
    }
    register_block({at, block->header.kind, block->header.first});
    at += sizeof(BlockHeader) + block->header.bytes;
  }
}

/// Returns the block at an offset, or nothing if it is incomplete or corrupt.
std::optional<RecordingReader::Playback::Block> RecordingReader::Playback::block_at(
    std::uint64_t offset) {
  if (offset > size_ || size_ - offset < sizeof(BlockHeader)) return {};
  Block block;
  in_.clear();
  in_.seekg(static_cast<std::streamoff>(offset));
  in_.read(reinterpret_cast<char*>(&block.header), sizeof(BlockHeader));
  if (!in_ || !is_valid(block.header)) return {};
  if (block.header.bytes > size_ - offset - sizeof(BlockHeader)) return {};
  block.packed.resize(block.header.bytes);
  in_.read(reinterpret_cast<char*>(block.packed.data()),
           static_cast<std::streamsize>(block.packed.size()));
  if (!in_ || !matches(block.header, block.packed)) return {};
  return block;
}

std::vector<std::byte> RecordingReader::Playback::content_at(const BlockPlace& place,
                                                             Unpacker& unpacker) {
  const std::optional<Block> block = block_at(place.offset);
  if (!block || block->header.kind != place.kind || block->header.first != place.first) {
    throw InputError(file_ + ": corrupt at byte " + std::to_string(place.offset));
  }
  if (place.kind != BlockKind::kFrame) unpacker.restart();
  return unpacker.unpack(block->packed, block->header.content_bytes, file_);
}

void RecordingReader::Playback::seek(std::uint32_t frame) { next_ = std::min(frame, frames() - 1); }

FramePtr RecordingReader::Playback::next() {
  if (next_ >= frames()) return nullptr;
  // Continue from the last decoded frame, or begin at the key frame before.
  std::uint32_t at = next_;
  if (decoded_ && *decoded_ < next_ && next_ - *decoded_ <= kFramesPerGroup) {
    at = *decoded_ + 1;
  } else {
    while (frame_blocks_[at].kind != BlockKind::kKeyFrame) --at;
  }
  try {
    for (; at < next_; ++at) decode(at);
    FramePtr frame = decode(at);
    ++next_;
    return frame;
  } catch (const InputError& error) {
    damage_ = error.what();
    if (damage_.starts_with(file_ + ": ")) damage_.erase(0, file_.size() + 2);
    damage_ += at == 0 ? "; no frame can be read"
                       : "; frames can be read up to frame " + std::to_string(at - 1);
    frame_blocks_.resize(at);
    return nullptr;
  }
}

FramePtr RecordingReader::Playback::decode(std::uint32_t frame) {
  decoded_.reset();
  const BlockPlace& place = frame_blocks_[frame];
  const std::vector<std::byte> content = content_at(place, frame_unpacker_);
  if (place.kind == BlockKind::kKeyFrame) coder_.reset();
  RecordedFrame take = coder_.read(content, file_);
  read_meshes(take.meshes);
  const auto fits = [&](MaterialIndex material) { return material.value < materials_->size(); };
  const auto all_fit = [&](const auto& particles) {
    return std::ranges::all_of(particles, [&](const auto& p) { return fits(p.material); });
  };
  if (!all_fit(take.frame.debris) || !all_fit(take.frame.dust)) {
    throw InputError(file_ + ": corrupt: a particle has an invalid material");
  }
  for (const BreakEvent& event : take.frame.breaks) {
    if (!event.material.none() && !fits(event.material))
      throw InputError(file_ + ": corrupt: a break has an invalid material");
  }
  auto result = std::make_shared<Frame>(std::move(take.frame));
  result->materials = materials_;
  result->names = names_;
  result->appearances = appearances_;
  result->meshes = meshes_;
  body_hashes_ = std::move(take.body_hashes);
  decoded_ = frame;
  return result;
}

/// Extends the mesh store as the run did; frames returned earlier keep their store.
void RecordingReader::Playback::read_meshes(std::uint32_t until) {
  if (meshes_->size() >= until) return;
  meshes_ = std::make_shared<MeshStore>(*meshes_);
  while (meshes_->size() < until) {
    if (mesh_blocks_read_ == mesh_blocks_.size() ||
        mesh_blocks_[mesh_blocks_read_].first != meshes_->size()) {
      throw InputError(file_ + ": corrupt: meshes are missing");
    }
    const auto content = content_at(mesh_blocks_[mesh_blocks_read_], other_unpacker_);
    ByteReader in(content, file_);
    std::vector<Mesh> meshes(in.take_count(kMinMeshBytes));
    for (Mesh& mesh : meshes) mesh = take_mesh(in, file_, materials_->size());
    if (appearances_) take_uvs(in, file_, meshes);
    for (Mesh& mesh : meshes) {
      check_appearances(mesh, file_, appearances_ ? appearances_->size() : 0);
      meshes_->push_back(std::make_shared<const Mesh>(std::move(mesh)));
    }
    ++mesh_blocks_read_;
  }
}

RecordingReader::RecordingReader(const std::filesystem::path& path)
    : playback_(std::make_unique<Playback>(path)) {}
RecordingReader::~RecordingReader() = default;
FramePtr RecordingReader::next() { return playback_->next(); }
void RecordingReader::seek(std::uint32_t frame) { playback_->seek(frame); }
std::uint32_t RecordingReader::frames() const { return playback_->frames(); }
const std::string& RecordingReader::damage() const { return playback_->damage(); }
bool RecordingReader::is_complete() const { return playback_->is_complete(); }
const std::vector<std::int32_t>& RecordingReader::body_hashes() const {
  return playback_->body_hashes();
}

}  // namespace sunder
