#include "engine/io/recording/bit_coder.h"

#include <bit>

namespace sunder {
namespace {

constexpr std::uint32_t kMinRange = 1u << 24;

}  // namespace

/// Outputs the highest byte; bytes 0xff are held back until a carry is decided.
void BitWriter::shift() {
  const auto low = static_cast<std::uint32_t>(low_);
  const bool carry = (low_ >> 32) != 0;
  if (low < 0xff000000u || carry) {
    const auto add = std::byte{static_cast<unsigned char>(carry ? 1 : 0)};
    const auto sum = [&](std::byte byte) {
      return static_cast<std::byte>(std::to_integer<unsigned>(byte) +
                                    std::to_integer<unsigned>(add));
    };
    if (!first_) bytes_.push_back(sum(last_));
    for (; held_ > 0; --held_) bytes_.push_back(sum(std::byte{0xff}));
    first_ = false;
    last_ = static_cast<std::byte>(low >> 24);
  } else {
    ++held_;
  }
  low_ = std::uint64_t{low & 0x00ffffffu} << 8;
}

void BitWriter::put(BitModel& model, bool bit) {
  const std::uint32_t zero = (range_ >> 16) * model.zero();
  if (bit) {
    low_ += zero;
    range_ -= zero;
  } else {
    range_ = zero;
  }
  model.learn(bit);
  for (; range_ < kMinRange; range_ <<= 8) shift();
}

void BitWriter::put_uniform(std::uint32_t bits, int count) {
  for (int b = count - 1; b >= 0; --b) {
    range_ >>= 1;
    if ((bits >> b & 1) != 0) low_ += range_;
    for (; range_ < kMinRange; range_ <<= 8) shift();
  }
}

void BitWriter::finish(ByteWriter& out) {
  for (int i = 0; i < 5; ++i) shift();
  // the reader supplies these zeros
  while (!bytes_.empty() && bytes_.back() == std::byte{}) bytes_.pop_back();
  out.put(static_cast<std::uint32_t>(bytes_.size()));
  out.bytes.insert(out.bytes.end(), bytes_.begin(), bytes_.end());
}

BitReader::BitReader(ByteReader& in) {
  bytes_ = in.take_bytes(in.take_count(1));
  for (int i = 0; i < 4; ++i) code_ = code_ << 8 | next_byte();
}

std::uint32_t BitReader::next_byte() {
  return at_ < bytes_.size() ? std::to_integer<std::uint32_t>(bytes_[at_++]) : 0;
}

void BitReader::shift() {
  for (; range_ < kMinRange; range_ <<= 8) code_ = code_ << 8 | next_byte();
}

bool BitReader::take(BitModel& model) {
  const std::uint32_t zero = (range_ >> 16) * model.zero();
  const bool bit = code_ >= zero;
  if (bit) {
    code_ -= zero;
    range_ -= zero;
  } else {
    range_ = zero;
  }
  model.learn(bit);
  shift();
  return bit;
}

std::uint32_t BitReader::take_uniform(int count) {
  std::uint32_t bits = 0;
  for (int b = 0; b < count; ++b) {
    range_ >>= 1;
    const bool bit = code_ >= range_;
    if (bit) code_ -= range_;
    bits = bits << 1 | (bit ? 1 : 0);
    shift();
  }
  return bits;
}

void NumberModel::put(BitWriter& out, std::uint32_t number) {
  const auto length = static_cast<std::uint32_t>(std::bit_width(number));
  for (std::uint32_t l = 0; l < length; ++l) out.put(longer_[l], true);
  if (length < 32) out.put(longer_[length], false);
  if (length < 2) return;
  auto& below = below_[length];
  const bool high = (number >> (length - 2) & 1) != 0;
  out.put(below[0], high);
  if (length < 3) return;
  out.put(below[high ? 2 : 1], (number >> (length - 3) & 1) != 0);
  out.put_uniform(number, static_cast<int>(length) - 3);
}

std::uint32_t NumberModel::take(BitReader& in) {
  std::uint32_t length = 0;
  while (length < 32 && in.take(longer_[length])) ++length;
  if (length < 2) return length;
  auto& below = below_[length];
  const bool high = in.take(below[0]);
  std::uint32_t number = 2 | (high ? 1 : 0);
  if (length < 3) return number;
  number = number << 1 | (in.take(below[high ? 2 : 1]) ? 1 : 0);
  for (int rest = static_cast<int>(length) - 3; rest > 0;) {
    const int some = rest < 16 ? rest : 16;
    number = number << some | in.take_uniform(some);
    rest -= some;
  }
  return number;
}

}  // namespace sunder
