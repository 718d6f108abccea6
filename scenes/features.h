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
  /// Changes a scene in which the feature is on so that it is off; null: the feature cannot be
  /// turned off.
  void (*turn_off)(Scene& scene);
};

/// Returns all features, in the order in which they are shown.
std::span<const Feature> features();
/// Returns the feature of this name; null if there is none.
const Feature* find_feature(const std::string& name);

}  // namespace sunder::scenes
