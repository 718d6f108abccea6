// Writes the reference of scene files from the tables that the reader uses.
#include "engine/geometry/approximate_hull.h"
#include "scenes/file/body.h"
#include "scenes/file/ground_mesh.h"
#include "scenes/file/joint.h"
#include "scenes/file/placement.h"
#include "scenes/file/schema.h"
#include "scenes/load.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

std::string show(bool given) { return given ? "true" : "false"; }
std::string show(double number) { return format(number); }
std::string show(const std::string& text) { return text.empty() ? "none" : text; }
std::string show(const MaterialRef& material) { return show(material.name); }
std::string show(const CountOrFile&) { return "automatic"; }
std::string show(const HeightGrid&) { return "none"; }
std::string show(const std::vector<Vec2>&) { return "none"; }
std::string show(const Fit& fit) { return name_of(fit); }
template <class Integer>
requires std::is_integral_v<Integer> std::string show(Integer number) {
  return std::to_string(number);
}
template <class Scalar>
std::string show(const Eigen::Matrix<Scalar, 3, 1>& v) {
  std::string text;
  for (int i = 0; i < 3; ++i) {
    text += (i == 0 ? "[" : ", ") + format(static_cast<double>(v[i]));
  }
  return text + "]";
}

/// Returns the default of a key: the value of its field in the default-constructed object `fresh`.
std::string default_of(const Key& key, void* fresh) {
  using Kind = Key::Kind;
  if (key.required) return "required";
  if (key.optional || key.kind == Kind::kTable) return "none";
  if (key.kind == Kind::kChoice) return std::string(key.choices[key.chosen(fresh)]);
  std::string text;
  use_field(key, fresh, [&](const auto& field) { text = show(field); });
  return text;
}

/// Returns the text with bars escaped, which would end the cell of a Markdown table.
std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '|') safe += '\\';
    safe += c;
  }
  return safe;
}

std::string row(const Key& key, void* fresh) {
  Key bare = key;  // without the unit, which has its own column
  bare.unit = "";
  std::string name = "`";
  name.append(key.name).append("`");
  const std::string degrees = degrees_name(key);
  if (!degrees.empty()) name.append(" or `").append(degrees).append("`");
  std::string line;
  for (const std::string& cell : {name, std::string(key.help), std::string(key.unit),
                                  default_of(key, fresh), escaped(allowed(bare))}) {
    line.append("| ").append(cell).append(" ");
  }
  return line + "|\n";
}

std::string rows(std::span<const Key> keys, void* fresh) {
  std::string text = "| key | meaning | unit | default | allowed |\n|---|---|---|---|---|\n";
  for (const Key& key : keys) text += row(key, fresh);
  return text + "\n";
}

template <class T>
std::string section(const Keys<T>& keys) {
  T fresh;
  return "### " + std::string(keys.table) + "\n\n" + rows(keys.keys, &fresh);
}

std::string preset_list() {
  std::string text = "Defaults of [accuracy] by preset:";
  for (const Preset& preset : presets()) {
    text += "\n`" + std::string(preset.name) + "` (" + std::string(preset.help) + "): dt 1/" +
            format(1 / preset.accuracy.dt_s) + " s, " + std::to_string(preset.accuracy.substeps) +
            " substeps";
    if (preset.full_detail > 0)
      text += "; in [limits], full_detail = " + std::to_string(preset.full_detail) +
              " and chip_size_factor = " + format(preset.chip_size_factor);
    text += ".";
  }
  return text + "\n\n";
}

}  // namespace

std::string key_reference() {
  const Schema& s = schema();
  std::string text = section(s.scene) + section(s.accuracy) + preset_list() + section(s.solver) +
                     section(s.limits) + section(s.ground) + section(ground_mesh_keys()) +
                     section(s.view) + section(s.view_key) + section(s.material_head) +
                     section(s.material) + section(s.pattern) + section(s.stronger) +
                     section(s.crumbling) + section(s.look) + section(s.solid) + section(s.part) +
                     section(placement_keys()) + section(repeat_keys());
  for (const StructureType& structure : structures()) {
    text += "#### structure = \"" + std::string(structure.name) + "\"\n\n" +
            std::string(structure.help) + "\n\n" +
            rows(structure.keys, structure.parameters().get());
  }
  MeshTable mesh;
  BodyTable body;
  text += "### [[body]]\n\n" + rows(mesh_keys().keys, &mesh) + rows(body_keys().keys, &body);
  return text + section(s.ball) + section(joint_keys()) + section(s.script) + section(s.shot) +
         section(s.wrecking_ball) + section(s.blast) + section(s.remove) + section(s.drive) +
         section(s.move) + section(s.move_key);
}

}  // namespace sunder::scenes
