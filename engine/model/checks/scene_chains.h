// What hangs in joints, and the substeps that its pull asks for.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/model/scene.h"

namespace sunder {

/// The link of a chain that asks for the shortest substep.
struct ChainLink {
  std::string name;
  double load = 0;   ///< What hangs on it, itself included, in its own weights.
  int substeps = 1;  ///< Of the scene's `dt_s`, to follow its pull: docs/decisions/026.
};

/// One for each wrecking ball with links, and for each thing that is joined to what cannot move and
/// has something hanging from it; in their order.
std::vector<ChainLink> chains_in(const Scene& scene);

/// What a user, who may ask for so many substeps, should know of each chain that would tear.
std::vector<std::string> chain_warnings(const Scene& scene, int most_substeps);

}  // namespace sunder
