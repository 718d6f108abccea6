#include "engine/io/mesh/mesh_gltf_materials.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "engine/base/trigonometry.h"

namespace sunder {
namespace {

using nlohmann::json;

constexpr const char* kTransform = "KHR_texture_transform";

}  // namespace

std::optional<Appearance> GltfMaterials::of(const json& material) {
  const json& base = data_.object(material, "pbrMetallicRoughness");
  const json& relief = data_.object(material, "normalTexture");
  if (base.empty() && relief.empty()) return std::nullopt;
  Appearance appearance;
  const UvTransform transform = uv_transform(material);
  const std::vector<double> color = data_.numbers(base, "baseColorFactor", {1, 1, 1, 1});
  appearance.color = Vec3(color[0], color[1], color[2]).cwiseMax(0).cwiseMin(1).cast<float>();
  appearance.picture = used(data_.object(base, "baseColorTexture"), transform);
  appearance.relief = used(relief, transform);
  appearance.normal_scale = static_cast<float>(data_.number(relief, "scale", 1));
  const auto share = [&](const char* name) {
    return static_cast<float>(std::clamp(data_.number(base, name, 1), 0.0, 1.0));
  };
  appearance.gloss = {share("roughnessFactor"), share("metallicFactor"),
                      used(data_.object(base, "metallicRoughnessTexture"), transform)};
  return appearance;
}

GltfMaterials::UvTransform GltfMaterials::uv_transform(const json& material) const {
  const json& base = data_.object(material, "pbrMetallicRoughness");
  for (const json* use :
       {&data_.object(base, "baseColorTexture"), &data_.object(material, "normalTexture"),
        &data_.object(base, "metallicRoughnessTexture")}) {
    if (!use->empty()) return transform_of(*use);
  }
  return UvTransform::Identity();
}

GltfMaterials::UvTransform GltfMaterials::transform_of(const json& use) const {
  const json& given = data_.object(data_.object(use, "extensions"), kTransform);
  if (given.empty()) return UvTransform::Identity();
  const std::vector<double> offset = data_.numbers(given, "offset", {0, 0});
  const std::vector<double> scale = data_.numbers(given, "scale", {1, 1});
  const double angle = data_.number(given, "rotation", 0);
  // Counter-clockwise in the image, where v points down.
  const auto [s, c] = sin_cos(std::remainder(angle, 2 * std::numbers::pi));
  UvTransform transform;
  transform << c * scale[0], s * scale[1], offset[0], -s * scale[0], c * scale[1], offset[1];
  return transform;
}

EncodedImage GltfMaterials::used(const json& use, const UvTransform& expected) {
  if (use.empty()) return nullptr;
  const json& extension = data_.object(data_.object(use, "extensions"), kTransform);
  if (data_.index(extension, "texCoord", 64, data_.index(use, "texCoord", 64, 0)) != 0)
    return nullptr;
  if (transform_of(use) != expected) {
    missing_.push_back("an image with a transform of its own");
    return nullptr;
  }
  const json& textures = data_.array(data_.document(), "textures");
  const json& texture = textures[data_.index(use, "index", textures.size())];
  if (!texture.is_object()) return nullptr;
  if (!texture.contains("source")) {
    if (texture.contains("extensions")) missing_.push_back("an image neither PNG nor JPEG");
    return nullptr;
  }
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
