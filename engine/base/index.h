// Strong indices, so that an index into one array cannot be used in another, and ids that notice
// when what they named is gone.
#pragma once

#include <compare>
#include <cstdint>
#include <limits>

namespace sunder {

/// An index into one kind of array; `Tag` tells which. Default-constructed: `none()`.
template <class Tag>
struct Index {
  static constexpr std::uint32_t kNone = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t value = kNone;

  constexpr Index() = default;
  constexpr explicit Index(std::size_t v) : value(static_cast<std::uint32_t>(v)) {}
  constexpr bool none() const { return value == kNone; }
  constexpr auto operator<=>(const Index&) const = default;
};

/// A slot and the generation it had when the id was handed out: stale ids compare unequal.
template <class Tag>
struct Id {
  std::uint32_t slot = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t generation = 0;

  constexpr bool none() const { return slot == std::numeric_limits<std::uint32_t>::max(); }
  constexpr auto operator<=>(const Id&) const = default;
};

}  // namespace sunder
