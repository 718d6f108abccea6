// The features that a run models, such as fracture, dust and sleeping, and their state in a scene.
#pragma once

#include <span>
#include <string>

#include "engine/model/scene.h"

namespace sunder::scenes {

struct Feature {
  const char* name;
  /// Returns "on", "off", or "off: REASON", where the reason is found in the scene.
  std::string (*state)(const Scene& scene);
  /// Turns the feature off in a scene in which it is on; null if that is not possible.
  void (*turn_off)(Scene& scene);
};

/// Returns all features, in the order in which they are shown.
std::span<const Feature> features();
/// Returns the feature of this name; null if there is none.
const Feature* find_feature(const std::string& name);

}  // namespace sunder::scenes
