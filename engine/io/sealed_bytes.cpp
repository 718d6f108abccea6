#include "engine/io/sealed_bytes.h"

#include <algorithm>
#include <memory>
#include <string_view>

#include <zstd.h>

#include "engine/base/check.h"

namespace sunder {
namespace {

/// First bytes of a sealed state; then come the version, an end of line, and a frame of zstd, which
/// has a checksum.
constexpr std::string_view kMark = "Sunder state ";
constexpr int kSealLevel = 1;  // fast: a state is often stored to be read once

std::string head() { return std::string(kMark) + SUNDER_VERSION "\n"; }

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
  const std::string_view text(reinterpret_cast<const char*>(sealed.data()), sealed.size());
  if (!text.starts_with(kMark)) throw InputError(name + ": these bytes are no saved state");
  const std::string first = head();
  if (!text.starts_with(first)) {
    const std::string_view version = text.substr(kMark.size(), 16);
    throw InputError(name + ": the state was saved by version " +
                     std::string(version.substr(0, version.find('\n'))) +
                     "; only that version can restore it, and this is " SUNDER_VERSION);
  }
  const auto packed = sealed.subspan(first.size());
  const unsigned long long size = ZSTD_getFrameContentSize(packed.data(), packed.size());
  constexpr unsigned long long kMostTimes = 1u << 17;  // more than zstd can compress anything
  if (size != ZSTD_CONTENTSIZE_ERROR && size != ZSTD_CONTENTSIZE_UNKNOWN &&
      size / kMostTimes <= packed.size()) {
    std::vector<std::byte> content(static_cast<std::size_t>(size));
    if (ZSTD_decompress(content.data(), content.size(), packed.data(), packed.size()) == size)
      return content;
  }
  throw InputError(name + ": the saved state is truncated or damaged");
}

}  // namespace sunder
