// Text of files, with numbers in the shortest form that is exact.
#pragma once

#include <charconv>
#include <string>
#include <string_view>
#include <type_traits>

#include <Eigen/Core>

namespace sunder {

/// Appends words and numbers to a text. Numbers are written in the shortest form that reads back as
/// the same number; the numbers of a vector have the separator between them.
class TextWriter {
 public:
  explicit TextWriter(std::string_view separator = " ") : separator_(separator) {}

  TextWriter& operator<<(std::string_view words) {
    text.append(words);
    return *this;
  }
  template <class Number>
  requires std::is_arithmetic_v<Number> TextWriter& operator<<(Number number) {
    char digits[40];
    const auto end = std::to_chars(digits, digits + sizeof digits, number).ptr;
    return *this << std::string_view(digits, static_cast<std::size_t>(end - digits));
  }
  template <class Derived>
  TextWriter& operator<<(const Eigen::MatrixBase<Derived>& vector) {
    for (Eigen::Index i = 0; i < vector.size(); ++i) {
      *this << (i > 0 ? separator_ : std::string_view()) << vector(i);
    }
    return *this;
  }

  std::string text;

 private:
  std::string_view separator_;
};

}  // namespace sunder
