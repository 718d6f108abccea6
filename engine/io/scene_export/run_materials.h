// The materials of an exported run.
#pragma once

#include <cstddef>
#include <vector>

#include "engine/io/mesh/export_model.h"
#include "engine/model/frame.h"

namespace sunder {

/// Returns the materials of a run's files: two for each material of the frame, its surface and its
/// interior, then those of appearances, then that of the ground. Metal and glass have their gloss.
std::vector<Model::Material> materials_of_run(const Frame& frame);
/// Returns the index in materials_of_run() of faces (Mesh::Vertex::look) of a material.
std::size_t material_of_look(std::uint32_t look, MaterialIndex material, const Frame& frame);

}  // namespace sunder
