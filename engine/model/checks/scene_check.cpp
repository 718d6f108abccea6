// Begin with check_scene(), at the end.
#include "engine/model/checks/scene_check.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include "engine/base/check.h"

namespace sunder {
namespace {

[[noreturn]] void refuse(const std::string& what, const std::string& expected) {
  throw InputError("scene." + what + "; expected " + expected);
}

std::string text_of(double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}

void need_number(double number, double low, double high, const std::string& name) {
  if (number >= low && number <= high) return;
  refuse(name + " is " + text_of(number), "a number from " + text_of(low) + " to " + text_of(high));
}

void need_finite(const Vec3& vector, const std::string& name) {
  if (!vector.allFinite()) refuse(name + " is not finite", "three finite numbers");
}

std::string item(const char* list, std::size_t i) {
  return std::string(list) + "[" + std::to_string(i) + "]";
}

// Largest length, coefficient or other number, and largest time, that a scene may have.
constexpr double kMaxNumber = 1e9, kMaxTime_s = 1e7;
constexpr double kInfinity = std::numeric_limits<double>::infinity();

class SceneCheck {
 public:
  explicit SceneCheck(const Scene& scene) : scene_(scene) {}

  void run() const {
    check_run();
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) check_material(i);
    for (std::size_t i = 0; i < scene_.solids.size(); ++i)
      check_solid(scene_.solids[i], item("solids", i));
    check_piece_size();
    for (std::size_t i = 0; i < scene_.balls.size(); ++i)
      check_ball(scene_.balls[i], item("balls", i));
    for (std::size_t i = 0; i < scene_.ground.meshes.size(); ++i) check_ground_mesh(i);
    for (std::size_t i = 0; i < scene_.joints.size(); ++i) check_joint(i);
    check_script();
  }

 private:
  void check_run() const {
    need_number(scene_.duration_s, 0, kMaxTime_s, "duration_s");
    need_finite(scene_.gravity_W, "gravity_W");
    const Accuracy& accuracy = scene_.accuracy;
    need_number(accuracy.dt_s, 1e-6, 1, "accuracy.dt_s");
    need_number(accuracy.substeps, 1, 1000, "accuracy.substeps");
    const double steps = 1.0 / 60 / accuracy.dt_s;
    if (steps > 1 && std::abs(steps - std::round(steps)) > 1e-6 * steps)
      refuse("accuracy.dt_s is " + text_of(accuracy.dt_s),
             "a frame of 1/60 s divided by a whole number, such as 1/120");
    need_number(accuracy.error_target_m, 0, kMaxNumber, "accuracy.error_target_m");
    need_number(scene_.solver.sweeps, 1, 1000, "solver.sweeps");
    need_number(scene_.solver.max_colors, 0, 64, "solver.max_colors");
    need_number(scene_.limits.bodies, 1, 1e9, "limits.bodies");
    need_number(scene_.limits.piece_size_factor, 0, kMaxNumber, "limits.piece_size_factor");
    need_number(scene_.limits.chip_size_factor, 1, kMaxNumber, "limits.chip_size_factor");
    need_number(scene_.ground.height_m, -kMaxNumber, kMaxNumber, "ground.height_m");
    need_number(scene_.ground.friction, 0, kMaxNumber, "ground.friction");
    need_number(scene_.ground.restitution, 0, 1, "ground.restitution");
  }

