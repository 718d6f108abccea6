// What a run models, feature by feature, as far as the scene says.
#pragma once

#include <span>
#include <string>

#include "engine/model/scene.h"

namespace sunder::scenes {

struct Feature {
  const char* name;
  /// "on", "off", or "off: why", the reason being in the scene.
  std::string (*state)(const Scene& scene);
  /// Changes a scene in which it is on so that it is off; null: no scene goes without it.
  void (*turn_off)(Scene& scene);
};

/// All of them, in the order in which they are shown.
std::span<const Feature> features();
/// The one of this name; null if there is none.
const Feature* find_feature(const std::string& name);

}  // namespace sunder::scenes
