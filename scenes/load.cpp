// Builds a scene from a TOML document. Read first: parse_scene().
#include "scenes/load.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "engine/base/check.h"
#include "engine/model/checks/scene_accuracy.h"
#include "engine/model/checks/scene_check.h"
#include "scenes/file/body.h"
#include "scenes/file/builtin_materials.h"
#include "scenes/file/error_list.h"
#include "scenes/file/ground_mesh.h"
#include "scenes/file/joint.h"
#include "scenes/file/moved_part.h"
#include "scenes/file/names.h"
#include "scenes/file/patterns.h"
#include "scenes/file/placement.h"
#include "scenes/file/planar.h"
#include "scenes/file/schema.h"
#include "scenes/file/script.h"
#include "scenes/file/view.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

constexpr double kFrame_s = 1.0 / 60;

/// Builds a scene from a document.
class Loader {
 public:
  Loader(const Value& document, std::filesystem::path folder)
      : document_(document), folder_(std::move(folder)) {}

  Scene load(const LoadOptions& options);
  void add_materials(const Value& document, const std::filesystem::path& folder);
  std::vector<Material> take_materials() { return std::move(scene_.materials); }

 private:
  /// The solids made from one table: `count` solids of the scene, from index `first` on.
  struct SolidGroup {
    std::string name;          ///< The name given; empty if there is none.
    std::string default_name;  ///< Base of the name where none is given.
    std::string where;
    std::size_t first = 0, count = 0;
  };

  /// Calls `work`, and keeps its InputError for the end of the file.
  template <class Work>
  void attempt(const Work& work) {
    errors_.collect(work);
  }
  template <class Work>
  void each_table(const Value& parent, std::string_view key, const Work& work) {
    attempt([&] {
      for (const Value* table : tables(parent, key)) attempt([&] { work(*table); });
    });
  }
  template <class T>
  void read_table(const Keys<T>& keys, std::string_view name, T& object) {
    if (const Value* table = find(document_, name)) {
      read(keys, *table, scene_.materials, object);
    }
  }
  void read_accuracy();
  void find_substeps();
  void add_material(const Value& table, const std::filesystem::path& folder,
                    std::set<std::string>& seen);
  void add_solid(const Value& table);
  void add_body(const Value& table);
  void add_ball(const Value& table);
  void add_solids(SolidGroup group, std::vector<Solid> solids);
  void reserve_names(const Value& parent, std::initializer_list<std::string_view> keys);
  void name_solids();
  void check_bodies(std::size_t bodies) const;
  void check_references() const;

  const Value& document_;
  std::filesystem::path folder_;  ///< Folder in which files that the document names are sought.
  Scene scene_;
  std::vector<SolidGroup> groups_;
  Names names_;
  ErrorList errors_;
};

Scene Loader::load(const LoadOptions& options) {
  const Schema& s = schema();
  attempt([&] { check_known(document_, s.top.table, {s.top.keys}); });
  const Value* scene = find(document_, "scene");
  attempt([&] {
    if (!scene) throw InputError(document_.where + ": missing table [scene]");
    read(s.scene, *scene, {}, scene_);
  });
  presets()[find_named(presets(), options.preset,
                       "--preset " + options.preset + ": unknown preset")]
      .apply(scene_);
  attempt([&] { read_accuracy(); });
  attempt([&] { read_table(s.solver, "solver", scene_.solver); });
  attempt([&] { read_table(s.limits, "limits", scene_.limits); });
  attempt([&] { read_table(s.ground, "ground", scene_.ground); });
  attempt([&] { read_view(document_, scene_); });
  attempt([&] { add_materials(document_, folder_); });
  if (const Value* ground = find(document_, "ground")) {
    each_table(*ground, "mesh",
               [&](const Value& table) { read_ground_mesh(table, folder_, scene_); });
  }
  each_table(document_, "solid", [&](const Value& table) { add_solid(table); });
  each_table(document_, "body", [&](const Value& table) { add_body(table); });
  each_table(document_, "ball", [&](const Value& table) { add_ball(table); });
  errors_.collect_keys([&] { name_solids(); });
  errors_.collect_keys([&] { check_references(); });
  attempt([&] {
    for (const Value* table : tables(document_, "joint"))
      errors_.collect_keys([&] { scene_.joints.push_back(read_joint(*table, scene_)); });
  });
  if (const Value* table = find(document_, "script"))
    attempt([&] { read_script(*table, scene_, errors_); });
  errors_.throw_any();
  find_substeps();
  if (scene_.planar) check_planar(scene_, find(*scene, "planar")->where);
  std::size_t bodies = scene_.solids.size() + scene_.balls.size() + scene_.shots.size();
  for (const Shot& shot : scene_.shots) bodies += shot.links.size();
  check_bodies(bodies);
  return std::move(scene_);
}

