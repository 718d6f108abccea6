#include "scenes/file/script.h"

#include <algorithm>

#include "engine/base/check.h"
#include "scenes/file/chain.h"
#include "scenes/file/names.h"
#include "scenes/file/schema.h"

namespace sunder::scenes {
namespace {

void add_wrecking_ball(const Value& table, Scene& scene) {
  WreckingBallText text;
  read(schema().wrecking_ball, table, scene.materials, text);
  Shot shot{text.time_s,
            {text.name, text.radius_m, text.material.index, text.from, text.velocity},
            text.hangs_from};
  if ((text.from - text.hangs_from).norm() <= text.radius_m) {
    throw InputError(table.where +
                     ": hangs_from in [[script.wrecking_ball]] is within the ball; move it out, or "
                     "lessen radius_m");
  }
  shot.links = make_chain(shot, text.links);
  scene.shots.push_back(std::move(shot));
}

void add_blast(const Value& table, Scene& scene) {
  BlastText text;
  read(schema().blast, table, {}, text);
  scene.blasts.push_back({text.time_s, text.at, text.radius_m, text.impulse_Ns_m2});
}

void add_removal(const Value& table, Scene& scene) {
  RemoveText text;
  read(schema().remove, table, {}, text);
  if (text.name.has_value() == (text.from || text.to) ||
      text.from.has_value() != text.to.has_value()) {
    throw InputError(table.where + ": [[script.remove]] needs either name, or from and to");
  }
  Removal removal;
  removal.time_s = text.time_s;
  if (text.name) {
    removal.roots = roots_named(scene, *text.name, *find(std::get<Table>(table.data), "name"));
  } else {
    removal.anchors_W.extend(*text.from);
    removal.anchors_W.extend(*text.to);
  }
  scene.removals.push_back(removal);
}

void add_drive(const Value& table, Scene& scene) {
  DriveText text;
  read(schema().drive, table, {}, text);
  if (text.until_s <= text.time_s) {
    throw InputError(table.where + ": until_s in [[script.drive]] is not after time_s");
  }
  const Value& name = *find(std::get<Table>(table.data), "name");
  std::vector<std::uint32_t> roots = roots_named(scene, text.name, name);
  if (std::ranges::all_of(roots, [&](std::uint32_t root) { return is_anchored(scene, root); })) {
    throw InputError(name.where + ": '" + text.name +
                     "' in [[script.drive]] is held by the world, which no force moves; take its "
                     "anchored away");
  }
  scene.drives.push_back(
      {text.time_s, text.until_s, std::move(roots), text.velocity, text.force_N});
}

void add_shot(const Value& table, Scene& scene) {
  ShotText text;
  read(schema().shot, table, scene.materials, text);
  if (text.velocity.has_value() == text.at.has_value()) {
    throw InputError(table.where +
                     ": [[script.shot]] needs either velocity, or at (and speed_m_s)");
  }
  if (text.at && *text.at == text.from) {
    throw InputError(table.where + ": at and from in [[script.shot]] are the same point");
  }
  const Vec3 velocity =
      text.velocity ? *text.velocity : text.speed_m_s * (*text.at - text.from).normalized();
  scene.shots.push_back(
      {text.time_s, {text.name, text.radius_m, text.material.index, text.from, velocity}, {}});
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
