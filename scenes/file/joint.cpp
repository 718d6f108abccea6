#include "scenes/file/joint.h"

#include "engine/base/check.h"
#include "engine/model/structure.h"
#include "scenes/file/names.h"

namespace sunder::scenes {
namespace {

using Kind = JointDesc::Kind;
constexpr std::string_view kKinds[] = {"ball", "hinge", "fixed", "distance", "rope"};
constexpr Range kPlace{-1e6, 1e6};
constexpr Range kLoad{0, std::numeric_limits<double>::infinity()};

Keys<JointText> make_keys() {
  using Text = JointText;
  return {
      "[[joint]]",
      {choice<&Text::kind>(
           "kind", kKinds,
           "ball: turns freely; hinge: about one axis; fixed: not at all; distance: "
           "a rod from at to to; rope: one that only pulls.")
           .must(),
       key<&Text::a>("a",
                     "The solid, body or ball that is held; of several by that name, the one "
                     "nearest to the place.")
           .must(),
       key<&Text::b>("b", "What it is held to; without it, the world."),
       key<&Text::at>("at", "m", kPlace, "Where; of distance and rope, on a.").must(),
       key<&Text::to>("to", "m", kPlace, "distance, rope: where on b; it stays as long as it is."),
       key<&Text::axis>("axis", "", Range{-1, 1}, "hinge: its direction."),
       key<&Text::breaking_N>("breaking_N", "N", kLoad, "It breaks when it would bear more."),
       key<&Text::breaking_Nm>("breaking_Nm", "N·m", kLoad,
                               "hinge, fixed: it breaks when it would bear more."),
       key<&Text::collide>("collide", "Whether the two touch each other.")}};
}

[[noreturn]] void fail(const Value& table, std::string_view key, const std::string& what) {
  const Value* value = find(std::get<Table>(table.data), key);
  throw InputError((value ? value->where : table.where) + ": " + what);
}

/// Of all that go by a name, the one nearest to a point.
std::uint32_t thing_named(const Scene& scene, const std::string& name, const Value& value,
                          const Vec3& point_W) {
  double least = std::numeric_limits<double>::infinity();
  std::uint32_t nearest = 0;
  for (const std::uint32_t root : roots_named(scene, name, value)) {
    const std::size_t solids = scene.solids.size();
    const double distance = root < solids
                                ? distance_outside(Structure(scene.solids[root].compound),
                                                   scene.solids[root].X_WR.inverse() * point_W)
                                : (scene.balls[root - solids].center_W - point_W).norm();
    if (distance >= least) continue;
    least = distance;
    nearest = root;
  }
  return nearest;
}

bool is_held(const Scene& scene, const std::optional<std::uint32_t>& root) {
  return !root || is_anchored(scene, *root);
}

void check(const Value& table, const JointText& text) {
  const bool apart = text.kind == Kind::kDistance || text.kind == Kind::kRope;
  const std::string kind(kKinds[static_cast<std::size_t>(text.kind)]);
  if (apart != text.to.has_value()) {
    fail(table, "to",
         apart ? "missing key 'to' in [[joint]] of kind " + kind + ": where on b it ends"
               : "to in [[joint]] is for kinds distance and rope; this one is " + kind);
  }
  if (apart && *text.to == text.at) fail(table, "to", "at and to in [[joint]] are the same point");
  if (text.axis.isZero()) fail(table, "axis", "axis in [[joint]] is zero; give it a direction");
  const bool turns = text.kind == Kind::kHinge || text.kind == Kind::kFixed;
  if (!turns && std::isfinite(text.breaking_Nm)) {
    fail(table, "breaking_Nm",
         "breaking_Nm in [[joint]] is for kinds hinge and fixed; a " + kind + " bears no torque");
  }
}

}  // namespace

const Keys<JointText>& joint_keys() {
  static const Keys<JointText> kKeys = make_keys();
  return kKeys;
}

Joint read_joint(const Value& table, const Scene& scene) {
  JointText text;
  read(joint_keys(), table, {}, text);
  check(table, text);
  const Table& entries = std::get<Table>(table.data);
  Joint joint;
  joint.kind = text.kind;
  joint.at_W = text.at;
  joint.to_W = text.to.value_or(text.at);
  joint.a = thing_named(scene, text.a, *find(entries, "a"), text.at);
  if (text.b) joint.b = thing_named(scene, *text.b, *find(entries, "b"), joint.to_W);
  if (joint.a == joint.b) fail(table, "b", "a and b in [[joint]] are the same thing");
  if (is_held(scene, joint.a) && is_held(scene, joint.b)) {
    fail(table, "a", "neither end of this [[joint]] can move: the world holds both");
  }
  joint.axis_W = text.axis;
  joint.breaking_N = text.breaking_N;
  joint.breaking_Nm = text.breaking_Nm;
  joint.collide = text.collide;
  return joint;
}

}  // namespace sunder::scenes
