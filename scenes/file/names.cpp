#include "scenes/file/names.h"

#include <string_view>

#include "engine/base/check.h"
#include "scenes/file/keys.h"

namespace sunder::scenes {

std::vector<std::uint32_t> roots_named(const Scene& scene, const std::string& name,
                                       const Value& value) {
  std::vector<std::uint32_t> roots;
  std::vector<std::string_view> names;
  const auto consider = [&](const std::string& candidate) {
    const auto dot = candidate.rfind('.');
    if (candidate == name || candidate.substr(0, dot) == name) {
      roots.push_back(static_cast<std::uint32_t>(names.size()));
    }
    names.push_back(candidate);
  };
  for (const Solid& solid : scene.solids) consider(solid.name);
  for (const Ball& ball : scene.balls) consider(ball.name);
  if (roots.empty()) {
    throw InputError(value.where + ": no solid or ball is named '" + name + "'" +
                     did_you_mean(name, names));
  }
  return roots;
}

bool is_anchored(const Scene& scene, std::uint32_t root) {
  return root < scene.solids.size() && scene.solids[root].compound.is_anchored();
}

}  // namespace sunder::scenes
