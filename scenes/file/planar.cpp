#include "scenes/file/planar.h"

#include <cmath>

#include "engine/base/check.h"
#include "engine/base/exponential.h"
#include "engine/geometry/prism.h"

namespace sunder::scenes {
namespace {

/// Components out of the plane, in m, m/s and rad/s, are rounding errors up to this.
constexpr double kPlaneTolerance = 1e-9;

/// Throws InputError for parts of a scene that need a third dimension.
struct Checker {
  const Scene& scene;
  const std::string& where;

  void require(bool planar, const std::string& what) const {
    if (!planar) throw InputError(where + ": planar = true in [scene], but " + what);
  }
  void in_plane(const Vec3& vector, const std::string& what) const {
    require(std::abs(vector.z()) <= kPlaneTolerance, what + " has a z component; set it to 0");
  }
  void check(const Solid& solid) const;
  void check(const Ball& ball, const std::string& name) const;
};

void Checker::check(const Solid& solid) const {
  const std::string name = "solid '" + solid.name + "' ";
  in_plane(solid.velocity_W, name + "has a velocity that");
  require(solid.angular_velocity_W.head<2>().norm() <= kPlaneTolerance,
          name + "rotates about an axis other than z");
  for (const ConvexPtr& convex : solid.compound.convexes) {
    const Material& material = scene.materials[convex->material.value];
    require(!convex->visual, name + "is a mesh; build it from boxes and prisms");
    const std::optional<ZPrism> prism = prism_along_z(convex->polyhedron, solid.X_WR);
    require(prism.has_value(), name + "is not a prism along z; rotate it, or build it from boxes");
    require(prism->low < -kPlaneTolerance && prism->high > kPlaneTolerance,
            name +
                "has parts that do not cross the plane z = 0; move it there, or make its blocks "
                "larger");
    require(!material.breakable(), name + "has the material " + material.name +
                                       ", whose pattern would break it along z; set pattern = { "
                                       "kind = \"none\" } in a [[material]] of this name");
  }
}

void Checker::check(const Ball& ball, const std::string& name) const {
  in_plane(ball.center_W, name + "has a position that");
  in_plane(ball.velocity_W, name + "has a velocity that");
}

double extent_m(const Convex& convex, const Quat& rotation) {
  Box box;
  for (const Vec3& vertex : convex.polyhedron.vertices) box.extend(rotation * vertex);
  return std::sqrt(box.extent().x() * box.extent().y());
}

}  // namespace

void check_planar(const Scene& scene, const std::string& where) {
  const Checker checker{scene, where};
  checker.in_plane(scene.gravity_W, "gravity");
  checker.require(
      scene.ground.meshes.empty(),
      "it has a [[ground.mesh]], which planar scenes do not support; build it from prisms");
  for (const Solid& solid : scene.solids) checker.check(solid);
  for (std::size_t i = 0; i < scene.balls.size(); ++i) {
    const Ball& ball = scene.balls[i];
    checker.check(ball, "ball '" + name_or_index(ball.name, "ball", i) + "' ");
  }
  checker.require(scene.joints.empty(), "it has a [[joint]], which planar scenes do not support");
  for (const Shot& shot : scene.shots) {
    checker.check(shot.ball, "a ball of [script] ");
    checker.require(!shot.hangs_from_W,
                    "[script] has a wrecking ball, which planar scenes do not support");
  }
  for (const Blast& blast : scene.blasts) checker.in_plane(blast.center_W, "a blast's centre");
  for (const Drive& drive : scene.drives) {
    if (drive.velocity_W) checker.in_plane(*drive.velocity_W, "a drive's velocity");
    checker.require(
        !drive.angular_velocity_W || drive.angular_velocity_W->head<2>().norm() <= kPlaneTolerance,
        "a drive's angular_velocity is about an axis other than z");
  }
  for (const Move& move : scene.moves) {
    for (const PathKey& key : move.path.keys) {
      checker.in_plane(key.shift_W, "a move's shift");
      checker.require(key.rotation_W.head<2>().norm() <= kPlaneTolerance,
                      "a move rotates about an axis other than z");
    }
  }
}

double planar_piece_m(const Scene& scene) {
  double logs = 0;
  std::size_t count = 0;
  const auto add = [&](double size_m) {
    logs += binary_logarithm(size_m);
    ++count;
  };
  for (const Solid& solid : scene.solids) {
    for (const ConvexPtr& convex : solid.compound.convexes) {
      add(extent_m(*convex, solid.X_WR.rotation));
    }
  }
  for (const Ball& ball : scene.balls) add(2 * ball.radius_m);
  for (const Shot& shot : scene.shots) add(2 * shot.ball.radius_m);
  return count == 0
             ? 1
             : std::ldexp(1, static_cast<int>(std::lround(logs / static_cast<double>(count))));
}

}  // namespace sunder::scenes
