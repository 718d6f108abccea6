#include "scenes/file/names.h"

#include <string_view>

#include "engine/base/check.h"
#include "scenes/file/keys.h"

namespace sunder::scenes {

void Names::reserve(const std::string& name, const std::string& where) {
  const auto [other, is_new] = where_.emplace(name, where);
  if (is_new) return;
  throw InputError(where + ": two things are named '" + name + "', the other at " + other->second +
                   "; give each a name of its own");
}

std::string Names::reserve_default(const std::string& default_name, const std::string& where) {
  std::string name = default_name;
  for (int i = 2; !where_.emplace(name, where).second; ++i) {
    if (i == 2) ambiguous_.emplace(default_name, where);
    name = default_name + " " + std::to_string(i);
  }
  return name;
}

void Names::check_reference(const Value& value) const {
  const std::string* name = std::get_if<std::string>(&value.data);
  const auto other = name ? ambiguous_.find(*name) : ambiguous_.end();
  if (other == ambiguous_.end()) return;
  throw InputError(value.where + ": '" + *name + "' may be the one at " + where_.at(*name) +
                   " or the one at " + other->second + "; give them names of their own");
}

std::vector<std::uint32_t> roots_named(const Scene& scene, const std::string& name,
                                       const Value& value) {
  std::vector<std::uint32_t> roots;
  std::vector<std::string_view> names;
  const auto add_if_named = [&](const std::string& candidate) {
    const auto dot = candidate.rfind('.');
    if (candidate == name || candidate.substr(0, dot) == name) {
      roots.push_back(static_cast<std::uint32_t>(names.size()));
    }
    names.push_back(candidate);
  };
  for (const Solid& solid : scene.solids) add_if_named(solid.name);
  for (const Ball& ball : scene.balls) add_if_named(ball.name);
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
