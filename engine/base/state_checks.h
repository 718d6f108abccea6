// Checks of indices and bounds of numbers, for the wrong_field() of classes in saved states
// (engine/base/archive.h). The bounds are far beyond what a run reaches, and such that squares of
// the numbers, and sums of those, fit their type.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <ranges>
#include <vector>

namespace sunder {

/// Greatest lengths and speeds of bodies, in m and m/s, and of shapes, in m.
inline constexpr double kMostPlace_m = 1e15, kMostSpeed_m_s = 1e9, kMostShape_m = 1e9;
/// Greatest coordinate of a box that meets what it overlaps only: an empty one is beyond.
inline constexpr float kMostBox_m = 1e25f;
inline constexpr double kMostMass_kg = 1e30, kMostCoefficient = 1e18, kMostStiffness_N_m = 1e60;
/// Greatest error of the square of a unit vector, and of a product of inverse matrices, in single
/// precision.
inline constexpr double kUnitError = 1e-2;

/// Returns true if a vector has unit length, in single precision.
template <class Vector>
bool is_unit(const Vector& vector) {
  const double error = static_cast<double>(vector.squaredNorm()) - 1;
  return -kUnitError < error && error < kUnitError;
}

/// Returns true if a number is from 0 to `most`; false if it is none.
template <class Number>
bool is_bounded(Number number, double most) {
  return number >= 0 && static_cast<double>(number) <= most;
}

/// Returns true if all coordinates of a vector are at most `most` in size.
template <class Vector>
bool is_within(const Vector& vector, double most) {
  return static_cast<double>(vector.cwiseAbs().maxCoeff()) <= most;
}

/// Returns true if all numbers, or all indices, are below `count`.
template <class Range, class Projection = std::identity>
bool all_below(const Range& numbers, std::size_t count, const Projection& of = {}) {
  return std::ranges::all_of(numbers, [&](const auto& element) {
    const auto& number = std::invoke(of, element);
    if constexpr (requires { number.value; }) {
      return number.value < count;
    } else {
      return number < count;
    }
  });
}

/// Returns true if all indices are below `count` or none().
template <class Range, class Projection = std::identity>
bool all_below_or_none(const Range& indices, std::size_t count, const Projection& of = {}) {
  return std::ranges::all_of(indices, [&](const auto& element) {
    const auto& index = std::invoke(of, element);
    return index.none() || index.value < count;
  });
}

/// Returns true if the numbers, or indices, are those below `count`, each at most once.
template <class Range>
bool are_different_below(const Range& numbers, std::size_t count) {
  if (std::ranges::size(numbers) > count || !all_below(numbers, count)) return false;
  std::vector<bool> seen(count);
  return std::ranges::all_of(numbers, [&](const auto& number) {
    std::size_t i = 0;
    if constexpr (requires { number.value; }) {
      i = number.value;
    } else {
      i = number;
    }
    const bool known = seen[i];
    seen[i] = true;
    return !known;
  });
}

/// Returns true if all containers have `size` elements.
template <class... Containers>
bool have_size(std::size_t size, const Containers&... containers) {
  return ((containers.size() == size) && ...);
}

}  // namespace sunder
