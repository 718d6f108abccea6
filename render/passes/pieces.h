// The frame's instances on the GPU: every mesh is uploaded once, every frame only where they are.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/model/frame.h"
#include "render/gl/table.h"
#include "render/passes/blocks.h"
#include "render/passes/covered.h"
#include "render/passes/viewpoint.h"

namespace sunder::render {

class Pieces {
 public:
  explicit Pieces(const GlTable& gl);

  /// Uploads what is new of `frame` and where everything is.
  void update(const Frame& frame);
  /// Balls around the opaque pieces, relative to the eye.
  const std::vector<Caster>& casters() const { return casters_; }
  /// The pieces with surfaces of a kind; opaque ones nearest first, glass farthest first.
  enum class Group : std::uint8_t {
    kMatte,
    kPainted,  ///< Matte ones, of which a file says how they look.
    kBlocks,   ///< Matte ones that are a body each, and dressed: bricks, ashlars, parts of them.
    kShiny,
    kGlass,   ///< For each piece its back faces, then its front faces.
    kOpaque,  ///< Again all that is no glass, in no order.
    kLarge,   ///< Of the first three again those that keep light from rooms.
  };
  static constexpr int kGroups = 7;
  bool has(Group group) const { return !placed(group).empty(); }
  /// All of them.
  void draw(Group group) const;
  /// What is seen of them: what is covered by then in the picture is left out.
  void draw(Group group, CoveredTiles& covered) const;
  /// All that casts shadows, and the large ones as heights seen from above: depths alone.
  void draw_shadows(CoveredTiles& covered) const;
  void draw_heights(CoveredTiles& covered) const;

  /// Until the next update, slots have the key of their body, and 1, in place of a material.
  void name_bodies(const Frame& frame);

  GLuint slot_texture() const { return slot_texture_; }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// Of the triangles of a mesh, those for light, which have all corners; for depths, which share
  /// corners in the same place; and for the heights of large pieces, without what is small.
  enum class Faces : std::uint8_t { kLit, kDepths, kHeights };
  static constexpr int kKindsOfFaces = 3;
  struct Range {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  /// One uploaded copy of a mesh. Vertices name their slot, so a mesh drawn twice in a frame is
  /// uploaded twice.
  struct Slot {
    std::shared_ptr<const Mesh> mesh;
    std::uint32_t next_copy = kNone;
    std::array<Range, kKindsOfFaces> indices = {};
    Vec3f center = Vec3f::Zero();  ///< Of a box around the vertices, in the mesh's coordinates.
    Vec3f half_extent = Vec3f::Zero();
    BlockSides sides = {};
    bool painted = false;
  };
  /// The copies of a mesh, and the first that this frame does not use yet.
  struct Copies {
    std::uint32_t first = kNone;
    std::uint32_t unused = kNone;
    std::uint64_t frame = 0;
  };
  struct Placed {
    float distance;          ///< Along the view.
    std::uint32_t instance;  ///< Decides ties, as slots depend on what was drawn before.
  };

  void assign_slots(const Frame& frame);
  std::uint32_t find_slot(std::uint32_t mesh_index, const std::shared_ptr<const Mesh>& mesh);
  void forget();
  bool upload_new();
  void place(const Frame& frame);
  const std::vector<std::uint32_t>& placed(Group group) const {
    return placed_[static_cast<std::size_t>(group)];
  }
  void draw_seen(Group group, Faces faces, CoveredTiles& covered) const;
  void leave_out_hidden(std::vector<std::uint32_t>& instances, const CoveredTiles& covered) const;
  void draw(const std::vector<std::uint32_t>& instances, Faces faces) const;

  const GlTable& gl_;
  GLuint vertex_array_ = 0;
  GLuint vertex_buffer_ = 0;
  GLuint index_buffer_ = 0;
  GLuint slot_buffer_ = 0;
  GLuint slot_texture_ = 0;

  std::vector<Slot> slots_;
  std::vector<Copies> copies_;  ///< By mesh index.
  std::size_t uploaded_slots_ = 0;
  std::size_t vertices_ = 0;  ///< Uploaded.
  std::size_t indices_ = 0;
  std::size_t vertex_room_ = 0;
  std::size_t index_room_ = 0;

  std::uint64_t frame_number_ = 0;
  std::vector<std::uint32_t> slot_of_instance_;
  std::vector<float> slot_texels_;
  std::vector<Caster> casters_;
  std::vector<TurnedBox> boxes_;                            ///< Of each instance.
  std::array<std::vector<std::uint32_t>, kGroups> placed_;  ///< Instances, in order.
};

}  // namespace sunder::render
