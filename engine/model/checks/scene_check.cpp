// Begin with check_scene(), at the end.
#include "engine/model/checks/scene_check.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "engine/base/roots.h"
#include "engine/model/checks/item_check.h"

namespace sunder {
namespace {

class SceneCheck : private ItemCheck {
 public:
  explicit SceneCheck(const Scene& scene) : ItemCheck("scene.", scene.materials), scene_(scene) {}

  void run() const {
    check_run();
    for (std::size_t i = 0; i < scene_.materials.size(); ++i)
      material(scene_.materials[i], item("materials", i));
    for (std::size_t i = 0; i < scene_.solids.size(); ++i)
      solid(scene_.solids[i], item("solids", i));
    check_piece_size();
    for (std::size_t i = 0; i < scene_.balls.size(); ++i) ball(scene_.balls[i], item("balls", i));
    for (std::size_t i = 0; i < scene_.ground.meshes.size(); ++i) check_ground_mesh(i);
    for (std::size_t i = 0; i < scene_.joints.size(); ++i) check_joint(i);
    check_script();
  }

 private:
  void check_run() const {
    need_number(scene_.duration_s, 0, kMaxTime_s, "duration_s");
    need_vector(scene_.gravity_W, ranges::kGravity_m_s2, "gravity_W");
    const Accuracy& accuracy = scene_.accuracy;
    need_number(accuracy.dt_s, ranges::kStep_s, "accuracy.dt_s");
    need_number(accuracy.substeps, ranges::kSubsteps, "accuracy.substeps");
    const double steps = 1.0 / 60 / accuracy.dt_s;
    if (steps > 1 && std::abs(steps - std::round(steps)) > 1e-6 * steps)
      refuse("accuracy.dt_s is " + number_text(accuracy.dt_s),
             "a frame of 1/60 s divided by a whole number, such as 1/120");
    need_number(accuracy.error_target_m, ranges::kErrorTarget_m, "accuracy.error_target_m");
    need_number(scene_.solver.sweeps, ranges::kSweeps, "solver.sweeps");
    need_number(scene_.solver.max_colors, ranges::kMaxColors, "solver.max_colors");
    need_number(scene_.solver.lanes, ranges::kLanes, "solver.lanes");
    check_limits();
    need_number(scene_.ground.height_m, ranges::kPlace_m, "ground.height_m");
    need_number(scene_.ground.friction, ranges::kFriction, "ground.friction");
    need_number(scene_.ground.restitution, ranges::kFraction, "ground.restitution");
  }

  void check_limits() const {
    const Limits& limits = scene_.limits;
    const std::tuple<double, Range, const char*> numbers[] = {
        {limits.bodies, ranges::kBodies, "bodies"},
        {limits.ageing, ranges::kAgeing, "ageing"},
        {limits.parts_a_frame, ranges::kPartsAFrame, "parts_a_frame"},
        {limits.load_work_a_frame, ranges::kWork, "load_work_a_frame"},
        {limits.debris, ranges::kDebris, "debris"},
        {limits.dust, ranges::kDust, "dust"},
        {limits.impact_bonds, ranges::kImpactBonds, "impact_bonds"},
        {limits.impact_evaluations, ranges::kWork, "impact_evaluations"},
        {limits.loaded_convexes, ranges::kLoadedConvexes, "loaded_convexes"},
        {limits.cluster_bodies, ranges::kClusterBodies, "cluster_bodies"},
        {limits.probe_events, ranges::kProbeEvents, "probe_events"},
        {limits.break_rounds, ranges::kBreakRounds, "break_rounds"},
        {limits.full_detail, ranges::kFullDetail, "full_detail"},
        {limits.piece_size_factor, ranges::kPieceSizeFactor, "piece_size_factor"},
        {limits.chip_size_factor, ranges::kChipSizeFactor, "chip_size_factor"}};
    for (const auto& [number, range, key] : numbers)
      need_number(number, range, std::string("limits.") + key);
  }

  /// Refuses a factor with which all pieces of the largest solid would be debris.
  void check_piece_size() const {
    double most = 0;  // size of the largest solid, in smallest pieces of its material
    for (const Solid& solid : scene_.solids) {
      const Material& material = scene_.materials[solid.compound.convexes[0]->material.value];
      if (!material.breakable() && !material.breaks_by_load()) continue;
      most = std::max(most, cube_root(volume(solid.compound) / material.smallest_piece_m3));
    }
    const double factor = scene_.limits.piece_size_factor;
    if (factor > 1 && most > 0 && factor > most)
      refuse("limits.piece_size_factor is " + number_text(factor) +
                 ", so that all pieces of the largest solid would be debris",
             "at most " + number_text(std::max(1.0, most)));
  }

