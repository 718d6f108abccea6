// Drawing of the instances of a frame: a mesh is uploaded once, its transform in every frame.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include "engine/model/frame.h"
#include "render/gl/table.h"
#include "render/passes/blocks.h"
#include "render/passes/depth_tiles.h"
#include "render/passes/viewpoint.h"

namespace sunder::render {

class Pieces {
 public:
  explicit Pieces(const GlTable& gl);

  /// Uploads the new meshes of `frame` and the transforms of all instances.
  void update(const Frame& frame);
  /// Returns bounding spheres of the opaque pieces, relative to the eye.
  const std::vector<Caster>& casters() const { return casters_; }
  /// Groups of pieces by kind of surface: opaque ones nearest first, glass farthest first.
  enum class Group : std::uint8_t {
    kMatte,
    kTextured,  ///< Matte pieces with the appearance of a mesh file.
    kBlocks,    ///< Plastered pieces that are a body each: bricks, ashlars and parts of them.
    kShiny,
    kGlass,   ///< Drawn for each piece as back faces, then front faces.
    kOpaque,  ///< All pieces but glass, unordered, in addition to the groups above.
    kLarge,   ///< Large matte pieces and blocks, in addition: they occlude light from the sky.
  };
  static constexpr int kGroups = 7;
  bool has(Group group) const { return !placed(group).empty(); }
  /// Draws all pieces of a group.
  void draw(Group group) const;
  /// Draws the pieces of a group that are not hidden by what was drawn before.
  void draw(Group group, DepthTiles& depth_tiles) const;
  /// Draw depths alone: of all shadow casters, and of large pieces as heights seen from above.
  void draw_shadows(DepthTiles& depth_tiles) const;
  void draw_heights(DepthTiles& depth_tiles) const;

  /// Writes body key + 1 in place of the material to the slots, until the next update().
  void write_body_ids(const Frame& frame);

  GLuint slot_texture() const { return slot_texture_; }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  /// Index lists of a mesh: for shading, with all vertices; for depths, with vertices at the same
  /// position merged; for heights of large pieces, with small details merged.
  enum class Faces : std::uint8_t { kLit, kDepths, kHeights };
  static constexpr int kKindsOfFaces = 3;
  struct Range {
    std::uint32_t first = 0;
    std::uint32_t count = 0;
  };

  /// An uploaded copy of a mesh, one for each instance in a frame: vertices contain their slot
  /// index.
  struct Slot {
    std::shared_ptr<const Mesh> mesh;
    std::uint32_t next_copy = kNone;
    std::array<Range, kKindsOfFaces> indices = {};
    Vec3f center = Vec3f::Zero();  ///< Centre of the bounding box, in coordinates of the mesh.
    Vec3f half_extent = Vec3f::Zero();
    BlockSides sides = {};
    bool textured = false;
  };
  /// The linked list of copies of a mesh, and the first copy that this frame does not use yet.
  struct Copies {
    std::uint32_t first = kNone;
    std::uint32_t unused = kNone;
    std::uint64_t frame = 0;
  };
  struct Placed {
    float distance;          ///< Distance along the view.
    std::uint32_t instance;  ///< Breaks ties, because slots depend on earlier frames.
  };

  void assign_slots(const Frame& frame);
  std::uint32_t find_slot(std::uint32_t mesh_index, const std::shared_ptr<const Mesh>& mesh);
  void clear_uploads();
  bool upload_new();
  void update_transforms(const Frame& frame);
  const std::vector<std::uint32_t>& placed(Group group) const {
    return placed_[static_cast<std::size_t>(group)];
  }
  void draw_unoccluded(Group group, Faces faces, DepthTiles& depth_tiles) const;
  void remove_occluded(std::vector<std::uint32_t>& instances, const DepthTiles& depth_tiles) const;
  void draw(const std::vector<std::uint32_t>& instances, Faces faces) const;

  const GlTable& gl_;
  GLuint vertex_array_ = 0;
  GLuint vertex_buffer_ = 0;
  GLuint index_buffer_ = 0;
  GLuint slot_buffer_ = 0;
  GLuint slot_texture_ = 0;

  std::vector<Slot> slots_;
  std::vector<Copies> copies_;  ///< Copies by mesh index.
  std::size_t uploaded_slots_ = 0;
  std::size_t vertices_ = 0;  ///< Number of uploaded vertices.
  std::size_t indices_ = 0;   ///< Number of uploaded indices.
  std::size_t vertex_capacity_ = 0;
  std::size_t index_capacity_ = 0;

  std::uint64_t frame_number_ = 0;
  std::vector<std::uint32_t> slot_of_instance_;
  std::vector<float> slot_texels_;
  std::vector<Caster> casters_;
  std::vector<OrientedBox> boxes_;                          ///< Box of each instance.
  std::array<std::vector<std::uint32_t>, kGroups> placed_;  ///< Instances of each group, in order.
};

}  // namespace sunder::render