  void check_material(std::size_t i) const {
    const Material& material = scene_.materials[i];
    const std::string name = item("materials", i) + ".";
    need_number(material.density_kg_m3, 1e-6, 1e9, name + "density_kg_m3");
    need_number(material.friction, 0, kMaxNumber, name + "friction");
    need_number(material.restitution, 0, 1, name + "restitution");
    need_number(material.rolling, 0, kMaxNumber, name + "rolling");
    need_number(material.youngs_Pa, 1, 1e15, name + "youngs_Pa");
    const std::pair<double, const char*> sizes[] = {
        {material.strength_Ns.value_or(0), "strength_Ns"},
        {material.toughness_J_m2, "toughness_J_m2"},
        {material.impact_radius_m, "impact_radius_m"},
        {material.tensile_Pa, "tensile_Pa"},
        {material.shear_Pa, "shear_Pa"},
        {material.compressive_Pa, "compressive_Pa"},
        {material.yield_Pa, "yield_Pa"},
        {material.smallest_break_m3.value_or(0), "smallest_break_m3"},
        {material.smallest_piece_m3, "smallest_piece_m3"}};
    for (const auto& [size, member] : sizes) need_number(size, 0, kInfinity, name + member);
    need_number(material.reinforcement_percent, 0, 100, name + "reinforcement_percent");
    need_number(material.hardening_Pa, 0, kInfinity, name + "hardening_Pa");
    need_number(material.elongation, 0, kInfinity, name + "elongation");
    check_pattern(material.pattern, name + "pattern.");
    for (std::size_t k = 0; k < material.stronger.size(); ++k) {
      const ImpactResponse& stronger = material.stronger[k];
      const std::string of = name + item("stronger", k) + ".";
      need_number(stronger.energy_J, k > 0 ? material.stronger[k - 1].energy_J : 0, kInfinity,
                  of + "energy_J");
      need_number(stronger.impact_radius_m, 0, kInfinity, of + "impact_radius_m");
      check_pattern(stronger.pattern, of + "pattern.");
    }
    const DebrisEmission& crumbling = material.crumbling;
    need_number(crumbling.particles_per_m2, 0, kMaxNumber, name + "crumbling.particles_per_m2");
    need_number(crumbling.debris_ratio, 0, 1, name + "crumbling.debris_ratio");
    need_number(crumbling.debris_smallest_m, 1e-6, kMaxNumber,
                name + "crumbling.debris_smallest_m");
    need_number(crumbling.debris_largest_m, crumbling.debris_smallest_m, kMaxNumber,
                name + "crumbling.debris_largest_m");
    need_number(crumbling.dust_kg_m2, 0, kMaxNumber, name + "crumbling.dust_kg_m2");
    need_number(crumbling.dust_settling_m_s, 0, kMaxNumber, name + "crumbling.dust_settling_m_s");
  }

  void check_pattern(const PatternSpec& pattern, const std::string& name) const {
    constexpr int kMaxCells = 100000;
    need_number(pattern.cells, 1, kMaxCells, name + "cells");
    need_number(pattern.rings, 1, kMaxCells, name + "rings");
    need_number(pattern.spokes, 1, kMaxCells, name + "spokes");
    need_number(pattern.colors, 0, kMaxCells, name + "colors");
    need_number(pattern.falloff, 0, kMaxNumber, name + "falloff");
    need_number(pattern.jitter, 0, 1, name + "jitter");
    if (pattern.kind == PatternSpec::Kind::kFile && pattern.file.empty())
      refuse(name + "file is empty", "the name of a file");
    if (pattern.kind != PatternSpec::Kind::kBrick) return;
    for (const double side_m : pattern.brick_m)
      need_number(side_m, 1e-6, kMaxNumber, name + "brick_m");
  }

  void need_material(MaterialIndex index, const std::string& name) const {
    if (index.value < scene_.materials.size()) return;
    refuse(
        name + (index.none() ? " has no material" : " has material " + std::to_string(index.value)),
        scene_.materials.empty()
            ? "a material in scene.materials, which is empty"
            : "one of the " + std::to_string(scene_.materials.size()) + " in scene.materials");
  }

