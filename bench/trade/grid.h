// The grid of points that a study has when it is given no other, compiled in (sunder_embed).
#pragma once

namespace sunder::bench::grid {

extern const char* const grid_txt;

}  // namespace sunder::bench::grid