  void check_ground_mesh(std::size_t i) const {
    const GroundMesh& mesh = scene_.ground.meshes[i];
    const std::string name = item("ground.meshes", i);
    material_index(mesh.material, name);
    for (const Vec3& vertex : mesh.vertices_W)
      need_vector(vertex, ranges::kPlace_m, name + ".vertices_W");
    for (const auto& triangle : mesh.triangles) {
      if (std::ranges::max(triangle) >= mesh.vertices_W.size())
        refuse(name + " has a triangle with vertex " + std::to_string(std::ranges::max(triangle)),
               "an index below " + std::to_string(mesh.vertices_W.size()));
    }
  }

  std::size_t bodies() const { return scene_.solids.size() + scene_.balls.size(); }

  void check_joint(std::size_t i) const {
    const std::string name = item("joints", i);
    joint(scene_.joints[i], name);
    for (const std::optional<std::uint32_t>& end : {scene_.joints[i].a, scene_.joints[i].b}) {
      if (end && *end >= bodies())
        refuse(name + " has body " + std::to_string(*end),
               "one of the " + std::to_string(bodies()) + " solids and balls");
    }
  }

  void need_roots(const std::vector<std::uint32_t>& roots, std::size_t count,
                  const std::string& name) const {
    if (!std::ranges::is_sorted(roots))
      refuse(name + ".roots are not in ascending order", "ascending indices");
    if (!roots.empty() && roots.back() >= count)
      refuse(name + ".roots has index " + std::to_string(roots.back()),
             "one of the " + std::to_string(count) + " bodies");
  }

  /// Returns true if the box contains the centroid of an anchored convex of a solid.
  bool has_anchors(const Box& box_W) const {
    return std::ranges::any_of(scene_.solids, [&](const Solid& solid) {
      for (std::size_t c = 0; c < solid.compound.convexes.size(); ++c) {
        const Vec3 at_W = solid.X_WR * solid.compound.convexes[c]->solid.centroid;
        if (solid.compound.anchored[c] != 0 && (at_W.array() >= box_W.min.array()).all() &&
            (at_W.array() <= box_W.max.array()).all())
          return true;
      }
      return false;
    });
  }

  template <class Act>
  void need_times(const std::vector<Act>& acts, const char* list) const {
    for (std::size_t i = 0; i < acts.size(); ++i) {
      need_number(acts[i].time_s, ranges::kTime_s, item(list, i) + ".time_s");
      if (i > 0 && acts[i].time_s < acts[i - 1].time_s)
        refuse(item(list, i) + " comes before " + item(list, i - 1), "events in order of time");
    }
  }

  void check_script() const {
    need_times(scene_.shots, "shots");
    need_times(scene_.blasts, "blasts");
    need_times(scene_.removals, "removals");
    need_times(scene_.drives, "drives");
    for (std::size_t i = 0; i < scene_.shots.size(); ++i) shot(scene_.shots[i], item("shots", i));
    for (std::size_t i = 0; i < scene_.blasts.size(); ++i)
      blast(scene_.blasts[i], item("blasts", i));
    for (std::size_t i = 0; i < scene_.removals.size(); ++i) {
      const Removal& removal = scene_.removals[i];
      need_roots(removal.roots, bodies(), item("removals", i));
      if (removal.roots.empty() && !has_anchors(removal.anchors_W))
        refuse(item("removals", i) +
                   " removes nothing: roots is empty, and no anchored convex is in anchors_W",
               "roots, or a box with anchored convexes");
    }
    for (std::size_t i = 0; i < scene_.drives.size(); ++i)
      check_drive(scene_.drives[i], item("drives", i));
    for (std::size_t i = 0; i < scene_.moves.size(); ++i)
      check_move(scene_.moves[i], item("moves", i));
  }

  void check_drive(const Drive& one, const std::string& name) const {
    need_roots(one.roots, bodies(), name);
    drive(one, name);
  }

  void check_move(const Move& move, const std::string& name) const {
    for (const std::uint32_t root : move.roots) need_roots({root}, scene_.solids.size(), name);
    if (std::isnan(move.release_s)) refuse(name + ".release_s is not a number", "a time");
    need_vector(move.pivot_W.value_or(Vec3::Zero()), ranges::kPlace_m, name + ".pivot_W");
    double last_s = 0;
    for (const PathKey& key : move.path.keys) {
      if (!(key.time_s > last_s && key.time_s <= kMaxTime_s))
        refuse(name + ".path has a key at " + number_text(key.time_s) + " s",
               "times that ascend from 0");
      last_s = key.time_s;
      need_vector(key.shift_W, ranges::kPlace_m, name + ".path, shift_W");
      need_finite(key.rotation_W, name + ".path, rotation_W");
    }
  }

  const Scene& scene_;
};

}  // namespace

void check_scene(const Scene& scene) { SceneCheck(scene).run(); }

}  // namespace sunder