void Loader::check_bodies(std::size_t bodies) const {
  if (bodies <= scene_.limits.bodies) return;
  throw InputError(document_.where + ": " + std::to_string(bodies) + " bodies exceed bodies = " +
                   std::to_string(scene_.limits.bodies) + " in [limits]");
}

void Loader::read_accuracy() {
  read_table(schema().accuracy, "accuracy", scene_.accuracy);
  const Value* table = find(document_, "accuracy");
  double& dt = scene_.accuracy.dt_s;
  const double steps = std::round(kFrame_s / dt);
  if (std::abs(steps * dt - kFrame_s) > 1e-6 * kFrame_s) {
    throw InputError(
        find(*table, "dt_s")->where +
        ": dt_s in [accuracy] does not divide a frame of 1/60 s; allowed: 1/60, 1/120, "
        "1/180 and so on");
  }
  dt = kFrame_s / steps;
  if (scene_.accuracy.error_target_m <= 0) return;
  if (const Value* substeps = find(*table, "substeps")) {
    throw InputError(substeps->where +
                     ": substeps and error_target_m in [accuracy] exclude each other; remove one");
  }
}

/// Sets the number of substeps from error_target_m, if given, and from the scene's solids.
void Loader::find_substeps() {
  Accuracy& accuracy = scene_.accuracy;
  if (accuracy.error_target_m <= 0) return;
  const int wanted = substeps_for_penetration(find_stacks(scene_).deepest, scene_.gravity_W.norm(),
                                              accuracy.dt_s, accuracy.error_target_m);
  accuracy.substeps = std::min(wanted, kMaxSubsteps);
}

void read_crumbling(const Value& table, DebrisEmission& crumbling) {
  read(schema().crumbling, table, {}, crumbling);
  if (crumbling.debris_smallest_m > crumbling.debris_largest_m) {
    throw InputError(table.where + ": debris_smallest_m = " + format(crumbling.debris_smallest_m) +
                     " exceeds debris_largest_m = " + format(crumbling.debris_largest_m) +
                     " in [material.crumbling]");
  }
}

/// Adds the materials of a document to the scene; each replaces an earlier one of its name.
void Loader::add_materials(const Value& document, const std::filesystem::path& folder) {
  std::set<std::string> seen;
  ErrorList errors;
  for (const Value* table : tables(document, "material"))
    errors.collect([&] { add_material(*table, folder, seen); });
  errors.throw_any();
}

