// State of the running world: read World. Internal to engine/world; users see Simulation and Frame.
//
// Each part keeps its own invariants; state of a single stage is in that stage.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

struct World {
  const Scene scene;  ///< As given.
  const std::shared_ptr<const std::vector<Material>> materials;
  /// Names of solids, balls, then shots.
  const std::shared_ptr<const std::vector<std::string>> names;
  const std::shared_ptr<const std::vector<Appearance>> appearances;  ///< Null if there are none.
  const std::unique_ptr<Physics> physics;
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

  World(Scene given, std::unique_ptr<Physics> moves)
      : scene(std::move(given)),
        materials(std::make_shared<const std::vector<Material>>(scene.materials)),
        names(std::make_shared<const std::vector<std::string>>(object_names(scene))),
        appearances(scene.appearances.empty()
                        ? nullptr
                        : std::make_shared<const std::vector<Appearance>>(scene.appearances)),
        physics(std::move(moves)),
        clock(scene.accuracy) {}

  const Material& material(MaterialIndex index) const { return (*materials)[index.value]; }
};

}  // namespace sunder
