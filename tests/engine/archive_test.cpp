// The state of objects as bytes.
#include "engine/base/archive.h"

#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/check.h"
#include "engine/base/random.h"

namespace sunder {
namespace {

enum class Kind : std::uint8_t { kFirst, kSecond };

/// Padding follows each field but the last.
struct Padded {
  std::uint8_t small = 0;
  double large = 0;
  Kind kind = Kind::kFirst;
  Vec3 vector = Vec3::Zero();
};

struct Node {
  std::string name;
  std::shared_ptr<const Node> next;
};

class Hidden {
 public:
  Hidden() = default;
  explicit Hidden(int number) : number_(number), cache_(number * 2) {}
  static auto fields(auto& self) { return std::tie(self.number_); }
  int number() const { return number_; }
  int cache() const { return cache_; }

 private:
  int number_ = 0;
  int cache_ = 0;
};

struct Everything {
  bool flag = false;
  float array[3] = {};
  std::array<Padded, 2> padded;
  std::vector<Padded> list;
  std::vector<float> numbers;
  std::vector<std::vector<Quat>> nested;
  std::optional<Vec3> some, none;
  std::map<std::uint32_t, std::string> names;
  std::set<std::uint64_t> keys;
  std::pair<int, std::string> both;
  std::shared_ptr<const Node> a, b;
  Index<struct SomeTag> index;
  std::vector<Hidden> hidden;
};

Everything example(std::uint64_t seed) {
  Random random(seed, 0);
  const auto number = [&] { return random.uniform(-1, 1); };
  Everything all;
  all.flag = true;
  for (float& x : all.array) x = static_cast<float>(number());
  all.list.resize(1 + seed % 5);
  for (Padded& one : all.list)
    one = {7, number(), Kind::kSecond, Vec3(number(), number(), number())};
  all.padded = {all.list[0], {}};
  all.numbers.assign(seed % 7, 1.5f);
  all.nested = {{}, {Quat(1, 2, 3, number()).normalized()}};
  all.some = Vec3(1, 2, number());
  all.names = {{3, "three"}, {9, std::string(40, 'x')}};
  all.keys = {5, 1, ~std::uint64_t{0}};
  all.both = {-4, "four"};
  const auto end = std::make_shared<const Node>(Node{"end", nullptr});
  all.a = std::make_shared<const Node>(Node{"a", end});
  all.b = std::make_shared<const Node>(Node{"b", end});
  all.index = Index<struct SomeTag>(std::size_t{12});
  all.hidden = {Hidden(3)};
  return all;
}

std::vector<std::byte> bytes_of(Everything& all) {
  Archive out;
  out(all);
  return out.take();
}

TEST(Archive, ReadsWhatItWrote) {
  Everything all = example(4);
  const std::vector<std::byte> bytes = bytes_of(all);
  Archive in(bytes);
  EXPECT_TRUE(in.reads());
  Everything read = example(3);  // other values, which go
  in(read);
  in.finish();
  EXPECT_TRUE(read.flag);
  EXPECT_EQ(read.array[2], all.array[2]);
  ASSERT_EQ(read.list.size(), all.list.size());
  EXPECT_EQ(read.list.back().vector, all.list.back().vector);
  EXPECT_EQ(read.padded[0].kind, Kind::kSecond);
  EXPECT_EQ(read.numbers, all.numbers);
  EXPECT_EQ(read.nested[1][0].coeffs(), all.nested[1][0].coeffs());
  EXPECT_EQ(read.some, all.some);
  EXPECT_FALSE(read.none);
  EXPECT_EQ(read.names, all.names);
  EXPECT_EQ(read.keys, all.keys);
  EXPECT_EQ(read.both, all.both);
  EXPECT_EQ(read.index, all.index);
  EXPECT_EQ(read.hidden[0].number(), 3);
  EXPECT_EQ(read.hidden[0].cache(), 0);  // not among its fields
}

TEST(Archive, KeepsWhatIsShared) {
  Everything all = example(1);
  const std::vector<std::byte> bytes = bytes_of(all);
  Archive in(bytes);
  Everything read;
  in(read);
  EXPECT_EQ(read.a->name, "a");
  EXPECT_EQ(read.a->next, read.b->next);
  EXPECT_EQ(read.a->next->name, "end");
  EXPECT_EQ(read.a->next->next, nullptr);
}

TEST(Archive, EqualStatesHaveEqualBytes) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    Everything one = example(seed), other = example(seed);
    const Padded first = one.list[0];
    std::memset(static_cast<void*>(other.list.data()), 0x5a, sizeof(Padded));  // padding as well
    other.list[0].small = first.small, other.list[0].large = first.large;
    other.list[0].kind = first.kind, other.list[0].vector = first.vector;
    const std::vector<std::byte> bytes = bytes_of(one);
    EXPECT_EQ(bytes, bytes_of(other));
    Archive in(bytes);
    Everything read;
    in(read);
    EXPECT_EQ(bytes, bytes_of(read));
  }
}

