// Plays a take: the frames of a recorded run, from any of them on.
#pragma once

#include <filesystem>
#include <fstream>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/take/take_blocks.h"
#include "engine/io/take/take_frame.h"
#include "engine/model/frame.h"

namespace sunder {

/// A source of what a take holds. What is cut short or corrupt is played as far as it can be read,
/// and damage() says what is wrong.
class TakeReader final : public FrameSource {
 public:
  /// Throws InputError if the file cannot be read, is no take of this version, or holds no frame
  /// that can be read.
  explicit TakeReader(const std::filesystem::path& path);

  /// Null at the end, or where the damage begins.
  FramePtr next() override;
  /// next() will give this one, counted from 0; the last if there are fewer.
  void seek(std::uint32_t frame);
  /// How many there are, as far as is known: later ones may turn out to be corrupt.
  std::uint32_t frames() const { return static_cast<std::uint32_t>(frame_blocks_.size()); }
  /// Empty if nothing wrong has been met so far.
  const std::string& damage() const { return damage_; }
  /// Whether the run came to its end: else it was killed, or the file was cut short.
  bool is_complete() const { return complete_; }
  /// short_hash() of each body of the frame that next() gave last.
  const std::vector<std::int32_t>& body_hashes() const { return body_hashes_; }

 private:
  struct Block {
    BlockHeader header;
    std::vector<std::byte> packed;
  };

  bool read_index();
  void scan();
  void note(const BlockPlace& place);
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
  std::shared_ptr<MeshStore> meshes_ = std::make_shared<MeshStore>();
  std::size_t mesh_blocks_read_ = 0;

  std::uint32_t next_ = 0;
  std::optional<std::uint32_t> decoded_;  ///< What the coder stands at.
  FrameCoder coder_;
  Unpacker frame_unpacker_, other_unpacker_;
  std::vector<std::int32_t> body_hashes_;
};

}  // namespace sunder