  void check_solid(const Solid& solid, const std::string& name) const {
    const Compound& compound = solid.compound;
    const std::size_t count = compound.convexes.size();
    if (count == 0) refuse(name + ".compound has no convexes", "at least one");
    if (compound.anchored.size() != count)
      refuse(
          name + ".compound.anchored has " + std::to_string(compound.anchored.size()) + " elements",
          "one for each convex, " + std::to_string(count));
    for (const ConvexPtr& convex : compound.convexes) {
      if (!convex) refuse(name + ".compound has a null convex", "no null pointers");
      if (!(convex->solid.volume_m3 > 0))
        refuse(name + ".compound has a convex without volume", "a volume above 0");
      need_material(convex->material, name);
    }
    for (const Bond& bond : compound.bonds) {
      if (bond.a >= count || bond.b >= count)
        refuse(
            name + ".compound has a bond with convex " + std::to_string(std::max(bond.a, bond.b)),
            "an index below " + std::to_string(count));
      if (bond.face_a >= compound.convexes[bond.a]->polyhedron.faces.size() ||
          bond.face_b >= compound.convexes[bond.b]->polyhedron.faces.size())
        refuse(name + ".compound has a bond with a face that does not exist",
               "faces of the convexes; make_compound() finds bonds");
    }
    for (const Ghost& ghost : compound.ghosts) {
      if (!ghost.convex) refuse(name + ".compound has a ghost without a convex", "a convex");
      for (const std::uint32_t of : ghost.of) {
        if (of >= count)
          refuse(name + ".compound has a ghost with convex " + std::to_string(of),
                 "an index below " + std::to_string(count));
      }
    }
    need_finite(solid.X_WR.position, name + ".X_WR.position");
    need_number(solid.X_WR.rotation.norm(), 0.999, 1.001,
                "the length of " + name + ".X_WR.rotation");
    need_finite(solid.velocity_W, name + ".velocity_W");
    need_finite(solid.angular_velocity_W, name + ".angular_velocity_W");
  }

  /// Refuses a factor with which all pieces of the largest solid would be debris.
  void check_piece_size() const {
    double most = 0;  // size of the largest solid, in smallest pieces of its material
    for (const Solid& solid : scene_.solids) {
      const Material& material = scene_.materials[solid.compound.convexes[0]->material.value];
      if (!material.breakable() && !material.breaks_by_load()) continue;
      most = std::max(most, std::cbrt(volume(solid.compound) / material.smallest_piece_m3));
    }
    const double factor = scene_.limits.piece_size_factor;
    if (factor > 1 && most > 0 && factor > most)
      refuse("limits.piece_size_factor is " + text_of(factor) +
                 ", so that all pieces of the largest solid would be debris",
             "at most " + text_of(std::max(1.0, most)));
  }

  void check_ball(const Ball& ball, const std::string& name) const {
    need_number(ball.radius_m, 1e-9, kMaxNumber, name + ".radius_m");
    need_material(ball.material, name);
    need_finite(ball.center_W, name + ".center_W");
    need_finite(ball.velocity_W, name + ".velocity_W");
  }

  void check_ground_mesh(std::size_t i) const {
    const GroundMesh& mesh = scene_.ground.meshes[i];
    const std::string name = item("ground.meshes", i);
    need_material(mesh.material, name);
    for (const Vec3& vertex : mesh.vertices_W) need_finite(vertex, name + ".vertices_W");
    for (const auto& triangle : mesh.triangles) {
      if (std::ranges::max(triangle) >= mesh.vertices_W.size())
        refuse(name + " has a triangle with vertex " + std::to_string(std::ranges::max(triangle)),
               "an index below " + std::to_string(mesh.vertices_W.size()));
    }
  }

  std::size_t bodies() const { return scene_.solids.size() + scene_.balls.size(); }

