// Fuzz target: a saved state with any changes, and a seal that fits, is refused with an InputError
// or goes on with finite frames.
//
// The bytes are the number of a state of small_states(), then changes of ten bytes each: a place in
// the state, a kind of change, and the value that it writes.
#include <array>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

#include "tests/fuzz/fuzz_target.h"
#include "tests/fuzz/small_worlds.h"

namespace sunder {
namespace {

constexpr std::size_t kChangeBytes = 10, kMostChanges = 8;

template <class T>
T read(const std::uint8_t* from) {
  T value;
  std::memcpy(&value, from, sizeof value);
  return value;
}

template <class T>
void write(T value, std::size_t at, std::vector<std::byte>& state) {
  if (at + sizeof value <= state.size()) std::memcpy(&state[at], &value, sizeof value);
}

/// Carries out one change.
void change(const std::uint8_t* bytes, std::vector<std::byte>& state) {
  constexpr std::array<double, 8> kOdd = {std::numeric_limits<double>::quiet_NaN(),
                                          std::numeric_limits<double>::infinity(),
                                          -1,
                                          0,
                                          1e300,
                                          -1e30,
                                          1e-300,
                                          1e9};
  const std::size_t at = read<std::uint32_t>(bytes) % state.size();
  const std::uint8_t kind = bytes[4], which = bytes[5];
  const auto value = read<std::uint32_t>(bytes + 6);
  switch (kind % 6) {
    case 0:
      return write(static_cast<std::uint8_t>(value), at, state);
    case 1:
      return write(value, at & ~std::size_t{3}, state);
    case 2:
      return write(which % 2 ? 0xffffffffu : value % 64, at & ~std::size_t{3}, state);
    case 3:
      return write(kOdd[which % kOdd.size()], at & ~std::size_t{3}, state);
    case 4:
      return write(static_cast<float>(kOdd[which % kOdd.size()]), at & ~std::size_t{3}, state);
    default:
      state[at] ^= static_cast<std::byte>(1 << which % 8);
  }
}

void forge(std::span<const std::uint8_t> bytes) {
  if (bytes.empty() || bytes.size() > 1 + kMostChanges * kChangeBytes) return;
  const auto& states = fuzz::small_states();
  std::vector<std::byte> state = states[bytes[0] % states.size()];
  for (std::size_t at = 1; at + kChangeBytes <= bytes.size(); at += kChangeBytes)
    change(&bytes[at], state);
  fuzz::run_state(state, 3);
}

const fuzz::Registration state_target("state", forge);

}  // namespace
}  // namespace sunder
