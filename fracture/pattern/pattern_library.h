// A cache of patterns.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <tuple>

#include "fracture/pattern/pattern.h"

namespace sunder::fracture {

/// Makes patterns and keeps them; may be called from any thread.
class PatternLibrary {
 public:
  /// Number of variants per pattern; the seed selects one.
  static constexpr std::uint64_t kVariants = 8;

  /// Returns make_pattern() for the seed modulo kVariants.
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
