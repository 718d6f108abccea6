// View modes: a frame is recoloured by properties of its parts, or exploded. The result is a frame
// and marks, so the passes do not depend on the mode.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"
#include "render/passes/marks.h"

namespace sunder::render {

inline constexpr const char* kViewModes =
    "materials | convexes | compounds | asleep | wireframe | exploded | contacts | stress | "
    "islands | broadphase";

class ViewMode {
 public:
  /// Makes a view mode by name. Throws InputError if the name is not in kViewModes.
  explicit ViewMode(const std::string& name);
  /// Returns the frame to draw, valid until the next call. Colours of bodies are constant from
  /// frame to frame. Throws InputError if the mode needs Frame::inspection and the frame has none.
  const Frame& shown(const Frame& frame);
  /// Returns the marks of the last frame.
  const MarkList& marks() const { return marks_; }
  /// Returns true if the edges of triangles are drawn in place of faces.
  bool edges() const { return kind_ == Kind::kWireframe; }
  /// Returns true if the mode needs Frame::inspection.
  bool needs_inspection() const { return kind_ >= Kind::kContacts; }

 private:
  enum class Kind {
    kMaterials,
    kConvexes,
    kCompounds,
    kAsleep,
    kWireframe,
    kExploded,
    kContacts,
    kStress,
    kIslands,
    kBroadphase
  };

  std::uint32_t color_of(const Frame& frame, std::size_t instance) const;
  void assign_colors(const Frame& frame);
  void explode();
  void add_marks(const Frame& frame);

  std::string name_;
  Kind kind_;
  Frame shown_;
  MarkList marks_;
  std::shared_ptr<const std::vector<Material>> given_materials_;
  std::shared_ptr<const std::vector<Material>> materials_;  ///< Given materials, then the palette.
};

}  // namespace sunder::render
