// From a document to a scene. Read first: parse_scene().
#include "scenes/load.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <span>

#include "engine/base/check.h"
#include "engine/base/trigonometry.h"
#include "engine/model/checks/scene_accuracy.h"
#include "engine/model/checks/scene_check.h"
#include "scenes/file/body.h"
#include "scenes/file/builtin_materials.h"
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

constexpr double kFrame = 1.0 / 60;

/// The loader's state: the document and the scene it is becoming.
class Loader {
 public:
  Loader(const Value& document, std::filesystem::path folder)
      : document_(document), folder_(std::move(folder)) {}

  Scene load(const LoadOptions& options);
  void add_materials(const Value& document, const std::filesystem::path& folder);
  std::vector<Material> take_materials() { return std::move(scene_.materials); }

 private:
  /// The solids that a table became, from `first` on.
  struct Made {
    std::string name;   ///< Empty: none was given.
    std::string usual;  ///< In place of it.
    std::string where;
    std::size_t first = 0, count = 0;
  };

  template <class T>
  void read_table(const Keys<T>& keys, std::string_view name, T& object) {
    if (const Value* table = find(document_, name)) {
      read(keys, *table, scene_.materials, object);
    }
  }
  void read_accuracy();
  void aim();
  void add_solid(const Value& table);
  void add_body(const Value& table);
  void add_ball(const Value& table);
  void add_solids(Made made, std::vector<Solid> solids);
  void give_names(const Value& parent, std::initializer_list<std::string_view> keys);
  void name_solids();
  void check_bodies(std::size_t bodies) const;
  void check_references() const;

  const Value& document_;
  std::filesystem::path folder_;  ///< Where the files it names are sought.
  Scene scene_;
  std::vector<Made> made_;
  Names names_;
};

Scene Loader::load(const LoadOptions& options) {
  const Schema& s = schema();
  check_known(document_, s.top.table, {s.top.keys});
  const Value* scene = find(document_, "scene");
  if (!scene) throw InputError(document_.where + ": missing table [scene]");
  read(s.scene, *scene, {}, scene_);
  const Preset& preset =
      find_named(presets(), options.preset, "--preset " + options.preset + ": unknown preset");
  scene_.accuracy = preset.accuracy;
  scene_.solver.sweeps = preset.sweeps;
  read_accuracy();
  read_table(s.solver, "solver", scene_.solver);
  read_table(s.limits, "limits", scene_.limits);
  read_table(s.ground, "ground", scene_.ground);
  read_view(document_, scene_);
  add_materials(document_, folder_);
  if (const Value* ground = find(document_, "ground"))
    for (const Value* table : tables(*ground, "mesh")) read_ground_mesh(*table, folder_, scene_);
  for (const Value* table : tables(document_, "solid")) add_solid(*table);
  for (const Value* table : tables(document_, "body")) add_body(*table);
  for (const Value* table : tables(document_, "ball")) add_ball(*table);
  name_solids();
  check_references();
  for (const Value* table : tables(document_, "joint"))
    scene_.joints.push_back(read_joint(*table, scene_));
  if (const Value* table = find(document_, "script")) read_script(*table, scene_);
  aim();
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
  const double steps = std::round(kFrame / dt);
  if (std::abs(steps * dt - kFrame) > 1e-6 * kFrame) {
    throw InputError(
        find(*table, "dt_s")->where +
        ": dt_s in [accuracy] does not divide a frame of 1/60 s; allowed: 1/60, 1/120, "
        "1/180 and so on");
  }
  dt = kFrame / steps;
  if (scene_.accuracy.error_target_m <= 0) return;
  if (const Value* substeps = find(*table, "substeps")) {
    throw InputError(substeps->where +
                     ": substeps in [accuracy] is given beside error_target_m; keep one");
  }
}

/// Substeps from what is to stand, once it is known.
void Loader::aim() {
  Accuracy& accuracy = scene_.accuracy;
  if (accuracy.error_target_m <= 0) return;
  const int wanted = substeps_for_sink(stacks_in(scene_).deepest, scene_.gravity_W.norm(),
                                       accuracy.dt_s, accuracy.error_target_m);
  accuracy.substeps = std::min(wanted, kMostSubsteps);
}

void read_crumbling(const Value& table, Crumbling& crumbling) {
  read(schema().crumbling, table, {}, crumbling);
  if (crumbling.debris_smallest_m > crumbling.debris_largest_m) {
    throw InputError(table.where + ": debris_smallest_m = " + format(crumbling.debris_smallest_m) +
                     " exceeds debris_largest_m = " + format(crumbling.debris_largest_m) +
                     " in [material.crumbling]");
  }
}

