// Other ways to look at a frame: coloured by what its parts are, or moved apart. A frame comes in
// and a frame goes out, so passes know nothing of it.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "engine/model/frame.h"

namespace sunder::render {

inline constexpr const char* kViewModes =
    "materials | convexes | compounds | asleep | wireframe | exploded";

class ViewMode {
 public:
  /// Throws InputError for what is not in kViewModes.
  explicit ViewMode(const std::string& name);
  /// What is to be drawn of the frame; valid until the next. Colours stay from frame to frame.
  const Frame& shown(const Frame& frame);
  /// Whether the edges of triangles are drawn in place of faces.
  bool edges() const { return kind_ == Kind::kWireframe; }

 private:
  enum class Kind { kMaterials, kConvexes, kCompounds, kAsleep, kWireframe, kExploded };

  std::uint32_t color_of(const Instance& instance, const FrameBody& body) const;
  MeshIndex colored(const std::shared_ptr<const Mesh>& mesh, MaterialIndex material);
  void color(const Frame& frame);
  void move_apart();

  Kind kind_;
  Frame shown_;
  MeshStore meshes_;
  std::map<std::pair<std::shared_ptr<const Mesh>, std::uint32_t>, MeshIndex> colored_;
  std::shared_ptr<const std::vector<Material>> given_materials_;
  std::shared_ptr<const std::vector<Material>> materials_;  ///< Those, and the colours.
};

}  // namespace sunder::render
