// Read first: check_scene(), at the end.
#include "engine/model/checks/scene_check.h"

#include <algorithm>
#include <cmath>
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

constexpr double kFar = 1e9, kLong_s = 1e7;

class SceneCheck {
 public:
  explicit SceneCheck(const Scene& scene) : scene_(scene) {}

  void run() const {
    check_run();
    for (std::size_t i = 0; i < scene_.materials.size(); ++i) check_material(i);
    for (std::size_t i = 0; i < scene_.solids.size(); ++i)
      check_solid(scene_.solids[i], item("solids", i));
    for (std::size_t i = 0; i < scene_.balls.size(); ++i)
      check_ball(scene_.balls[i], item("balls", i));
    for (std::size_t i = 0; i < scene_.ground.meshes.size(); ++i) check_ground_mesh(i);
    for (std::size_t i = 0; i < scene_.joints.size(); ++i) check_joint(i);
    check_script();
  }

 private:
  void check_run() const {
    need_number(scene_.duration_s, 0, kLong_s, "duration_s");
    need_finite(scene_.gravity_W, "gravity_W");
    const Accuracy& accuracy = scene_.accuracy;
    need_number(accuracy.dt_s, 1e-6, 1, "accuracy.dt_s");
    need_number(accuracy.substeps, 1, 1000, "accuracy.substeps");
    const double steps = 1.0 / 60 / accuracy.dt_s;
    if (steps > 1 && std::abs(steps - std::round(steps)) > 1e-6 * steps)
      refuse("accuracy.dt_s is " + text_of(accuracy.dt_s),
             "a frame of 1/60 s divided by a whole number, such as 1/120");
    need_number(scene_.solver.sweeps, 1, 1000, "solver.sweeps");
    need_number(scene_.ground.height_m, -kFar, kFar, "ground.height_m");
    need_number(scene_.ground.friction, 0, kFar, "ground.friction");
    need_number(scene_.ground.restitution, 0, 1, "ground.restitution");
  }

  void check_material(std::size_t i) const {
    const Material& material = scene_.materials[i];
    const std::string name = item("materials", i) + ".";
    need_number(material.density_kg_m3, 1e-6, 1e9, name + "density_kg_m3");
    need_number(material.friction, 0, kFar, name + "friction");
    need_number(material.restitution, 0, 1, name + "restitution");
    need_number(material.rolling, 0, kFar, name + "rolling");
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
    for (const auto& [size, member] : sizes)
      need_number(size, 0, std::numeric_limits<double>::infinity(), name + member);
  }

  void need_material(MaterialIndex index, const std::string& name) const {
    if (index.value < scene_.materials.size()) return;
    refuse(name + (index.none() ? " has no material"
                                : " is of material " + std::to_string(index.value)),
           scene_.materials.empty()
               ? "a material in scene.materials, which is empty"
               : "one of the " + std::to_string(scene_.materials.size()) + " in scene.materials");
  }

  void check_solid(const Solid& solid, const std::string& name) const {
    const Compound& compound = solid.compound;
    const std::size_t count = compound.convexes.size();
    if (count == 0) refuse(name + ".compound has no convexes", "one or more");
    if (compound.anchored.size() != count)
      refuse(
          name + ".compound.anchored has " + std::to_string(compound.anchored.size()) + " elements",
          "one a convex, " + std::to_string(count));
    for (const ConvexPtr& convex : compound.convexes) {
      if (!convex) refuse(name + ".compound has a null convex", "convexes");
      if (!(convex->solid.volume_m3 > 0))
        refuse(name + ".compound has a convex without volume", "solids");
      need_material(convex->material, name);
    }
    for (const Bond& bond : compound.bonds) {
      if (bond.a >= count || bond.b >= count)
        refuse(name + ".compound has a bond of convex " + std::to_string(std::max(bond.a, bond.b)),
               "one of " + std::to_string(count));
    }
    need_finite(solid.X_WR.position, name + ".X_WR.position");
    need_number(solid.X_WR.rotation.norm(), 0.999, 1.001,
                "the length of " + name + ".X_WR.rotation");
    need_finite(solid.velocity_W, name + ".velocity_W");
    need_finite(solid.angular_velocity_W, name + ".angular_velocity_W");
  }

  void check_ball(const Ball& ball, const std::string& name) const {
    need_number(ball.radius_m, 1e-9, kFar, name + ".radius_m");
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
        refuse(name + " has a triangle of vertex " + std::to_string(std::ranges::max(triangle)),
               "one of " + std::to_string(mesh.vertices_W.size()));
    }
  }

  std::size_t bodies() const { return scene_.solids.size() + scene_.balls.size(); }

  void check_joint(std::size_t i) const {
    const Joint& joint = scene_.joints[i];
    const std::string name = item("joints", i);
    if (!joint.a && !joint.b) refuse(name + " holds no body", "a, b or both");
    for (const std::optional<std::uint32_t>& end : {joint.a, joint.b}) {
      if (end && *end >= bodies())
        refuse(name + " holds body " + std::to_string(*end),
               "one of the " + std::to_string(bodies()) + " solids and balls");
    }
    if (joint.a == joint.b) refuse(name + " joins a body to itself", "two");
    need_finite(joint.at_W, name + ".at_W");
    need_finite(joint.to_W, name + ".to_W");
    need_finite(joint.axis_W, name + ".axis_W");
  }

  void need_roots(const std::vector<std::uint32_t>& roots, std::size_t count,
                  const std::string& name) const {
    if (!std::ranges::is_sorted(roots)) refuse(name + ".roots do not ascend", "ascending indices");
    if (!roots.empty() && roots.back() >= count)
      refuse(name + " is of body " + std::to_string(roots.back()),
             "one of the " + std::to_string(count) + " that it may be of");
  }

  template <class Act>
  void need_times(const std::vector<Act>& acts, const char* list) const {
    for (std::size_t i = 0; i < acts.size(); ++i) {
      need_number(acts[i].time_s, -kLong_s, kLong_s, item(list, i) + ".time_s");
      if (i > 0 && acts[i].time_s < acts[i - 1].time_s)
        refuse(item(list, i) + " comes before " + item(list, i - 1), "an order of time");
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
      for (const Solid& link : scene_.shots[i].links) check_solid(link, name + ".links");
    }
    for (std::size_t i = 0; i < scene_.blasts.size(); ++i)
      need_finite(scene_.blasts[i].center_W, item("blasts", i) + ".center_W");
    for (std::size_t i = 0; i < scene_.removals.size(); ++i)
      need_roots(scene_.removals[i].roots, bodies(), item("removals", i));
    for (std::size_t i = 0; i < scene_.drives.size(); ++i)
      need_roots(scene_.drives[i].roots, bodies(), item("drives", i));
    for (std::size_t i = 0; i < scene_.moves.size(); ++i) {
      for (const std::uint32_t root : scene_.moves[i].roots)
        need_roots({root}, scene_.solids.size(), item("moves", i));
    }
  }

  const Scene& scene_;
};

}  // namespace

void check_scene(const Scene& scene) { SceneCheck(scene).run(); }

}  // namespace sunder
