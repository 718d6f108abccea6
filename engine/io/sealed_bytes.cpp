#include "engine/io/sealed_bytes.h"

#include <algorithm>
#include <memory>
#include <string_view>

#include <zstd.h>

#include "engine/base/check.h"

namespace sunder {

/// Digest of the sources of the engine, the solver and the fractures (cmake/source_digest.cmake).
extern const char* const kSourceDigest;

namespace {

/// First bytes of a sealed state; then come the version, the digest of the sources, an end of line,
/// and a frame of zstd, which has a checksum.
constexpr std::string_view kMark = "Sunder state ";
constexpr int kSealLevel = 1;  // fast: a state is often stored to be read once
/// Bytes of a state that a byte of its frame may stand for; those of a large and empty one are 60.
constexpr std::size_t kMostTimes = 1024;
constexpr std::size_t kLeastLimit = 1 << 20;

std::string build() { return std::string(SUNDER_VERSION ", build ") + kSourceDigest; }
std::string head() { return std::string(kMark) + build() + "\n"; }

/// Returns the content of a frame of zstd, whose memory grows with what is decompressed; empty if
/// the frame is damaged.
std::vector<std::byte> decompressed(std::span<const std::byte> packed) {
  const std::size_t most = std::max(kLeastLimit, kMostTimes * packed.size());
  const std::unique_ptr<ZSTD_DCtx, std::size_t (*)(ZSTD_DCtx*)> unpacker(ZSTD_createDCtx(),
                                                                         ZSTD_freeDCtx);
  std::vector<std::byte> content(std::min(most, 4 * packed.size() + kLeastLimit));
  ZSTD_inBuffer in{packed.data(), packed.size(), 0};
  for (std::size_t done = 0;;) {
    ZSTD_outBuffer out{content.data(), content.size(), done};
    const std::size_t in_before = in.pos;
    const std::size_t left = ZSTD_decompressStream(unpacker.get(), &out, &in);
    if (ZSTD_isError(left)) return {};
    const bool is_stuck = out.pos == done && in.pos == in_before;
    done = out.pos;
    if (left == 0) {
      content.resize(in.pos == in.size ? done : 0);
      return content;
    }
    if (done == content.size()) {
      if (content.size() >= most) return {};
      content.resize(std::min(most, 2 * content.size()));
    } else if (is_stuck) {
      return {};
    }
  }
}

}  // namespace

std::vector<std::byte> seal(std::span<const std::byte> content) {
  const std::string first = head();
  std::vector<std::byte> sealed(first.size() + ZSTD_compressBound(content.size()));
  std::ranges::copy(std::as_bytes(std::span(first)), sealed.begin());
  const std::unique_ptr<ZSTD_CCtx, std::size_t (*)(ZSTD_CCtx*)> packer(ZSTD_createCCtx(),
                                                                       ZSTD_freeCCtx);
  ZSTD_CCtx_setParameter(packer.get(), ZSTD_c_compressionLevel, kSealLevel);
  ZSTD_CCtx_setParameter(packer.get(), ZSTD_c_checksumFlag, 1);
  const std::size_t size =
      ZSTD_compress2(packer.get(), sealed.data() + first.size(), sealed.size() - first.size(),
                     content.data(), content.size());
  SUNDER_CHECK(!ZSTD_isError(size));
  sealed.resize(first.size() + size);
  return sealed;
}

std::vector<std::byte> unseal(std::span<const std::byte> sealed, const std::string& name) {
  constexpr std::size_t kLongestBuild = 100;
  const std::string_view text(reinterpret_cast<const char*>(sealed.data()), sealed.size());
  if (!text.starts_with(kMark)) throw InputError(name + ": these bytes are no saved state");
  const std::string first = head();
  const std::string_view by = text.substr(kMark.size(), kLongestBuild);
  const std::size_t end = by.find('\n');
  if (end != std::string_view::npos && !text.starts_with(first)) {
    throw InputError(name + ": the state was saved by version " + std::string(by.substr(0, end)) +
                     "; only the build that saved a state can restore it, and this is version " +
                     build());
  }
  std::vector<std::byte> content;
  if (end != std::string_view::npos) content = decompressed(sealed.subspan(first.size()));
  if (content.empty()) throw InputError(name + ": the saved state is truncated or damaged");
  return content;
}

}  // namespace sunder