/// A material of the same name is replaced: a scene may change what the library says.
void Loader::add_materials(const Value& document, const std::filesystem::path& folder) {
  const Schema& s = schema();
  std::set<std::string> seen;
  for (const Value* table : tables(document, "material")) {
    check_known(*table, s.material.table, {s.material_head.keys, s.material.keys});
    MaterialHead head;
    read_keys(*table, s.material.table, s.material_head.keys, {}, &head);
    if (!seen.insert(head.name).second) {
      throw InputError(table->where + ": a second [[material]] named '" + head.name + "'");
    }
    std::vector<Material>& all = scene_.materials;
    const auto named = [&](const std::string& name) {
      return std::find_if(all.begin(), all.end(),
                          [&](const Material& m) { return m.name == name; });
    };
    const auto parent = named(head.like.empty() ? head.name : head.like);
    if (!head.like.empty()) find_material(head.like, find(*table, "like")->where, all);
    Material material = parent == all.end() ? Material() : *parent;
    material.name = head.name;
    read_keys(*table, s.material.table, s.material.keys, {}, &material);
    check_strengths(*table, material);
    if (const Value* v = find(*table, "pattern")) read_pattern(*v, folder, material.pattern);
    read_stronger(*table, folder, material);
    if (const Value* v = find(*table, "crumbling")) read_crumbling(*v, material.crumbling);
    if (const Value* v = find(*table, "surface")) read(s.look, *v, {}, material.surface);
    if (const Value* v = find(*table, "interior")) read(s.look, *v, {}, material.interior);
    const auto namesake = named(head.name);
    if (namesake == all.end()) {
      all.push_back(material);
    } else {
      *namesake = material;
    }
  }
}

/// The solids that pieces are, in the frame of the structure.
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

/// The world holds pieces as asked for.
void anchor(std::vector<Piece>& pieces, Anchored how, const Value& table,
            std::span<const Material> materials) {
  if (how == Anchored::kBottom) {
    add_foundation(pieces, find_material("foundation", table.where, materials), materials);
  }
  for (Piece& piece : pieces) {
    for (Part& part : piece.parts) {
      if (how == Anchored::kAll) part.anchored = kAnchoredAllRound;
    }
  }
}

void Loader::add_solid(const Value& table) {
  const Keys<SolidHead>& keys = schema().solid;
  SolidHead head;
  read_keys(table, keys.table, keys.keys, {}, &head);
  const std::vector<Copy> copies = read_copies(table, keys.table);
  std::vector<Piece> pieces =
      read_structure(table, keys.table, head.structure, {keys.keys, placement_keys().keys},
                     {scene_.materials, folder_, scene_.paints, scene_.warnings});
  std::size_t made = 0, parts = 0;
  for (const Piece& piece : pieces) {
    made += piece.copies.size();
    parts += piece.parts.size() * piece.copies.size();
  }
  check_bodies(scene_.solids.size() + made * copies.size());  // before long work
  check_parts(static_cast<double>(parts * copies.size()), table);
  anchor(pieces, head.anchored, table, scene_.materials);
  const bool any_mirrored =
      std::any_of(copies.begin(), copies.end(), [](const Copy& copy) { return copy.mirrored; });
  const std::vector<Solid> twins =
      any_mirrored ? solids_of(mirrored_pieces(pieces)) : std::vector<Solid>();
  const std::vector<Solid> whole = solids_of(std::move(pieces));
  std::vector<Solid> solids;
  for (const Copy& copy : copies) {
    for (Solid solid : copy.mirrored ? twins : whole) {
      solid.X_WR = copy.X_FM * solid.X_WR;
      solid.velocity_W = copy.velocity(head.velocity);
      solid.angular_velocity_W = copy.angular_velocity(head.angular_velocity);
      solids.push_back(std::move(solid));
    }
  }
  add_solids({head.name, head.structure, table.where}, std::move(solids));
}

void Loader::add_body(const Value& table) {
  Body body = read_body(table, scene_.materials, folder_, scene_.paints, scene_.warnings);
  add_solids({body.name, body.usual, table.where}, std::move(body.solids));
}

void Loader::add_solids(Made made, std::vector<Solid> solids) {
  made.first = scene_.solids.size();
  made.count = solids.size();
  for (Solid& solid : solids) scene_.solids.push_back(std::move(solid));
  made_.push_back(std::move(made));
}

void Loader::add_ball(const Value& table) {
  BallTable ball;
  read(schema().ball, table, scene_.materials, ball);
  scene_.balls.push_back(
      {ball.name, ball.radius_m, ball.material.index, ball.position, ball.velocity});
}

/// The names that the tables of an array give, by the keys of those arrays.
void Loader::give_names(const Value& parent, std::initializer_list<std::string_view> keys) {
  for (const std::string_view key : keys) {
    for (const Value* table : tables(parent, key)) {
      const Value* name = find(*table, "name");
      const std::string* text = name ? std::get_if<std::string>(&name->data) : nullptr;
      if (text && !text->empty()) names_.give(*text, name->where);
    }
  }
}

/// What has a name keeps it; the parts of one thing are numbered.
void Loader::name_solids() {
  give_names(document_, {"solid", "body", "ball"});
  if (const Value* script = find(document_, "script")) {
    as_table(*script, "[script]");
    give_names(*script, {"shot", "wrecking_ball"});
  }
  for (const Made& made : made_) {
    const std::string name = made.name.empty() ? names_.pick(made.usual, made.where) : made.name;
    for (std::size_t i = 0; i < made.count; ++i) {
      std::string& part = scene_.solids[made.first + i].name;
      part = made.count == 1 ? name : name + "." + std::to_string(i);
      if (made.count > 1) names_.give(part, made.where);
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
