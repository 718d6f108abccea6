// What the materials of a glTF look like.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "engine/io/mesh/mesh_gltf_data.h"

namespace sunder {

class GltfPaints {
 public:
  explicit GltfPaints(const GltfData& data) : data_(data) {}

  /// Base colour, gloss and normals, what it does not say as the format has it; none where a
  /// material says nothing of these. A picture that is not there, or uses other texture coordinates
  /// than the first, is left out.
  std::optional<Paint> of(const nlohmann::json& material);
  /// Returns the names of the pictures that were sought and are not there.
  const std::vector<std::string>& missing() const { return missing_; }

 private:
  /// What a use of a texture shows; null if that is not there, or is used otherwise.
  Picture used(const nlohmann::json& use);
  Picture picture(std::size_t image);

  const GltfData& data_;
  std::map<std::size_t, Picture> pictures_;  ///< By image.
  std::vector<std::string> missing_;
};

}  // namespace sunder
