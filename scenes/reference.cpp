// The reference of scene files, written by the reader's own tables.
#include "scenes/load.h"
#include "scenes/schema.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

template <class T>
std::string section(const Keys<T>& keys) {
  T fresh;
  std::string title(keys.table);
  return "### " + title + "\n\n" + reference_rows(keys.keys, &fresh) + "\n";
}

}  // namespace

std::string key_reference() {
  const Schema& s = schema();
  std::string text = section(s.scene) + section(s.accuracy);
  text += "Without [accuracy], the preset decides:";
  for (const Preset& preset : presets()) {
    text += " `" + std::string(preset.name) + "` (1/" +
            std::to_string(static_cast<int>(1 / preset.accuracy.dt_s + 0.5)) + " s, " +
            std::to_string(preset.accuracy.substeps) + " substeps; " + std::string(preset.help) +
            ")";
  }
  text += ".\n\n" + section(s.limits) + section(s.ground) + section(s.view);
  text += section(s.material_head) + section(s.material) + section(s.pattern) + section(s.look);
  text += section(s.solid);
  for (const Structure& structure : structures()) {
    text += "#### structure = \"" + std::string(structure.name) + "\"\n\n" +
            std::string(structure.help) + "\n\n" +
            reference_rows(structure.keys, structure.parameters().get()) + "\n";
  }
  return text + section(s.ball) + section(s.script) + section(s.shot);
}

}  // namespace sunder::scenes
