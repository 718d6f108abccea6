// Blocks of a recording. File layout: "SUNDERT" and the version, consecutive blocks, and, if the
// run finished, a block with their index, whose offset is in the last 16 bytes.
//
// A block is a header and data in zstd. The blocks of one group of frames (a key frame and those
// encoded relative to it) are one zstd stream, flushed after every frame.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/io/bytes.h"

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace sunder {

inline constexpr char kRecordingMagic[8] = {'S', 'U', 'N', 'D', 'E', 'R', 'T', '7'};
/// Length without the version.
inline constexpr std::size_t kRecordingMagicLength = sizeof kRecordingMagic - 1;
inline constexpr char kIndexMagic[8] = {'T', 'A', 'K', 'E', 'E', 'N', 'D', '1'};
inline constexpr std::uint64_t kFramesPerGroup = 120;
inline constexpr std::uint64_t kMaxBlockBytes = 1ull << 30;  ///< Larger blocks are rejected.

enum class BlockKind : std::uint32_t {
  kMaterials = 1,  ///< Materials, and textures if a run has them.
  kMeshes,    ///< New meshes of the mesh store; texture coordinates as well if there are textures.
  kKeyFrame,  ///< Independent of other frames; begins a group.
  kFrame,     ///< Difference to the previous frame.
  kIndex,
};

/// Header as stored, 40 bytes.
struct BlockHeader {
  BlockKind kind = BlockKind::kMaterials;
  std::uint32_t first = 0;          ///< Index of the frame in the recording, or of the first mesh.
  std::uint64_t bytes = 0;          ///< Size of the data that follows.
  std::uint64_t content_bytes = 0;  ///< Size after decompression.
  std::uint64_t hash = 0;           ///< XXH3 of the data, seeded by all members above.
  std::uint64_t header_hash = 0;    ///< XXH3 of all members above.
};

/// Position and content of a block in the file.
struct BlockPlace {
  std::uint64_t offset = 0;
  BlockKind kind = BlockKind::kMaterials;
  std::uint32_t first = 0;
};

/// Returns a block with its header.
std::vector<std::byte> make_block(BlockKind kind, std::uint32_t first, std::uint64_t content_bytes,
                                  const std::vector<std::byte>& packed);
/// True if the header is of a known kind, within limits, and has the right hash.
bool is_valid(const BlockHeader& header);
/// True if the data has the size and hash that the header states.
bool matches(const BlockHeader& header, const std::vector<std::byte>& packed);

/// A zstd compression stream that is cut into blocks.
class Packer {
 public:
  Packer();
  /// Starts an independent stream.
  void restart();
  /// Returns data from which, after all data returned before it, `content` can be decompressed.
  std::vector<std::byte> pack(const std::vector<std::byte>& content);

 private:
  std::unique_ptr<ZSTD_CCtx_s, void (*)(ZSTD_CCtx_s*)> stream_;
};

/// The decompression stream for Packer.
class Unpacker {
 public:
  Unpacker();
  void restart();
  /// Decompresses a block; throws InputError, naming `file`, if its size is not `content_bytes`.
  std::vector<std::byte> unpack(const std::vector<std::byte>& packed, std::uint64_t content_bytes,
                                const std::string& file);

 private:
  std::unique_ptr<ZSTD_DCtx_s, void (*)(ZSTD_DCtx_s*)> stream_;
};

}  // namespace sunder
