#include "scenes/file/script.h"

#include <algorithm>

#include "engine/base/check.h"
#include "scenes/file/chain.h"
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
                     ": hangs_from in [[script.wrecking_ball]] is within the ball; move it out, or "
                     "lessen radius_m");
  }
  shot.links = make_chain(shot, given.links);
  scene.shots.push_back(std::move(shot));
}

void add_blast(const Value& table, Scene& scene) {
  read(schema().blast, table, {}, scene.blasts.emplace_back());
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
    throw InputError(
        name.where + ": '" + given.name +
        "' in [[script.drive]] is anchored to the world, which no force moves; take its "
        "anchored away");
  }
  scene.drives.push_back({given.time_s, given.until_s, std::move(roots), given.velocity,
                          given.force_N, given.angular_velocity, given.torque_Nm});
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

void read_script(const Value& table, Scene& scene) {
  Script script;
  read(schema().script, table, {}, script);
  // Read even if it is not enabled: a scene is right or wrong whatever is switched off.
  for (const Value* shot : tables(table, "shot")) add_shot(*shot, scene);
  for (const Value* ball : tables(table, "wrecking_ball")) add_wrecking_ball(*ball, scene);
  for (const Value* blast : tables(table, "blast")) add_blast(*blast, scene);
  for (const Value* removal : tables(table, "remove")) add_removal(*removal, scene);
  for (const Value* drive : tables(table, "drive")) add_drive(*drive, scene);
  if (!script.enabled) {
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
