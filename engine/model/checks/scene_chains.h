// Estimates of the substeps that hanging chains of a scene need.
#pragma once

#include <string>
#include <vector>

#include "engine/model/scene.h"

namespace sunder {

/// The link of a chain that needs the shortest substep.
struct ChainLink {
  std::string name;
  double load = 0;  ///< Mass that hangs on the link, itself included, over its own mass.
  /// Substeps of the scene's `dt_s` that the joint needs under its tension (docs/decisions/026).
  int substeps = 1;
};

/// Returns one link for each wrecking ball with links, and for each body that is jointed to a
/// static one and has something hanging from it; in their order.
std::vector<ChainLink> find_chains(const Scene& scene);

/// Returns a warning about each chain that would tear, with a remedy of at most `max_substeps`
/// substeps per step.
std::vector<std::string> chain_warnings(const Scene& scene, int max_substeps);

}  // namespace sunder
