// Appearance of the materials of a glTF file.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "engine/io/mesh/mesh_gltf_data.h"

namespace sunder {

/// Reads materials and their images.
class GltfMaterials {
 public:
  explicit GltfMaterials(const GltfData& data) : data_(data) {}

  /// Returns base colour, roughness, metalness and normal map, with glTF's defaults; nothing if the
  /// material has neither. An image that is missing, or that uses other texture coordinates than
  /// the first, is left out.
  std::optional<Appearance> of(const nlohmann::json& material);
  /// Returns the names of missing images.
  const std::vector<std::string>& missing() const { return missing_; }

 private:
  /// Returns the image of a texture reference; null if missing or for other texture coordinates.
  EncodedImage used(const nlohmann::json& use);
  EncodedImage picture(std::size_t image);

  const GltfData& data_;
  std::map<std::size_t, EncodedImage> pictures_;  ///< By index of the image.
  std::vector<std::string> missing_;
};

}  // namespace sunder
