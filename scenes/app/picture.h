// A picture of solids as they lie in their rest frame.
#pragma once

#include <filesystem>
#include <span>

#include "engine/model/compound.h"

namespace sunder::app {

/// Draws solids, whose faces are marked by `paints`, moved apart by `explode` times their distance
/// from the middle, from the front and a little above, as a PNG. Throws InputError if nothing can
/// be drawn here, FileError if it cannot be written.
void draw_solids(const std::filesystem::path& file, std::span<const Compound> solids,
                 const std::vector<Material>& materials, std::vector<Paint> paints, double explode);

}  // namespace sunder::app
