// The blocks a take consists of. Layout of the file: "SUNDERT7" (or 6: breaks without pieces and
// materials; or 5: without names and lights, and nobody knows what came off what, either), blocks
// one after the other, and, where the run came to its end, an index of them, of which the last 16
// bytes say where it begins.
//
// A block is a header and bytes in zstd. Blocks of one chunk of frames (a key frame and those that
// are changes of it) are one zstd stream, flushed after every frame.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/io/bytes.h"

struct ZSTD_CCtx_s;
struct ZSTD_DCtx_s;

namespace sunder {

inline constexpr char kTakeMagic[8] = {'S', 'U', 'N', 'D', 'E', 'R', 'T', '7'};
inline constexpr std::size_t kTakeName = sizeof kTakeMagic - 1;  ///< What precedes the version.
inline constexpr char kOldestTake = '5';                         ///< That can be read.
inline constexpr char kFirstWithNames = '6';   ///< And lights, and what bodies came off.
inline constexpr char kFirstWithPieces = '7';  ///< Breaks have their pieces and materials.
inline constexpr char kIndexMagic[8] = {'T', 'A', 'K', 'E', 'E', 'N', 'D', '1'};
inline constexpr std::uint64_t kFramesAChunk = 120;
inline constexpr std::uint64_t kMostBlockBytes = 1ull << 30;  ///< Larger ones are refused.

enum class BlockKind : std::uint32_t {
  kMaterials = 1,  ///< And paints, where a run has any.
  kMeshes,         ///< What the mesh store has grown by; where there are paints, with their places.
  kKeyFrame,       ///< Stands alone; begins a chunk.
  kFrame,          ///< A change of the frame before.
  kIndex,
};

/// As in the file, 40 bytes.
struct BlockHeader {
  BlockKind kind = BlockKind::kMaterials;
  std::uint32_t first = 0;  ///< The frame, counted from 0 in the take, or the first of the meshes.
  std::uint64_t bytes = 0;  ///< That follow.
  std::uint64_t content_bytes = 0;  ///< Unpacked.
  std::uint64_t hash = 0;           ///< XXH3 of those that follow, seeded by all above.
  std::uint64_t header_hash = 0;    ///< XXH3 of all above.
};

/// Where a block is.
struct BlockPlace {
  std::uint64_t offset = 0;
  BlockKind kind = BlockKind::kMaterials;
  std::uint32_t first = 0;
};

/// A block, header included.
std::vector<std::byte> make_block(BlockKind kind, std::uint32_t first, std::uint64_t content_bytes,
                                  const std::vector<std::byte>& packed);
/// Whether the bytes are a header of a kind that exists, its sums right.
bool is_sound(const BlockHeader& header);
bool matches(const BlockHeader& header, const std::vector<std::byte>& packed);

/// A zstd stream that is cut into blocks.
class Packer {
 public:
  Packer();
  /// What comes next does not refer to what came before.
  void restart();
  /// All of `content` can be unpacked from what has been given back so far.
  std::vector<std::byte> pack(const std::vector<std::byte>& content);

 private:
  std::unique_ptr<ZSTD_CCtx_s, void (*)(ZSTD_CCtx_s*)> stream_;
};

/// The other end.
class Unpacker {
 public:
  Unpacker();
  void restart();
  /// Throws InputError, naming `file`, if `packed` does not hold `content_bytes`.
  std::vector<std::byte> unpack(const std::vector<std::byte>& packed, std::uint64_t content_bytes,
                                const std::string& file);

 private:
  std::unique_ptr<ZSTD_DCtx_s, void (*)(ZSTD_DCtx_s*)> stream_;
};

}  // namespace sunder
