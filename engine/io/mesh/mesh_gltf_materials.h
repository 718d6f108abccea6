// Appearance of the materials of a glTF file.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include "engine/io/mesh/mesh_gltf_data.h"

namespace sunder {

/// Reads materials and their images.
class GltfMaterials {
 public:
  explicit GltfMaterials(const GltfData& data) : data_(data) {}

  /// An affine transform of texture coordinates: 2 rows of the factors of u, v and 1.
  using UvTransform = Eigen::Matrix<double, 2, 3>;

  /// Returns base colour, roughness, metalness and normal map, with glTF's defaults; nothing if the
  /// material has neither. An image that is missing, that uses other texture coordinates than the
  /// first, or that has another transform than uv_transform(), is left out.
  std::optional<Appearance> of(const nlohmann::json& material);
  /// Returns the transform (KHR_texture_transform) of the first image of a material: of its base
  /// colour, normals or gloss.
  UvTransform uv_transform(const nlohmann::json& material) const;
  /// Returns the names of missing images, and of what else was left out.
  const std::vector<std::string>& missing() const { return missing_; }

 private:
  /// Returns the image of a texture reference; null if missing, or for other texture coordinates or
  /// another transform than `expected`.
  EncodedImage used(const nlohmann::json& use, const UvTransform& expected);
  UvTransform transform_of(const nlohmann::json& use) const;
  EncodedImage picture(std::size_t image);

  const GltfData& data_;
  std::map<std::size_t, EncodedImage> pictures_;  ///< By index of the image.
  std::vector<std::string> missing_;
};

}  // namespace sunder
