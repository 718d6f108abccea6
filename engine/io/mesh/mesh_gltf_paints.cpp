#include "engine/io/mesh/mesh_gltf_paints.h"

namespace sunder {

using nlohmann::json;

std::optional<Paint> GltfPaints::of(const json& material) {
  const json& base = data_.object(material, "pbrMetallicRoughness");
  if (!base.contains("baseColorFactor") && !base.contains("baseColorTexture")) return std::nullopt;
  Paint paint;
  const std::vector<double> color = data_.numbers(base, "baseColorFactor", {1, 1, 1, 1});
  paint.color = Vec3(color[0], color[1], color[2]).cwiseMax(0).cwiseMin(1).cast<float>();
  const json& use = data_.object(base, "baseColorTexture");
  if (use.empty() || data_.index(use, "texCoord", 64, 0) != 0) return paint;
  const json& textures = data_.array(data_.document(), "textures");
  const json& texture = textures[data_.index(use, "index", textures.size())];
  if (!texture.is_object() || !texture.contains("source")) return paint;  // an extension's
  const json& images = data_.array(data_.document(), "images");
  paint.picture = picture(data_.index(texture, "source", images.size()));
  return paint;
}

GltfPaints::Picture GltfPaints::picture(std::size_t image) {
  const auto [entry, is_new] = pictures_.try_emplace(image);
  if (!is_new) return entry->second;
  const json& given = data_.array(data_.document(), "images")[image];
  if (!given.is_object()) return nullptr;
  std::string bytes;
  if (given.contains("bufferView")) {
    bytes = data_.view(given);
  } else if (given.contains("uri") && given["uri"].is_string()) {
    try {
      bytes = data_.load_uri(given["uri"].get<std::string>());
    } catch (const InputError&) {  // not there, or out of its folder
    }
  }
  if (bytes.empty()) return nullptr;
  const auto* begin = reinterpret_cast<const std::byte*>(bytes.data());
  entry->second = std::make_shared<const std::vector<std::byte>>(begin, begin + bytes.size());
  return entry->second;
}

}  // namespace sunder