/// Adds a material. If some of its keys are wrong, a material of its name is added nevertheless, so
/// that the solids of it can be checked.
void Loader::add_material(const Value& table, const std::filesystem::path& folder,
                          std::set<std::string>& seen) {
  const Schema& s = schema();
  std::vector<Material>& all = scene_.materials;
  const auto named = [&](const std::string& name) {
    return std::find_if(all.begin(), all.end(), [&](const Material& m) { return m.name == name; });
  };
  MaterialHead head;
  Material material;
  ErrorList errors;
  errors.collect([&] {
    check_known(table, s.material.table, {s.material_head.keys, s.material.keys});
  });
  errors.collect([&] {
    read_keys(table, s.material.table, s.material_head.keys, {}, &head);
    if (!seen.insert(head.name).second)
      throw InputError(table.where + ": duplicate [[material]] '" + head.name + "'");
    const auto parent = named(head.like.empty() ? head.name : head.like);
    if (!head.like.empty()) find_material(head.like, find(table, "like")->where, all);
    if (parent != all.end()) material = *parent;
  });
  material.name = head.name;
  errors.collect([&] {
    read_keys(table, s.material.table, s.material.keys, {}, &material);
    check_strengths(table, material);
  });
  errors.collect([&] {
    if (const Value* v = find(table, "pattern")) read_pattern(*v, folder, material.pattern);
    read_stronger(table, folder, material);
  });
  errors.collect([&] {
    if (const Value* v = find(table, "crumbling")) read_crumbling(*v, material.crumbling);
  });
  for (const auto& [key, look] :
       {std::pair{"surface", &material.surface}, {"interior", &material.interior}}) {
    errors.collect([&, name = key, to = look] {
      if (const Value* v = find(table, name)) read(s.look, *v, {}, *to);
    });
  }
  const auto namesake = named(head.name);
  if (namesake != all.end()) {
    *namesake = material;
  } else if (!head.name.empty()) {
    all.push_back(material);
  }
  errors.throw_any();
}

/// Returns the solids of pieces, one for each island and copy, in the frame S of the structure.
std::vector<Solid> solids_of(std::vector<Piece> pieces) {
  std::vector<Solid> solids;
  for (Piece& piece : pieces) {
    const Compound whole = fracture::make_compound(std::move(piece.parts));
    for (const Compound& island : fracture::split_islands(whole)) {
      for (const Pose& X_SM : piece.copies)
        solids.push_back({"", island, X_SM * Pose{piece.at, Quat::Identity()}});
    }
  }
  return solids;
}

std::vector<Piece> mirrored_pieces(std::vector<Piece> pieces) {
  for (Piece& piece : pieces) {
    piece.at.x() = -piece.at.x();
    for (Pose& copy : piece.copies) {
      copy.position.x() = -copy.position.x();
      copy.rotation.y() = -copy.rotation.y();
      copy.rotation.z() = -copy.rotation.z();
    }
    for (Part& part : piece.parts) part = mirrored(std::move(part));
  }
  return pieces;
}

/// Anchors pieces to the world as the key `anchored` says.
void anchor(std::vector<Piece>& pieces, Anchored how, const Value& table,
            std::span<const Material> materials) {
  if (how == Anchored::kOwn) return;
  for (Piece& piece : pieces)
    for (Part& part : piece.parts) part.anchored = how == Anchored::kAll ? kAnchoredAllSides : 0;
  if (how == Anchored::kBottom)
    add_foundation(pieces, find_material("foundation", table.where, materials), materials);
}

void Loader::add_solid(const Value& table) {
  const Keys<SolidHead>& keys = schema().solid;
  SolidHead head;
  std::vector<Copy> copies;
  std::vector<Piece> pieces;
  ErrorList errors;
  errors.collect([&] { read_keys(table, keys.table, keys.keys, {}, &head); });
  errors.collect([&] { copies = read_copies(table, keys.table); });
  if (head.structure.empty()) errors.throw_any();
  errors.collect([&] {
    pieces = read_structure(table, keys.table, head.structure, {keys.keys, placement_keys().keys},
                            {scene_.materials, folder_, scene_.appearances, scene_.warnings});
  });
  errors.throw_any();
  std::size_t made = 0, parts = 0;
  for (const Piece& piece : pieces) {
    made += piece.copies.size();
    parts += piece.parts.size() * piece.copies.size();
  }
  check_bodies(scene_.solids.size() + made * copies.size());  // before the expensive work
  check_parts(static_cast<double>(parts * copies.size()), table);
  anchor(pieces, head.anchored, table, scene_.materials);
  const bool any_mirrored =
      std::any_of(copies.begin(), copies.end(), [](const Copy& copy) { return copy.mirrored; });
  const std::vector<Solid> mirrored_solids =
      any_mirrored ? solids_of(mirrored_pieces(pieces)) : std::vector<Solid>();
  const std::vector<Solid> upright_solids = solids_of(std::move(pieces));
  std::vector<Solid> solids;
  for (const Copy& copy : copies) {
    for (Solid solid : copy.mirrored ? mirrored_solids : upright_solids) {
      solid.X_WR = copy.X_FM * solid.X_WR;
      solid.velocity_W = copy.velocity(head.velocity);
      solid.angular_velocity_W = copy.angular_velocity(head.angular_velocity);
      solids.push_back(std::move(solid));
    }
  }
  add_solids({head.name, head.structure, table.where}, std::move(solids));
}

