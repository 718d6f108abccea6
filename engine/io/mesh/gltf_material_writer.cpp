#include "engine/io/mesh/gltf_material_writer.h"

#include <algorithm>

#include <nlohmann/json.hpp>

namespace sunder {

using nlohmann::json;

json GltfMaterialWriter::describe(const Model::Material& material) {
  const Appearance& look = material.look;
  const Vec3f& c = look.color;
  json base = {{"baseColorFactor", {c.x(), c.y(), c.z(), 1.0}},
               {"metallicFactor", look.gloss ? double{look.gloss->metallic} : 0.0},
               {"roughnessFactor", look.gloss ? double{look.gloss->roughness} : 0.9}};
  if (look.picture) base["baseColorTexture"] = use(look.picture);
  if (look.gloss && look.gloss->picture) {
    base["metallicRoughnessTexture"] = use(look.gloss->picture);
  }
  json described = {{"name", material.name}, {"pbrMetallicRoughness", std::move(base)}};
  if (look.relief) {
    described["normalTexture"] = use(look.relief);
    described["normalTexture"]["scale"] = look.normal_scale;
  }
  return described;
}

/// Returns a reference to the texture of an image.
json GltfMaterialWriter::use(const EncodedImage& picture) {
  const auto known = std::find(pictures_.begin(), pictures_.end(), picture);
  const auto number = static_cast<std::size_t>(known - pictures_.begin());
  if (known == pictures_.end()) pictures_.push_back(picture);
  return {{"index", number}};
}

void GltfMaterialWriter::add_images(json& document, std::size_t first_view) const {
  for (std::size_t i = 0; i < pictures_.size(); ++i) {
    const bool is_png = !pictures_[i]->empty() && pictures_[i]->front() == std::byte{0x89};
    document["textures"].push_back({{"source", i}});
    document["images"].push_back(
        {{"bufferView", first_view + i}, {"mimeType", is_png ? "image/png" : "image/jpeg"}});
  }
}

}  // namespace sunder
