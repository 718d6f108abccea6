// Debris of an exported run, as instances of one mesh for glTF.
#pragma once

#include <cstdint>
#include <vector>

#include "engine/io/scene_export/gltf_buffers.h"
#include "engine/model/frame.h"

namespace sunder {

/// The debris of one frame that has one material, as attributes of EXT_mesh_gpu_instancing.
struct ChipGroup {
  MaterialIndex material;
  GltfBuffers::Accessor translations = 0, rotations = 0, scales = 0;
};

/// The debris of a frame, which is shown until the next element's frame.
struct ChipFrame {
  std::uint32_t begin = 0;
  std::vector<ChipGroup> groups;
};

/// Scale of the nodes of debris. Instances are larger by it, so that a reader that does not know
/// instances shows one grain of dust in place of the debris.
inline constexpr float kChipNodeScale = 1e-3f;

/// Returns an irregular solid of eight faces in a sphere of radius 1.
Mesh make_chip();

/// Writes the debris of a frame, by material.
ChipFrame add_chips(std::uint32_t number, const std::vector<FrameDebris>& debris,
                    GltfBuffers& buffers);

}  // namespace sunder
