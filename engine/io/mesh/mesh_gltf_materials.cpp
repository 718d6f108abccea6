#include "engine/io/mesh/mesh_gltf_materials.h"

#include <algorithm>

namespace sunder {

using nlohmann::json;

std::optional<Appearance> GltfMaterials::of(const json& material) {
  const json& base = data_.object(material, "pbrMetallicRoughness");
  const json& relief = data_.object(material, "normalTexture");
  if (base.empty() && relief.empty()) return std::nullopt;
  Appearance appearance;
  const std::vector<double> color = data_.numbers(base, "baseColorFactor", {1, 1, 1, 1});
  appearance.color = Vec3(color[0], color[1], color[2]).cwiseMax(0).cwiseMin(1).cast<float>();
  appearance.picture = used(data_.object(base, "baseColorTexture"));
  appearance.relief = used(relief);
  appearance.normal_scale = static_cast<float>(data_.number(relief, "scale", 1));
  const auto share = [&](const char* name) {
    return static_cast<float>(std::clamp(data_.number(base, name, 1), 0.0, 1.0));
  };
  appearance.gloss = {share("roughnessFactor"), share("metallicFactor"),
                      used(data_.object(base, "metallicRoughnessTexture"))};
  return appearance;
}

EncodedImage GltfMaterials::used(const json& use) {
  if (use.empty() || data_.index(use, "texCoord", 64, 0) != 0) return nullptr;
  const json& textures = data_.array(data_.document(), "textures");
  const json& texture = textures[data_.index(use, "index", textures.size())];
  // source of an extension
  if (!texture.is_object() || !texture.contains("source")) return nullptr;
  const json& images = data_.array(data_.document(), "images");
  return picture(data_.index(texture, "source", images.size()));
}

EncodedImage GltfMaterials::picture(std::size_t image) {
  const auto [entry, is_new] = pictures_.try_emplace(image);
  if (!is_new) return entry->second;
  const json& given = data_.array(data_.document(), "images")[image];
  if (!given.is_object()) return nullptr;
  std::string bytes;
  if (given.contains("bufferView")) {
    bytes = data_.view(given);
  } else if (given.contains("uri") && given["uri"].is_string()) {
    const auto uri = given["uri"].get<std::string>();
    try {
      bytes = data_.load_uri(uri);
    } catch (const InputError&) {  // missing, or outside the folder
      missing_.push_back(uri.starts_with("data:") ? "one within it" : uri);
    }
  }
  if (bytes.empty()) return nullptr;
  const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
  entry->second = std::make_shared<const std::vector<std::byte>>(begin, begin + bytes.size());
  return entry->second;
}

}  // namespace sunder
