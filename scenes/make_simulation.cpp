#include "scenes/make_simulation.h"

#include <algorithm>
#include <limits>
#include <utility>

#include "engine/base/archive.h"
#include "engine/base/parallel.h"
#include "engine/io/sealed_bytes.h"
#include "engine/model/checks/scene_accuracy.h"
#include "engine/model/checks/scene_chains.h"
#include "engine/model/checks/scene_check.h"
#include "engine/model/checks/scene_posts.h"
#include "engine/world/simulation.h"
#include "fracture/pattern_breaker.h"
#include "scenes/features.h"
#include "scenes/file/planar.h"
#include "scenes/file/schema.h"
#include "solver/particles/debris_and_dust.h"
#include "solver/planar/planar_physics.h"
#include "solver/rigid/rigid_physics.h"

namespace sunder::scenes {
namespace {

/// Cells of the air grid for dust: enough for the largest scenes, few enough for a frame's time.
const Eigen::Vector3i kAirCells(40, 24, 40);

/// Returns a log that writes failed breaks to case files and warns of them when it is destroyed, at
/// the end of the run; null if both are off.
std::shared_ptr<fracture::FailureLog> failure_log(const Scene& scene,
                                                  const SimulationOptions& options) {
  if (options.cases_folder.empty() && !options.warn) return nullptr;
  const std::string folder = options.cases_folder.string();
  double volume_m3 = 0;
  for (const Solid& solid : scene.solids) volume_m3 += volume(solid.compound);
  const auto warn_and_delete = [folder, volume_m3, warn = options.warn](fracture::FailureLog* log) {
    if (log->failed() > 0 && warn) {
      std::string text = uncut_convexes_warning(log->failed(), log->failed_m3(), volume_m3);
      if (log->files() > 0) {
        text += "; " + std::to_string(log->files()) + " breaks are stored in " + folder +
                "/; repeat one by `sunder fracture X.case`";
      }
      warn(text);
    }
    delete log;
  };
  return {new fracture::FailureLog(folder), warn_and_delete};
}

/// Returns the planar solver for a planar scene, otherwise the solver in three dimensions.
std::unique_ptr<Physics> make_physics(const Scene& scene) {
  if (scene.planar) {
    solver::PlanarOptions planar;
    planar.gravity_W = scene.gravity_W;
    planar.piece_m = planar_piece_m(scene);
    planar.sleeping = scene.solver.sleeping;
    return solver::make_planar_physics(planar);
  }
  solver::RigidOptions rigid;
  rigid.gravity_W = scene.gravity_W;
  rigid.max_colors = scene.solver.max_colors;
  rigid.sweeps = scene.solver.sweeps;
  rigid.lanes = scene.solver.lanes;
  rigid.sleeping = scene.solver.sleeping;
  return solver::make_rigid_physics(rigid);
}

std::unique_ptr<Particles> make_particles(const Scene& scene) {
  if (scene.limits.debris + scene.limits.dust == 0) return nullptr;
  solver::DebrisAndDustOptions options;
  options.gravity_W = scene.gravity_W;
  options.seed = scene.seed;
  options.max_air_cells = kAirCells;
  options.limits = {scene.limits.debris, scene.limits.dust};
  return solver::make_debris_and_dust(options);
}

/// Returns a warning of solids under the ground plane, or of an empty scene; empty if neither.
std::string placement_warning(const Scene& scene) {
  if (scene.solids.empty() && scene.balls.empty() && scene.shots.empty())
    return "the scene is empty: it has no [[solid]], [[body]], [[ball]] or [[script.shot]]";
  if (!scene.ground.meshes.empty()) return "";
  std::size_t under = 0;
  std::string first;
  for (std::size_t i = 0; i < scene.solids.size(); ++i) {
    const Solid& solid = scene.solids[i];
    double top_m = -std::numeric_limits<double>::infinity();
    for (const ConvexPtr& convex : solid.compound.convexes) {
      for (const Vec3& vertex : convex->polyhedron.vertices)
        top_m = std::max(top_m, (solid.X_WR * vertex).y());
    }
    if (top_m >= scene.ground.height_m || solid.compound.is_anchored()) continue;
    if (++under == 1) first = name_or_index(solid.name, "solid", i);
  }
  if (under == 0) return "";
  return "'" + first + "'" + (under > 1 ? " and " + std::to_string(under - 1) + " more" : "") +
         (under > 1 ? " are" : " is") + " below the ground; raise position";
}

/// Returns a warning that names the materials with obsolete keys; empty if there are none.
std::string obsolete_warning(const Scene& scene) {
  std::string names;
  for (const Material& material : scene.materials) {
    if (material.strength_Ns || material.smallest_break_m3)
      names += (names.empty() ? "'" : ", '") + material.name + "'";
  }
  if (names.empty()) return "";
  return "strength_Ns and smallest_break_m3 of " + names +
         " are obsolete; remove them, as tensile_Pa, compressive_Pa, youngs_Pa and "
         "smallest_piece_m3 determine what breaks";
}

/// Leaves out debris below `factor` times its smallest radius, of particles whose radii r follow
/// N(> r) ~ r^-2.
void leave_out_small_debris(double factor, DebrisEmission& emission) {
  const double smallest_m = factor * emission.debris_smallest_m;
  const double kept = smallest_m < emission.debris_largest_m ? 1 / (factor * factor) : 0;
  const double debris = kept * emission.debris_ratio, dust = 1 - emission.debris_ratio;
  emission.particles_per_m2 *= debris + dust;
  emission.debris_ratio = debris + dust > 0 ? debris / (debris + dust) : 0;
  emission.debris_smallest_m = std::min(smallest_m, emission.debris_largest_m);
}

/// Applies the factors on sizes of pieces and of debris to the materials.
void coarsen(Scene& scene) {
  const double piece = scene.limits.piece_size_factor, chip = scene.limits.chip_size_factor;
  for (Material& material : scene.materials) {
    material.smallest_piece_m3 *= piece * piece * piece;
    if (chip > 1) leave_out_small_debris(chip, material.crumbling);
  }
}

std::vector<std::string> warnings_of(const Scene& scene) {
  std::vector<std::string> warnings = chain_warnings(scene, kMaxSubsteps);
  const std::string accuracy = accuracy_warning(scene, kMaxSubsteps);
  for (const std::string& warning :
       {accuracy.empty() ? crush_warning(scene, kMaxSubsteps) : accuracy, post_warning(scene),
        long_step_warning(scene), far_warning(scene), placement_warning(scene),
        obsolete_warning(scene)}) {
    if (!warning.empty()) warnings.push_back(warning);
  }
  warnings.insert(warnings.end(), scene.warnings.begin(), scene.warnings.end());
  return warnings;
}

}  // namespace

World make_world(Scene scene, const SimulationOptions& options) {
  if (options.threads < 0)
    throw InputError("options.threads is " + std::to_string(options.threads) +
                     "; expected a number of threads, or 0 to leave it unchanged");
  const ThreadScope scope(options.threads);
  check_scene(scene);
  coarsen(scene);
  const std::string name = scene.name.empty() ? "the scene" : scene.name;
  if (scene.planar) check_planar(scene, name);
  if (options.warn) {
    for (const std::string& warning : warnings_of(scene)) options.warn(name + ": " + warning);
  }
  std::unique_ptr<Particles> particles = make_particles(scene);
  std::unique_ptr<Physics> physics = make_physics(scene);
  auto breaker = fracture::make_pattern_breaker(failure_log(scene, options));
  World world(std::move(scene), std::move(physics), std::move(breaker), std::move(particles));
  world.set_threads(options.threads);
  if (options.inspect) world.inspect();
  if (options.count_loops) world.count_loops();
  return world;
}

std::vector<std::byte> save_world(const World& world, const RunSoFar& so_far) {
  Archive bytes;
  world.save(bytes);
  RunSoFar copy = so_far;
  bytes(copy);
  return seal(bytes.take());
}

namespace {

/// Restores a world from what was sealed, and sets `so_far`, if it is given.
World restore(std::span<const std::byte> state, const SimulationOptions& options,
              RunSoFar* so_far) {
  Archive archive(state);
  Scene scene;
  archive(scene);
  check_scene(scene);
  std::unique_ptr<Particles> particles = make_particles(scene);
  std::unique_ptr<Physics> physics = make_physics(scene);
  const std::shared_ptr<fracture::FailureLog> log = failure_log(scene, options);
  auto breaker = fracture::make_pattern_breaker(log);
  World world(archive, std::move(scene), std::move(physics), std::move(breaker),
              std::move(particles));
  RunSoFar saved;
  archive(saved);
  archive.finish();
  if (log) log->count(saved.failed, saved.failed_m3);
  if (so_far) *so_far = std::move(saved);
  world.set_threads(options.threads);
  if (options.inspect) world.inspect();
  if (options.count_loops) world.count_loops();
  return world;
}

}  // namespace

World restore_world(std::span<const std::byte> bytes, const SimulationOptions& options,
                    const std::string& name, RunSoFar* so_far) {
  const std::vector<std::byte> state = unseal(bytes, name);
  try {
    return restore(state, options, so_far);
  } catch (const InputError& error) {
    throw InputError(name + ": " + error.what());
  }
}

std::unique_ptr<FrameSource> make_simulation(Scene scene, const SimulationOptions& options) {
  return std::make_unique<Simulation>(make_world(std::move(scene), options));
}

RunInfo run_info(const Scene& scene, const std::string& preset) {
  check_scene(scene);
  RunInfo info{scene.name,
               preset,
               threads(),
               scene.accuracy,
               {},
               {scene.solver.max_colors, scene.solver.sweeps,
                solver::lanes_in_use(scene.solver.lanes), scene.solver.sleeping},
               warnings_of(scene)};
  for (const Feature& feature : features()) info.modelled[feature.name] = feature.state(scene);
  return info;
}

}  // namespace sunder::scenes
