// Materials, textures and images of a glTF document that is written.
#pragma once

#include <cstddef>
#include <vector>

#include <nlohmann/json_fwd.hpp>

#include "engine/io/mesh/export_model.h"

namespace sunder {

/// Describes materials for glTF. Each image is written once, unchanged, in a buffer view of its
/// own.
class GltfMaterialWriter {
 public:
  /// Returns the description of a material: base colour, textures, gloss, normals. A height map
  /// becomes the normal texture, though glTF has no height maps.
  nlohmann::json describe(const Model::Material& material);
  /// Returns the images in the order of their views.
  const std::vector<EncodedImage>& pictures() const { return pictures_; }
  /// Adds "textures" and "images" to a document, if there are any. The view of image i is
  /// `first_view` + i.
  void add_images(nlohmann::json& document, std::size_t first_view) const;

 private:
  nlohmann::json use(const EncodedImage& picture);

  std::vector<EncodedImage> pictures_;
};

}  // namespace sunder
