#include "scenes/file/script.h"

#include <algorithm>
#include <limits>

#include "engine/base/check.h"
#include "engine/base/rotation.h"
#include "scenes/file/chain.h"
#include "scenes/file/error_list.h"
#include "scenes/file/names.h"
#include "scenes/file/schema.h"

namespace sunder::scenes {
namespace {

void add_wrecking_ball(const Value& table, Scene& scene) {
  WreckingBallTable given;
  read(schema().wrecking_ball, table, scene.materials, given);
  Shot shot{given.time_s,
            {given.name, given.radius_m, given.material.index, given.from, given.velocity},
            given.hangs_from};
  if ((given.from - given.hangs_from).norm() <= given.radius_m) {
    throw InputError(table.where +
                     ": hangs_from in [[script.wrecking_ball]] is inside the ball; move it "
                     "outside, or reduce radius_m");
  }
  shot.links = make_chain(shot, given.links);
  scene.shots.push_back(std::move(shot));
}

void add_blast(const Value& table, Scene& scene) {
  Blast& blast = scene.blasts.emplace_back();
  read(schema().blast, table, {}, blast);
  for (const char* key : {"radius_m", "impulse_Ns_m2"}) {
    const Value* value = find(table, key);
    if (!value || !blast.tnt_kg) continue;
    throw InputError(value->where + ": " + key +
                     " and tnt_kg in [[script.blast]] exclude each other; remove one");
  }
  if (const Value* burst = find(table, "burst"); burst && !blast.tnt_kg) {
    throw InputError(burst->where +
                     ": burst in [[script.blast]] needs tnt_kg; add tnt_kg, or remove burst");
  }
}

void add_removal(const Value& table, Scene& scene) {
  RemoveTable given;
  read(schema().remove, table, {}, given);
  if (given.name.has_value() == (given.from || given.to) ||
      given.from.has_value() != given.to.has_value()) {
    throw InputError(table.where + ": [[script.remove]] needs either name, or from and to");
  }
  Removal removal;
  removal.time_s = given.time_s;
  if (given.name) {
    removal.roots = roots_named(scene, *given.name, *find(table, "name"));
  } else {
    removal.anchors_W.extend(*given.from);
    removal.anchors_W.extend(*given.to);
  }
  scene.removals.push_back(removal);
}

void add_drive(const Value& table, Scene& scene) {
  DriveTable given;
  read(schema().drive, table, {}, given);
  if (given.until_s <= given.time_s) {
    throw InputError(table.where + ": until_s in [[script.drive]] is not after time_s");
  }
  if (!given.velocity && !given.angular_velocity) {
    throw InputError(table.where +
                     ": [[script.drive]] needs velocity, or angular_velocity, or both");
  }
  const Value& name = *find(table, "name");
  std::vector<std::uint32_t> roots = roots_named(scene, given.name, name);
  if (std::ranges::all_of(roots, [&](std::uint32_t root) { return is_anchored(scene, root); })) {
    throw InputError(name.where + ": '" + given.name +
                     "' in [[script.drive]] is anchored to the world and cannot be moved; set "
                     "its key 'anchored' to \"none\"");
  }
  scene.drives.push_back({given.time_s, given.until_s, std::move(roots), given.velocity,
                          given.force_N, given.angular_velocity, given.torque_Nm});
}

/// Highest speed and spin of a moved body along its path; a faster one could pass through others.
constexpr double kMaxPathSpeed_m_s = 100, kMaxPathSpin_rad_s = 50;
constexpr double kNever = std::numeric_limits<double>::infinity();

PathKey read_path_key(const Value& table, const PathKey& before) {
  MoveKeyTable given;
  read(schema().move_key, table, {}, given);
  const double duration_s = given.time_s - before.time_s;
  if (duration_s <= 0) {
    throw InputError(find(table, "time_s")->where + ": time_s in [[script.move.key]] is " +
                     format(given.time_s) + ", not after " + format(before.time_s) +
                     (before.time_s > 0 ? " of the previous key; sort the keys by time_s"
                                        : ", the time of the initial pose"));
  }
  const auto check = [&](double distance, double max_rate, const std::string& unit) {
    if (distance <= max_rate * duration_s) return;
    throw InputError(table.where + ": the motion to this [[script.move.key]] needs " +
                     format(distance / duration_s) + " " + unit + "; allowed: at most " +
                     format(max_rate) + "; increase time_s");
  };
  check((given.shift - before.shift_W).norm(), kMaxPathSpeed_m_s, "m/s");
  check((given.turn_rad - before.rotation_W).norm(), kMaxPathSpin_rad_s, "rad/s");
  return {given.time_s, given.shift, given.turn_rad};
}

Path read_path(const Value& table, const MoveTable& given) {
  Path path;
  path.smooth = given.smooth, path.loops = given.loop;
  for (const Value* key : tables(table, "key"))
    path.keys.push_back(read_path_key(*key, path.keys.empty() ? PathKey{} : path.keys.back()));
  if (path.keys.empty()) {
    throw InputError(table.where + ": [[script.move]] needs at least one [[script.move.key]]");
  }
  constexpr double kReturnTolerance = 1e-6;  // m; half an angle in rad
  const PathKey& last = path.keys.back();
  const bool returns = last.shift_W.norm() < kReturnTolerance &&
                       rotation_by(last.rotation_W).vec().norm() < kReturnTolerance;
  if (given.loop && !returns) {
    throw InputError(tables(table, "key").back()->where +
                     ": the last key of a [[script.move]] with loop = true must be the initial "
                     "pose: shift = [0, 0, 0], and a turn of 0 or of whole revolutions");
  }
  return path;
}

void add_move(const Value& table, Scene& scene) {
  MoveTable given;
  read(schema().move, table, {}, given);
  const Value& name = *find(table, "name");
  const auto refuse = [&](const std::string& why) {
    throw InputError(name.where + ": '" + given.name + "' in [[script.move]] " + why);
  };
  Move move{roots_named(scene, given.name, name), read_path(table, given), given.pivot};
  for (const std::uint32_t root : move.roots) {
    const auto holds = [&](const Joint& joint) { return joint.a == root || joint.b == root; };
    const auto moves = [&](const Move& other) { return std::ranges::count(other.roots, root) > 0; };
    if (root >= scene.solids.size()) refuse("is a ball; only a [[body]] or [[solid]] can be moved");
    if (is_anchored(scene, root)) {
      refuse("is anchored to the world and cannot be moved; set its key 'anchored' to \"none\"");
    }
    if (std::ranges::any_of(scene.moves, moves))
      refuse("is moved by another [[script.move]] already");
    const auto stays = [&](std::optional<std::uint32_t> end) {
      const auto moved = [&](const Move& other) {
        return std::ranges::count(other.roots, *end) > 0;
      };
      return !end || is_anchored(scene, *end) || moved(move) ||
             std::ranges::any_of(scene.moves, moved);
    };
    for (const Joint& joint : scene.joints) {
      if (!holds(joint) || !stays(joint.a == root ? joint.b : joint.a)) continue;
      refuse(
          "has a [[joint]] to the world, or to a body that is anchored or moved, too; one of the "
          "two bodies of a joint must be free");
    }
  }
  if (given.release_s) move.release_s = *given.release_s;
  scene.moves.push_back(std::move(move));
}

void add_shot(const Value& table, Scene& scene) {
  ShotTable given;
  read(schema().shot, table, scene.materials, given);
  if (given.velocity.has_value() == given.at.has_value()) {
    throw InputError(table.where +
                     ": [[script.shot]] needs either velocity, or at (and speed_m_s)");
  }
  if (given.at && *given.at == given.from) {
    throw InputError(table.where + ": at and from in [[script.shot]] are the same point");
  }
  const Vec3 velocity =
      given.velocity ? *given.velocity : given.speed_m_s * (*given.at - given.from).normalized();
  scene.shots.push_back(
      {given.time_s, {given.name, given.radius_m, given.material.index, given.from, velocity}, {}});
}

}  // namespace

void read_script(const Value& table, Scene& scene, ErrorList& errors) {
  Script script;
  errors.collect([&] { read(schema().script, table, {}, script); });
  // A disabled script is read too, so that its errors are found.
  using Add = void (*)(const Value&, Scene&);
  for (const auto& [key, add] : {std::pair<const char*, Add>{"shot", add_shot},
                                 {"wrecking_ball", add_wrecking_ball},
                                 {"blast", add_blast},
                                 {"remove", add_removal},
                                 {"drive", add_drive},
                                 {"move", add_move}}) {
    errors.collect([&, name = key, read_act = add] {
      for (const Value* act : tables(table, name))
        errors.collect_keys([&] { read_act(*act, scene); });
    });
  }
  if (!script.enabled) {
    // Moved bodies stay kinematic, at rest.
    for (Move& move : scene.moves) move.path = {}, move.release_s = kNever;
    scene.shots.clear();
    scene.blasts.clear();
    scene.removals.clear();
    scene.drives.clear();
  }
  const auto sort = [](auto& acts) {
    std::ranges::stable_sort(acts, {}, [](const auto& act) { return act.time_s; });
  };
  sort(scene.shots);
  sort(scene.blasts);
  sort(scene.removals);
  sort(scene.drives);
}

}  // namespace sunder::scenes
