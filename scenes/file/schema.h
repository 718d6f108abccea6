// The tables of a scene file and their keys. Structures declare theirs in structures/.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/model/scene.h"
#include "scenes/file/keys.h"

namespace sunder::scenes {

/// A named trade-off between speed and accuracy.
struct Preset {
  std::string_view name;
  Accuracy accuracy;
  int sweeps;                 ///< Sweeps of the solver in a substep.
  std::uint32_t full_detail;  ///< As in Limits, as chip_size_factor.
  double chip_size_factor;
  std::string_view help;

  /// Sets the values of a scene.
  void apply(Scene& scene) const {
    scene.accuracy = accuracy;
    scene.solver.sweeps = sweeps;
    scene.limits.full_detail = full_detail;
    scene.limits.chip_size_factor = chip_size_factor;
  }
};
std::span<const Preset> presets();

inline constexpr int kMaxSubsteps = 64;

/// The keys of [[material]] that are not stored in a Material.
struct MaterialHead {
  std::string name;
  std::string like;
};

enum class Anchored { kNone, kBottom, kAll, kOwn };
/// Returns the names of the values of Anchored, in order, but for kOwn: what is no structure has no
/// feet of its own.
std::span<const std::string_view> anchored_names();

/// The keys of [[solid]] that all structures share, except for the placement (placement.h).
struct SolidHead {
  std::string structure;
  std::string name;
  Vec3 velocity = Vec3::Zero();
  Vec3 angular_velocity = Vec3::Zero();
  Anchored anchored = Anchored::kOwn;
};

/// The keys of a part of a compound, except for the placement (placement.h).
struct PartHead {
  std::string structure;
};

struct BallTable {
  std::string name;
  Vec3 position = Vec3(0, 1, 0);
  Vec3 velocity = Vec3::Zero();
  double radius_m = 0.5;
  MaterialRef material{"steel", {}};
};

struct Script {
  bool enabled = true;
};

struct ShotTable {
  std::string name;
  double time_s = 0;
  Vec3 from = Vec3::Zero();
  std::optional<Vec3> velocity;
  std::optional<Vec3> at;
  double speed_m_s = 20;
  double radius_m = 0.5;
  MaterialRef material{"steel", {}};
};

struct RemoveTable {
  double time_s = 0;
  std::optional<std::string> name;
  std::optional<Vec3> from, to;
};

struct DriveTable {
  double time_s = 0;
  double until_s = 600;
  std::string name;
  std::optional<Vec3> velocity;
  double force_N = 1e6;
  std::optional<Vec3> angular_velocity;
  double torque_Nm = 1e6;
};

struct MoveTable {
  std::string name;
  bool smooth = true;
  bool loop = false;
  std::optional<Vec3> pivot;
  std::optional<double> release_s;
};

struct MoveKeyTable {
  double time_s = 0;
  Vec3 shift = Vec3::Zero();
  Vec3 turn_rad = Vec3::Zero();
};

struct WreckingBallTable {
  std::string name;
  double time_s = 0;
  Vec3 from = Vec3::Zero();
  Vec3 hangs_from = Vec3::Zero();
  Vec3 velocity = Vec3::Zero();
  double radius_m = 0.5;
  std::uint32_t links = 16;
  MaterialRef material{"steel", {}};
};

/// The keys of all tables but those of other headers; `top` has the names of the top-level tables.
struct Schema {
  Keys<Scene> top;
  Keys<Scene> scene;
  Keys<Accuracy> accuracy;
  Keys<SolverOptions> solver;
  Keys<Limits> limits;
  Keys<Ground> ground;
  Keys<View> view;
  Keys<ViewKey> view_key;
  Keys<MaterialHead> material_head;
  Keys<Material> material;
  Keys<PatternSpec> pattern;
  Keys<ImpactResponse> stronger;
  Keys<DebrisEmission> crumbling;
  Keys<Look> look;
  Keys<SolidHead> solid;
  Keys<PartHead> part;
  Keys<BallTable> ball;
  Keys<Script> script;
  Keys<ShotTable> shot;
  Keys<WreckingBallTable> wrecking_ball;
  Keys<Blast> blast;
  Keys<RemoveTable> remove;
  Keys<DriveTable> drive;
  Keys<MoveTable> move;
  Keys<MoveKeyTable> move_key;
};
const Schema& schema();

}  // namespace sunder::scenes
