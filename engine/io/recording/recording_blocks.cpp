#include "engine/io/recording/recording_blocks.h"

#include <cstddef>

#include <xxhash.h>
#include <zstd.h>

namespace sunder {
namespace {

// A higher level slows the run more than it saves space.
constexpr int kCompressionLevel = 3;

std::uint64_t hash_header(const BlockHeader& header) {
  return XXH3_64bits(&header, offsetof(BlockHeader, header_hash));
}
std::uint64_t hash_bytes(const BlockHeader& header, const std::vector<std::byte>& packed) {
  const std::uint64_t seed = XXH3_64bits(&header, offsetof(BlockHeader, hash));
  return XXH3_64bits_withSeed(packed.data(), packed.size(), seed);
}

void free_packer(ZSTD_CCtx* stream) { ZSTD_freeCCtx(stream); }
void free_unpacker(ZSTD_DCtx* stream) { ZSTD_freeDCtx(stream); }

}  // namespace

static_assert(sizeof(BlockHeader) == 40);

std::vector<std::byte> make_block(BlockKind kind, std::uint32_t first, std::uint64_t content_bytes,
                                  const std::vector<std::byte>& packed) {
  BlockHeader header{kind, first, packed.size(), content_bytes, 0, 0};
  header.hash = hash_bytes(header, packed);
  header.header_hash = hash_header(header);
  ByteWriter out;
  out.put(header);
  out.bytes.insert(out.bytes.end(), packed.begin(), packed.end());
  return std::move(out.bytes);
}

bool is_valid(const BlockHeader& header) {
  return header.header_hash == hash_header(header) && header.kind >= BlockKind::kMaterials &&
         header.kind <= BlockKind::kIndex && header.content_bytes <= kMaxBlockBytes &&
         header.bytes <= kMaxBlockBytes;
}

bool matches(const BlockHeader& header, const std::vector<std::byte>& packed) {
  return packed.size() == header.bytes && hash_bytes(header, packed) == header.hash;
}

Packer::Packer() : stream_(ZSTD_createCCtx(), free_packer) {
  SUNDER_CHECK(stream_ != nullptr);
  ZSTD_CCtx_setParameter(stream_.get(), ZSTD_c_compressionLevel, kCompressionLevel);
}

void Packer::restart() { ZSTD_CCtx_reset(stream_.get(), ZSTD_reset_session_only); }

std::vector<std::byte> Packer::pack(const std::vector<std::byte>& content) {
  std::vector<std::byte> packed(ZSTD_compressBound(content.size()) + 64);
  ZSTD_inBuffer in{content.data(), content.size(), 0};
  ZSTD_outBuffer out{packed.data(), packed.size(), 0};
  const std::size_t left = ZSTD_compressStream2(stream_.get(), &out, &in, ZSTD_e_flush);
  SUNDER_CHECK(left == 0 && in.pos == in.size);
  packed.resize(out.pos);
  return packed;
}

Unpacker::Unpacker() : stream_(ZSTD_createDCtx(), free_unpacker) {
  SUNDER_CHECK(stream_ != nullptr);
}

void Unpacker::restart() { ZSTD_DCtx_reset(stream_.get(), ZSTD_reset_session_only); }

std::vector<std::byte> Unpacker::unpack(const std::vector<std::byte>& packed,
                                        std::uint64_t content_bytes, const std::string& file) {
  std::vector<std::byte> content(content_bytes);
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  ZSTD_outBuffer out{content.data(), content.size(), 0};
  while (in.pos < in.size) {
    const std::size_t in_before = in.pos, out_before = out.pos;
    const std::size_t left = ZSTD_decompressStream(stream_.get(), &out, &in);
    const bool stuck = in.pos == in_before && out.pos == out_before;
    if (ZSTD_isError(left) || stuck) break;
  }
  // Output that the stream still buffers needs no more input.
  while (out.pos < out.size) {
    const std::size_t before = out.pos;
    if (ZSTD_isError(ZSTD_decompressStream(stream_.get(), &out, &in)) || out.pos == before) break;
  }
  if (in.pos != in.size || out.pos != out.size) {
    throw InputError(file + ": corrupt: cannot be unpacked");
  }
  return content;
}

}  // namespace sunder
