// States whose content is wrong though their seal fits: each is refused by the name of a field, or
// goes on.
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "engine/base/random.h"
#include "tests/fuzz/small_worlds.h"

namespace sunder {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

template <class T>
std::vector<std::byte> with(const std::vector<std::byte>& state, std::size_t at, T value) {
  std::vector<std::byte> forged = state;
  std::memcpy(&forged[at], &value, sizeof value);
  return forged;
}

TEST(ForgedStates, AreRunAsTheyAreIfNothingIsForged) {
  ASSERT_EQ(fuzz::small_states().size(), 4u);
  for (const std::vector<std::byte>& state : fuzz::small_states())
    EXPECT_EQ(fuzz::run_state(state, 10), "");
}

// A number that is not finite passes nowhere: all places of a double are tried in one of 97.
TEST(ForgedStates, WithNumbersThatAreNoneAreRefusedByField) {
  std::size_t refused = 0, named = 0;
  for (const std::vector<std::byte>& state : fuzz::small_states()) {
    const std::size_t step = state.size() / 200 / 8 * 8 + 8;
    for (std::size_t at = 0; at + 8 <= state.size(); at += step) {
      const std::string said = fuzz::run_state(with(state, at, kNaN), 1);
      refused += !said.empty();
      named += said.find("field ") != std::string::npos || said.find("::") != std::string::npos ||
               said.find("scene.") != std::string::npos;
      if (!said.empty()) {
        EXPECT_EQ(said.find("forged.state: "), 0u) << said;
      }
    }
  }
  EXPECT_GT(refused, 300u);
  EXPECT_GT(named, 250u);
}

TEST(ForgedStates, OfAnyKindAreRefusedOrGoOn) {
  Random random(7, 0);
  for (const std::vector<std::byte>& state : fuzz::small_states()) {
    for (int i = 0; i < 150; ++i) {
      const auto at = random.below(static_cast<std::uint32_t>(state.size() / 4 - 1)) * 4;
      const std::uint32_t values[] = {0xffffffff, 0, 7, 0x7f800000, 0x80000000};
      fuzz::run_state(with(state, at, values[i % 5]), 2);
    }
  }
}

}  // namespace
}  // namespace sunder
