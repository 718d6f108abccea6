// Adaptive range coding of bits and numbers.
//
// Begin with BitModel, then NumberModel. Writer and reader update equal models, so that a frequent
// value costs a fraction of a bit (Martin 1979; the binary form with delayed carries is that of
// LZMA).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "engine/io/bytes.h"

namespace sunder {

/// Adaptive estimate of the probability that a bit is 0; adapts fast at first, then slowly.
class BitModel {
 public:
  /// Probability of 0, in 65536ths; never 0 or 1.
  std::uint32_t zero() const { return zero_; }
  void learn(bool bit) {
    const int rate = rate_ < kMaxRate ? rate_++ : kMaxRate;
    zero_ = static_cast<std::uint16_t>(bit ? zero_ - (zero_ >> rate)
                                           : zero_ + ((65536u - zero_) >> rate));
    if (zero_ < kMinProbability) zero_ = kMinProbability;
    if (zero_ > 65536 - kMinProbability)
      zero_ = static_cast<std::uint16_t>(65536 - kMinProbability);
  }

 private:
  static constexpr std::uint8_t kMaxRate = 6;
  static constexpr std::uint16_t kMinProbability = 64;
  std::uint16_t zero_ = 32768;
  std::uint8_t rate_ = 1;
};

/// Encodes a sequence of bits.
class BitWriter {
 public:
  void put(BitModel& model, bool bit);
  /// Appends the low `count` bits of a number without a model.
  void put_uniform(std::uint32_t bits, int count);
  /// Appends the length and the encoded bytes to `out`.
  void finish(ByteWriter& out);

 private:
  void shift();

  std::uint64_t low_ = 0;
  std::uint32_t range_ = 0xffffffff;
  std::uint64_t held_ = 0;  ///< Number of bytes 0xff after `last_`, which a carry may still change.
  std::byte last_{};
  bool first_ = true;
  std::vector<std::byte> bytes_;
};

/// Decodes a sequence of bits; any bytes are valid, and zeros follow their end.
class BitReader {
 public:
  /// Begins a sequence; throws InputError if `in` is too short. The bytes must outlive this object.
  explicit BitReader(ByteReader& in);
  bool take(BitModel& model);
  std::uint32_t take_uniform(int count);

 private:
  std::uint32_t next_byte();
  void shift();

  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  std::uint32_t range_ = 0xffffffff;
  std::uint32_t code_ = 0;
};

/// Adaptive code of mostly small numbers: the bit length and the two bits below the highest have
/// models, the rest has none.
class NumberModel {
 public:
  void put(BitWriter& out, std::uint32_t number);
  std::uint32_t take(BitReader& in);

 private:
  std::array<BitModel, 32> longer_;
  /// By bit length: the second highest bit, and the third for either value of the second.
  std::array<std::array<BitModel, 3>, 33> below_;
};

}  // namespace sunder
