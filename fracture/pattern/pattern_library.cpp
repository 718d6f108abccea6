#include "fracture/pattern/pattern_library.h"

namespace sunder::fracture {

std::shared_ptr<const Pattern> PatternLibrary::find(const PatternSpec& spec,
                                                    const PatternScale& scale, std::uint64_t seed) {
  const std::uint64_t variant = seed % kVariants;
  const bool is_brick = spec.kind == PatternSpec::Kind::kBrick;
  const Vec3 size = is_brick ? Vec3(spec.brick_m / scale.unit_m) : Vec3::Zero();
  const Key key{spec.kind,
                spec.cells,
                spec.falloff,
                spec.rings,
                spec.spokes,
                spec.jitter,
                {size.x(), size.y(), size.z()},
                spec.file,
                spec.colors,
                scale.whole,
                variant};
  {
    const std::lock_guard lock(mutex_);
    if (const auto it = patterns_.find(key); it != patterns_.end()) return it->second;
  }
  auto pattern = std::make_shared<const Pattern>(make_pattern(spec, scale, variant));
  const std::lock_guard lock(mutex_);
  if (patterns_.size() >= kMostPatterns) patterns_.clear();
  return patterns_.emplace(key, std::move(pattern)).first->second;
}

}  // namespace sunder::fracture