void Loader::add_body(const Value& table) {
  Body body = read_body(table, scene_.materials, folder_, scene_.appearances, scene_.warnings);
  add_solids({body.name, body.default_name, table.where}, std::move(body.solids));
}

void Loader::add_solids(SolidGroup group, std::vector<Solid> solids) {
  group.first = scene_.solids.size();
  group.count = solids.size();
  for (Solid& solid : solids) scene_.solids.push_back(std::move(solid));
  groups_.push_back(std::move(group));
}

void Loader::add_ball(const Value& table) {
  BallTable ball;
  read(schema().ball, table, scene_.materials, ball);
  scene_.balls.push_back(
      {ball.name, ball.radius_m, ball.material.index, ball.position, ball.velocity});
}

/// Reserves the names that are given in the arrays of tables under `keys` of `parent`.
void Loader::reserve_names(const Value& parent, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) {
    for (const Value* table : tables(parent, key)) {
      const Value* name = find(*table, "name");
      const std::string* text = name ? std::get_if<std::string>(&name->data) : nullptr;
      if (text && !text->empty()) names_.reserve(*text, name->where);
    }
  }
}

/// Names all solids; those of a table that made several get ".0", ".1" and so on appended.
void Loader::name_solids() {
  reserve_names(document_, {"solid", "body", "ball"});
  if (const Value* script = find(document_, "script")) {
    as_table(*script, "[script]");
    reserve_names(*script, {"shot", "wrecking_ball"});
  }
  for (const SolidGroup& group : groups_) {
    const std::string name =
        group.name.empty() ? names_.reserve_default(group.default_name, group.where) : group.name;
    for (std::size_t i = 0; i < group.count; ++i) {
      std::string& part = scene_.solids[group.first + i].name;
      part = group.count == 1 ? name : name + "." + std::to_string(i);
      if (group.count > 1) names_.reserve(part, group.where);
    }
  }
}

void Loader::check_references() const {
  const auto check = [&](const Value& parent, std::string_view array,
                         std::initializer_list<std::string_view> keys) {
    for (const Value* table : tables(parent, array)) {
      for (const std::string_view key : keys) {
        const Value* name = find(*table, key);
        if (name) names_.check_reference(*name);
      }
    }
  };
  check(document_, "joint", {"a", "b"});
  const Value* script = find(document_, "script");
  if (!script) return;
  check(*script, "remove", {"name"});
  check(*script, "drive", {"name"});
  check(*script, "move", {"name"});
}

void add_builtin_materials(Loader& loader) {
  loader.add_materials(parse_toml(builtin::materials_toml, "materials.toml (built in)"), {});
}

}  // namespace

std::vector<Material> builtin_materials() {
  const Value nothing;
  Loader loader(nothing, {});
  add_builtin_materials(loader);
  return loader.take_materials();
}

MaterialIndex material_named(const Scene& scene, const std::string& name) {
  return find_material(name, scene.name.empty() ? "the scene" : scene.name, scene.materials);
}

Scene parse_scene(const std::string& text, const std::string& file, const LoadOptions& options) {
  Value document = parse_toml(text, file);
  for (const std::string& assignment : options.set) set_value(document, assignment);
  Loader loader(document, std::filesystem::path(file).parent_path());
  add_builtin_materials(loader);
  Scene scene = loader.load(options);
  scene.name = std::filesystem::path(file).stem().string();
  try {
    check_scene(scene);
  } catch (const InputError& error) {
    throw InputError(file + ": " + error.what());
  }
  return scene;
}

}  // namespace sunder::scenes
