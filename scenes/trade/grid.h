// Default grid of points of a study, compiled in from grid.txt (sunder_embed).
#pragma once

namespace sunder::scenes::grid {

extern const char* const grid_txt;

}  // namespace sunder::scenes::grid
