#include "fracture/pattern_library.h"

namespace sunder::fracture {

std::shared_ptr<const Pattern> PatternLibrary::find(const PatternSpec& spec, double radius_m,
                                                    std::uint64_t seed) {
  const std::uint64_t variant = seed % kVariants;
  const Key key{spec.kind, spec.cells, spec.falloff, spec.rings, spec.spokes, spec.jitter, variant};
  {
    const std::lock_guard lock(mutex_);
    if (const auto it = patterns_.find(key); it != patterns_.end()) return it->second;
  }
  auto pattern = std::make_shared<const Pattern>(make_pattern(spec, radius_m, variant));
  const std::lock_guard lock(mutex_);
  if (patterns_.size() >= kMostPatterns) patterns_.clear();
  return patterns_.emplace(key, std::move(pattern)).first->second;
}

}  // namespace sunder::fracture
