// Joints: the keys of [[joint]] in a scene file.
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

/// Reads a joint of a scene that has its solids and balls. Throws InputError with file and line.
Joint read_joint(const Value& table, const Scene& scene);

}  // namespace sunder::scenes