TEST(Archive, RefusesBytesThatAreCutOff) {
  Everything all = example(6);
  const std::vector<std::byte> bytes = bytes_of(all);
  for (std::size_t size = 0; size < bytes.size(); ++size) {
    Archive in(std::span<const std::byte>(bytes).first(size));
    Everything read;
    EXPECT_THROW(in(read), InputError) << size;
  }
  std::vector<std::byte> more = bytes;
  more.push_back({});
  Archive in(more);
  Everything read;
  in(read);
  EXPECT_THROW(in.finish(), InputError);
}

/// Has a list, and an index into it.
struct Chosen {
  std::vector<std::uint32_t> list;
  std::uint32_t index = 0;
  const char* wrong_field() const { return index < list.size() ? nullptr : "index"; }
};

struct Unlimited {
  static constexpr bool kMayBeInfinite = true;
  double most = std::numeric_limits<double>::infinity();
  std::optional<double> if_any = most;
};

/// Writes one object, reads its bytes as another class, and returns why they are refused.
template <class Read, class Written>
std::string refusal(Written written) {
  Archive out;
  out(written);
  const std::vector<std::byte> bytes = out.take();
  Archive in(bytes);
  Read read{};
  try {
    in(read);
  } catch (const InputError& error) {
    return error.what();
  }
  return {};
}

TEST(Archive, RefusesValuesThatAreNone) {
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const auto expect = [](const std::string& said, const std::string& why) {
    EXPECT_NE(said.find(why), std::string::npos) << said;
  };
  expect(refusal<Vec3>(Vec3(0, kNaN, 0)), "not finite");
  expect(refusal<std::vector<float>>(std::vector<float>{1, static_cast<float>(kInfinity)}),
         "not finite");
  expect(refusal<std::optional<double>>(std::optional(kInfinity)), "not finite");
  expect(refusal<Kind>(std::uint8_t{2}), "Kind has no value 2");
  expect(refusal<Quat>(Quat(1, 1, 0, 0)), "not of unit length");
  expect(refusal<std::set<std::uint64_t>>(std::vector<std::uint64_t>{3, 3}), "do not ascend");
  expect(refusal<std::vector<Padded>>(std::vector<Padded>{{}, {1, kNaN, Kind::kFirst, {}}}),
         "Padded, field 1");
  EXPECT_EQ(refusal<Unlimited>(Unlimited()), "");
  expect(refusal<Unlimited>(Unlimited{kNaN, {}}), "not finite");
}

TEST(Archive, RefusesWhatAClassFindsWrongAndNamesTheField) {
  EXPECT_EQ(refusal<Chosen>(Chosen{{7, 8}, 1}), "");
  const std::string said = refusal<std::vector<Chosen>>(std::vector<Chosen>{{{7}, 0}, {{7}, 1}});
  EXPECT_NE(said.find("Chosen::index is wrong"), std::string::npos) << said;
}

// A count may claim no more elements than the bytes behind it can hold.
TEST(Archive, RefusesCountsBeforeTheyTakeMemory) {
  struct Large {
    std::string text;
    std::array<std::vector<int>, 40> lists;
  };
  std::vector<std::uint64_t> words(1000, 0);
  words[0] = 500;  // each has 41 counts of 8 bytes
  Archive in(std::as_bytes(std::span(words)));
  std::vector<Large> read;
  EXPECT_THROW(in(read), InputError);
  EXPECT_TRUE(read.empty());
}

// Neither a crash nor memory without bounds.
TEST(Archive, ReadsOtherValuesOrRefusesBytesThatHaveChanged) {
  Everything all = example(6);
  const std::vector<std::byte> bytes = bytes_of(all);
  for (std::size_t at = 0; at < bytes.size(); ++at) {
    for (const int bit : {0, 7}) {
      std::vector<std::byte> other = bytes;
      other[at] ^= static_cast<std::byte>(1 << bit);
      Archive in(other);
      Everything read;
      try {
        in(read);
        in.finish();
        EXPECT_LE(bytes_of(read).size(), bytes.size()) << at;
      } catch (const InputError&) {
      }
    }
  }
}

}  // namespace
}  // namespace sunder
