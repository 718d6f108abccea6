// Bits and numbers as few bytes: a range coder whose models learn from what went by.
//
// Read first: BitModel, then NumberModel. Writer and reader keep the same models in step, so a
// number that is what its kind mostly is costs a fraction of a bit (Martin 1979; the binary form
// with carries held back is that of LZMA).
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>

#include "engine/io/bytes.h"

namespace sunder {

/// How likely a bit is to be 0, learnt from those so far: fast at first, then slowly.
class BitModel {
 public:
  /// In 65536ths, never none and never all.
  std::uint32_t zero() const { return zero_; }
  void learn(bool bit) {
    const int rate = rate_ < kSlowest ? rate_++ : kSlowest;
    zero_ = static_cast<std::uint16_t>(bit ? zero_ - (zero_ >> rate)
                                           : zero_ + ((65536u - zero_) >> rate));
    if (zero_ < kLeast) zero_ = kLeast;
    if (zero_ > 65536 - kLeast) zero_ = static_cast<std::uint16_t>(65536 - kLeast);
  }

 private:
  static constexpr std::uint8_t kSlowest = 6;
  static constexpr std::uint16_t kLeast = 64;
  std::uint16_t zero_ = 32768;
  std::uint8_t rate_ = 1;
};

/// One run of bits into bytes.
class BitWriter {
 public:
  void put(BitModel& model, bool bit);
  /// The low bits of a number that may as well be any.
  void put_plain(std::uint32_t bits, int count);
  /// Appends what was put, with its length before it.
  void finish(ByteWriter& out);

 private:
  void shift();

  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xffffffff;
  std::uint64_t held_ = 0;  ///< Bytes 0xff behind `last_`, which a carry may still change.
  std::byte last_{};
  bool first_ = true;
  std::vector<std::byte> bytes_;
};

/// The way back. Whatever the bytes, it reads bits, and zeros behind their end.
class BitReader {
 public:
  /// Throws InputError if `in` holds no such run; its bytes are used as long as this.
  explicit BitReader(ByteReader& in);
  bool take(BitModel& model);
  std::uint32_t take_plain(int count);

 private:
  std::uint32_t next_byte();
  void shift();

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  std::uint32_t range_ = 0xffffffff;
  std::uint32_t code_ = 0;
};

/// Numbers that are mostly small: how many bits each has, the two below the first, the rest plain.
class NumberModel {
 public:
  void put(BitWriter& out, std::uint32_t number);
  std::uint32_t take(BitReader& in);

 private:
  std::array<BitModel, 32> longer_;
  std::array<std::array<BitModel, 3>, 33> below_;  ///< By length: the next bit, and that after it.
};

}  // namespace sunder
