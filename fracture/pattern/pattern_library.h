// Patterns made once and kept.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>

#include "fracture/pattern/pattern.h"

namespace sunder::fracture {

/// Hands out patterns; any thread may ask.
class PatternLibrary {
 public:
  /// Variants of a pattern that are kept; the seed chooses among them.
  static constexpr std::uint64_t kVariants = 8;

  /// As make_pattern() makes it; the seed counts modulo kVariants.
  std::shared_ptr<const Pattern> find(const PatternSpec& spec, const PatternScale& scale,
                                      std::uint64_t seed);

 private:
  using Key = std::tuple<PatternSpec::Kind, int, double, int, int, double, std::array<double, 3>,
                         std::string, int, bool, std::uint64_t>;
  static constexpr std::size_t kMostPatterns = 256;

  std::mutex mutex_;
  std::map<Key, std::shared_ptr<const Pattern>> patterns_;
};

}  // namespace sunder::fracture
