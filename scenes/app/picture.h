// Draws a picture of solids in their rest frame.
#pragma once

#include <filesystem>
#include <span>

#include "engine/model/compound.h"

namespace sunder::app {

/// Draws solids as a PNG, seen from the front and a little above, and moved apart by `explode`
/// times their distance from the common middle. Marks of faces are indices into `appearances` plus
/// one. Throws InputError if there is no OpenGL to draw with, FileError if the file cannot be
/// written.
void draw_solids(const std::filesystem::path& file, std::span<const Compound> solids,
                 const std::vector<Material>& materials, std::vector<Appearance> appearances,
                 double explode);

}  // namespace sunder::app