  void check_joint(std::size_t i) const {
    const Joint& joint = scene_.joints[i];
    const std::string name = item("joints", i);
    if (!joint.a && !joint.b) refuse(name + " has no body", "a, b or both");
    for (const std::optional<std::uint32_t>& end : {joint.a, joint.b}) {
      if (end && *end >= bodies())
        refuse(name + " has body " + std::to_string(*end),
               "one of the " + std::to_string(bodies()) + " solids and balls");
    }
    if (joint.a == joint.b) refuse(name + " joins a body to itself", "two different bodies");
    need_finite(joint.at_W, name + ".at_W");
    need_finite(joint.to_W, name + ".to_W");
    need_finite(joint.axis_W, name + ".axis_W");
    need_number(joint.breaking_N, 0, kInfinity, name + ".breaking_N");
    need_number(joint.breaking_Nm, 0, kInfinity, name + ".breaking_Nm");
    if (joint.kind == JointKind::kHinge && !(joint.axis_W.norm() > 0))
      refuse(name + ".axis_W is zero", "a vector with a length");
    if (joint.kind == JointKind::kPlastic)
      refuse(name + ".kind is kPlastic, which scenes cannot use", "another kind of joint");
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
      need_number(acts[i].time_s, -kMaxTime_s, kMaxTime_s, item(list, i) + ".time_s");
      if (i > 0 && acts[i].time_s < acts[i - 1].time_s)
        refuse(item(list, i) + " comes before " + item(list, i - 1), "events in order of time");
    }
  }

  void check_script() const {
    need_times(scene_.shots, "shots");
    need_times(scene_.blasts, "blasts");
    need_times(scene_.removals, "removals");
    need_times(scene_.drives, "drives");
    for (std::size_t i = 0; i < scene_.shots.size(); ++i) {
      const std::string name = item("shots", i);
      check_ball(scene_.shots[i].ball, name + ".ball");
      const Vec3 from_W = scene_.shots[i].hangs_from_W.value_or(Vec3::Zero());
      need_finite(from_W, name + ".hangs_from_W");
      for (const Solid& link : scene_.shots[i].links) check_solid(link, name + ".links");
    }
    for (std::size_t i = 0; i < scene_.blasts.size(); ++i)
      check_blast(scene_.blasts[i], item("blasts", i));
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

  void check_blast(const Blast& blast, const std::string& name) const {
    need_finite(blast.center_W, name + ".center_W");
    need_number(blast.radius_m, 1e-9, kMaxNumber, name + ".radius_m");
    need_number(blast.impulse_Ns_m2, 0, 1e15, name + ".impulse_Ns_m2");
    if (blast.tnt_kg) need_number(*blast.tnt_kg, 1e-9, kMaxNumber, name + ".tnt_kg");
  }

  void check_drive(const Drive& drive, const std::string& name) const {
    need_roots(drive.roots, bodies(), name);
    need_number(drive.until_s, drive.time_s, kInfinity, name + ".until_s");
    if (!drive.velocity_W && !drive.angular_velocity_W)
      refuse(name + " has no velocity", "velocity_W, angular_velocity_W or both");
    need_finite(drive.velocity_W.value_or(Vec3::Zero()), name + ".velocity_W");
    need_finite(drive.angular_velocity_W.value_or(Vec3::Zero()), name + ".angular_velocity_W");
    need_number(drive.force_N, 0, kInfinity, name + ".force_N");
    need_number(drive.torque_Nm, 0, kInfinity, name + ".torque_Nm");
  }

  void check_move(const Move& move, const std::string& name) const {
    for (const std::uint32_t root : move.roots) need_roots({root}, scene_.solids.size(), name);
    if (std::isnan(move.release_s)) refuse(name + ".release_s is not a number", "a time");
    need_finite(move.pivot_W.value_or(Vec3::Zero()), name + ".pivot_W");
    double last_s = 0;
    for (const PathKey& key : move.path.keys) {
      if (!(key.time_s > last_s && key.time_s <= kMaxTime_s))
        refuse(name + ".path has a key at " + text_of(key.time_s) + " s",
               "times that ascend from 0");
      last_s = key.time_s;
      need_finite(key.shift_W, name + ".path, shift_W");
      need_finite(key.rotation_W, name + ".path, rotation_W");
    }
  }

  const Scene& scene_;
};

}  // namespace

void check_scene(const Scene& scene) { SceneCheck(scene).run(); }

}  // namespace sunder
