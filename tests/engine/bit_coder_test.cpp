// Tests of the range coder: round trips, size of repeated numbers, damaged bytes.
#include "engine/io/recording/bit_coder.h"

#include <gtest/gtest.h>

#include "engine/base/random.h"

namespace sunder {
namespace {

/// Returns eight special numbers and `count` random numbers of 0 to 32 bits.
std::vector<std::uint32_t> numbers(int count) {
  Random random(5);
  std::vector<std::uint32_t> all = {0, 1, 2, 3, 4, 0x7fffffff, 0x80000000, 0xffffffff};
  for (int i = 0; i < count; ++i) {
    const auto bits = static_cast<std::uint32_t>(random.uniform() * 4294967295.0);
    all.push_back(bits >> static_cast<int>(random.uniform() * 31.9));
  }
  return all;
}

std::vector<std::byte> written(std::span<const std::uint32_t> all) {
  NumberModel model;
  BitWriter bits;
  for (const std::uint32_t number : all) {
    model.put(bits, number);
    bits.put_uniform(number, 5);
  }
  ByteWriter out;
  bits.finish(out);
  return out.bytes;
}

TEST(BitCoder, NumbersOfEveryLengthAreReadBack) {
  for (const int count : {0, 1, 1000, 100000}) {
    const std::vector<std::uint32_t> all = numbers(count);
    const std::vector<std::byte> bytes = written(all);
    ByteReader in(bytes, "test");
    BitReader bits(in);
    EXPECT_TRUE(in.at_end());
    NumberModel model;
    for (std::size_t i = 0; i < all.size(); ++i) {
      ASSERT_EQ(model.take(bits), all[i]) << i;
      ASSERT_EQ(bits.take_uniform(5), all[i] & 31) << i;
    }
  }
}

TEST(BitCoder, CarriesPropagateThroughBytesOf255) {
  // Ones of a bit that is mostly zero lie at the top of the coder's range.
  for (int ones = 1; ones < 200; ++ones) {
    BitModel rare, seen;
    BitWriter bits;
    for (int i = 0; i < 400; ++i) bits.put(rare, i >= 400 - ones);
    ByteWriter out;
    bits.finish(out);
    ByteReader in(out.bytes, "test");
    BitReader back(in);
    for (int i = 0; i < 400; ++i) ASSERT_EQ(back.take(seen), i >= 400 - ones) << ones << ' ' << i;
  }
}

TEST(BitCoder, RepeatedNumbersTakeAFractionOfABitEach) {
  NumberModel model;
  BitWriter bits;
  for (int i = 0; i < 80000; ++i) model.put(bits, 0);
  ByteWriter out;
  bits.finish(out);
  EXPECT_LT(out.bytes.size(), 80000u / 8 / 50);
}

TEST(BitCoder, ReadsDamagedBytesAsOtherNumbersAndZerosBeyondTheirEnd) {
  const std::vector<std::uint32_t> all = numbers(2000);
  std::vector<std::byte> bytes = written(all);
  Random random(9);
  for (int i = 0; i < 100; ++i) {
    std::vector<std::byte> harmed = bytes;
    const auto at = static_cast<std::size_t>(4 + random.uniform() * double(bytes.size() - 5));
    harmed[at] ^= std::byte{0x40};
    ByteReader in(harmed, "test");
    BitReader bits(in);
    NumberModel model;
    bool differs = false;
    for (const std::uint32_t number : all) {
      differs |= model.take(bits) != number;
      differs |= bits.take_uniform(5) != (number & 31);
    }
    EXPECT_TRUE(differs) << at;
    for (int more = 0; more < 10000; ++more) model.take(bits);
  }
  bytes.resize(bytes.size() - 1);
  ByteReader cut(bytes, "test");
  EXPECT_THROW(BitReader{cut}, InputError);
}

}  // namespace
}  // namespace sunder
