// What holds things together: what [[joint]] in a scene may say.
#pragma once

#include <limits>
#include <optional>
#include <string>

#include "engine/model/scene.h"
#include "scenes/file/keys.h"

namespace sunder::scenes {

/// The keys of [[joint]].
struct JointTable {
  JointKind kind = JointKind::kBall;
  std::string a;
  std::optional<std::string> b;
  Vec3 at = Vec3::Zero();
  std::optional<Vec3> to;
  Vec3 axis = Vec3::UnitZ();
  double breaking_N = std::numeric_limits<double>::infinity();
  double breaking_Nm = std::numeric_limits<double>::infinity();
  bool collide = false;
};
const Keys<JointTable>& joint_keys();

/// The joint of a table, between solids and balls that the scene has by now. Throws InputError with
/// the place of what is wrong.
Joint read_joint(const Value& table, const Scene& scene);

}  // namespace sunder::scenes
