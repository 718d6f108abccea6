#include "engine/io/scene_export/run_materials.h"

#include <string>

namespace sunder {

std::vector<Model::Material> materials_of_run(const Frame& frame) {
  std::vector<Model::Material> made;
  for (const Material& material : *frame.materials) {
    const auto add = [&](const std::string& name, const Look& look) {
      Appearance appearance{look.color, nullptr};
      if (look.texture == Texture::kMetal)
        appearance.gloss = MetallicRoughness{0.5f, 0.5f, nullptr};
      if (look.texture == Texture::kGlass) appearance.gloss = MetallicRoughness{0.05f, 0, nullptr};
      made.push_back({name, appearance});
    };
    add(material.name, material.surface);
    add(material.name + " inside", material.interior);
  }
  if (frame.appearances) {
    for (std::size_t a = 0; a < frame.appearances->size(); ++a)
      made.push_back({"appearance " + std::to_string(a + 1), (*frame.appearances)[a]});
  }
  made.push_back({"ground", {frame.view.ground_color, nullptr}});
  return made;
}

std::size_t material_of_look(std::uint32_t look, MaterialIndex material, const Frame& frame) {
  if (look >= Mesh::kFirstAppearance)
    return 2 * frame.materials->size() + look - Mesh::kFirstAppearance;
  return 2 * std::size_t{material.value} + (look == Mesh::kInterior ? 1 : 0);
}

}  // namespace sunder
