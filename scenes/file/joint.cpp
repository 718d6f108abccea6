#include "scenes/file/joint.h"

#include "engine/base/check.h"
#include "engine/model/structure.h"
#include "scenes/file/names.h"

namespace sunder::scenes {
namespace {

using Kind = JointKind;
constexpr std::string_view kKinds[] = {"ball", "hinge", "fixed", "distance", "rope"};
constexpr Range kPlace = ranges::kPlace_m;
constexpr Range kLoad{0, std::numeric_limits<double>::infinity()};

Keys<JointTable> make_keys() {
  using Given = JointTable;
  return {
      "[[joint]]",
      {choice<&Given::kind>(
           "kind", kKinds,
           "ball: free rotation; hinge: rotation about one axis; fixed: no rotation; distance: a "
           "rod from `at` to `to`; rope: a distance that may shrink.")
           .must(),
       key<&Given::a>(
           "a",
           "Solid, body or ball of the joint; of several with this name, the one nearest to `at`.")
           .must(),
       key<&Given::b>("b", "Other solid, body or ball; the world by default."),
       key<&Given::at>("at", "m", kPlace,
                       "Position of the joint; for distance and rope, the end on a.")
           .must(),
       key<&Given::to>("to", "m", kPlace,
                       "distance, rope: the end on b; the initial length is kept."),
       key<&Given::axis>("axis", "", Range{-1, 1}, "hinge: direction of the axis."),
       key<&Given::breaking_N>("breaking_N", "N", kLoad, "Force at which the joint breaks."),
       key<&Given::breaking_Nm>("breaking_Nm", "N·m", kLoad,
                                "hinge, fixed: torque at which the joint breaks."),
       key<&Given::collide>("collide", "true: the two bodies collide with each other.")}};
}

[[noreturn]] void fail(const Value& table, std::string_view key, const std::string& what) {
  const Value* value = find(table, key);
  throw InputError((value ? value->where : table.where) + ": " + what);
}

/// Returns the root of this name that is nearest to a point.
std::uint32_t nearest_root(const Scene& scene, const std::string& name, const Value& value,
                           const Vec3& point_W) {
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t nearest = 0;
  for (const std::uint32_t root : roots_named(scene, name, value)) {
    const std::size_t solids = scene.solids.size();
    const double distance = root < solids ? distance_to(Structure(scene.solids[root].compound),
                                                        scene.solids[root].X_WR.inverse() * point_W)
                                          : (scene.balls[root - solids].center_W - point_W).norm();
    if (distance >= least) continue;
    least = distance;
    nearest = root;
  }
  return nearest;
}

bool is_fixed(const Scene& scene, const std::optional<std::uint32_t>& root) {
  return !root || is_anchored(scene, *root);
}

void check(const Value& table, const JointTable& given) {
  const bool has_length = given.kind == Kind::kDistance || given.kind == Kind::kRope;
  const std::string kind(kKinds[static_cast<std::size_t>(given.kind)]);
  if (has_length != given.to.has_value()) {
    fail(table, "to",
         has_length ? "missing key 'to' in [[joint]] of kind " + kind + ", its end point on b"
                    : "to in [[joint]] is for kinds distance and rope; this one is " + kind);
  }
  if (has_length && *given.to == given.at)
    fail(table, "to", "at and to in [[joint]] are the same point");
  if (given.axis.isZero()) fail(table, "axis", "axis in [[joint]] is zero; give it a direction");
  const bool bears_torque = given.kind == Kind::kHinge || given.kind == Kind::kFixed;
  if (!bears_torque && std::isfinite(given.breaking_Nm)) {
    fail(table, "breaking_Nm",
         "breaking_Nm in [[joint]] is for kinds hinge and fixed; a " + kind + " bears no torque");
  }
}

}  // namespace

const Keys<JointTable>& joint_keys() {
  static const Keys<JointTable> kKeys = make_keys();
  return kKeys;
}

Joint read_joint(const Value& table, const Scene& scene) {
  JointTable given;
  read(joint_keys(), table, {}, given);
  check(table, given);
  Joint joint;
  joint.kind = given.kind;
  joint.at_W = given.at;
  joint.to_W = given.to.value_or(given.at);
  joint.a = nearest_root(scene, given.a, *find(table, "a"), given.at);
  if (given.b) joint.b = nearest_root(scene, *given.b, *find(table, "b"), joint.to_W);
  if (joint.a == joint.b) fail(table, "b", "a and b in [[joint]] are the same body");
  if (is_fixed(scene, joint.a) && is_fixed(scene, joint.b)) {
    fail(table, "a", "neither end of this [[joint]] can move: both are anchored to the world");
  }
  joint.axis_W = given.axis;
  joint.breaking_N = given.breaking_N;
  joint.breaking_Nm = given.breaking_Nm;
  joint.collide = given.collide;
  return joint;
}

}  // namespace sunder::scenes
