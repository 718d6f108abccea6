// State of the running world: read WorldState. Internal to engine/world; users see Simulation and
// Frame.
//
// Each part keeps its own invariants; state of a single stage is in that stage.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/copied_ptr.h"
#include "engine/model/material.h"
#include "engine/model/physics.h"
#include "engine/model/scene.h"
#include "engine/world/actors/actors.h"
#include "engine/world/actors/clock.h"
#include "engine/world/actors/exposed.h"
#include "engine/world/actors/joints.h"
#include "engine/world/actors/landscape.h"
#include "engine/world/actors/meshes.h"
#include "engine/world/actors/run_log.h"

namespace sunder {

struct WorldState {
  const std::shared_ptr<const Scene> given;  ///< Shared with copies.
  const Scene& scene = *given;               ///< As given.
  std::shared_ptr<const std::vector<Material>> materials;
  /// Names of the scene's solids, balls and shots, then others. Copied before it changes, as
  /// frames share it.
  std::shared_ptr<const std::vector<std::string>> names;
  const std::shared_ptr<const std::vector<Appearance>> appearances;  ///< Null if there are none.
  const CopiedPtr<Physics> physics;
  Clock clock;
  Actors actors;
  Joints joints;
  Meshes meshes;
  Landscape landscape;
  RunLog log;
  std::uint64_t next_event =
      1;  ///< Number of the next event, which names the planes that it makes.
  /// Factor on Material::smallest_piece_m3 in this step, by Limits::full_detail.
  double smallest_piece_factor = 1;
  std::optional<Exposed> exposed;  ///< None in a run without particles.

  WorldState(Scene as_given, std::unique_ptr<Physics> moves)
      : given(std::make_shared<const Scene>(std::move(as_given))),
        materials(std::make_shared<const std::vector<Material>>(scene.materials)),
        names(std::make_shared<const std::vector<std::string>>(object_names(scene))),
        appearances(scene.appearances.empty()
                        ? nullptr
                        : std::make_shared<const std::vector<Appearance>>(scene.appearances)),
        physics(std::move(moves)),
        clock(scene.accuracy) {}

  const Material& material(MaterialIndex index) const { return (*materials)[index.value]; }
  MaterialIndex add_material(const Material& material) {
    auto more = std::make_shared<std::vector<Material>>(*materials);
    more->push_back(material);
    materials = std::move(more);
    return MaterialIndex(materials->size() - 1);
  }
  /// Returns the index of a name, which is added if it is new; kNoName for an empty one.
  std::uint32_t add_name(const std::string& name) {
    if (name.empty()) return kNoName;
    const auto known = std::ranges::find(*names, name);
    const auto index = static_cast<std::uint32_t>(known - names->begin());
    if (known != names->end()) return index;
    auto more = std::make_shared<std::vector<std::string>>(*names);
    more->push_back(name);
    names = std::move(more);
    return index;
  }
};

}  // namespace sunder
