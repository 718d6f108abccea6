// Other ways to look at a frame: coloured by what its parts are or go through, or moved apart. A
// frame comes in, a frame and some marks go out, so passes know nothing of it.
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
  /// Throws InputError for what is not in kViewModes.
  explicit ViewMode(const std::string& name);
  /// What is to be drawn of the frame; valid until the next. Colours stay from frame to frame.
  /// Throws InputError if it looks inside, and the frame does not say what happens there.
  const Frame& shown(const Frame& frame);
  /// What is pointed out in the frame that was shown last.
  const MarkList& marks() const { return marks_; }
  /// Whether the edges of triangles are drawn in place of faces.
  bool edges() const { return kind_ == Kind::kWireframe; }
  /// Whether it needs Frame::inspection.
  bool looks_inside() const { return kind_ >= Kind::kContacts; }

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
  void color(const Frame& frame);
  void move_apart();
  void mark(const Frame& frame);

  std::string name_;
  Kind kind_;
  Frame shown_;
  MarkList marks_;
  std::shared_ptr<const std::vector<Material>> given_materials_;
  std::shared_ptr<const std::vector<Material>> materials_;  ///< Those, and the colours.
};

}  // namespace sunder::render
