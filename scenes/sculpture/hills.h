// Hills made up: heights that roll smoothly, as long as they are wide.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sunder::scenes {

struct Hills {
  std::size_t rows = 2, columns = 2;  ///< Of heights.
  double spacing_m = 1;               ///< From height to height.
  double height_m = 2;                ///< From the lowest valley to the highest top, about.
  double length_m = 10;               ///< From top to top, about.
  std::uint64_t seed = 1;
};

/// Heights row after row, about 0: gradient noise (Perlin 2002) in three octaves.
std::vector<double> make_hills(const Hills& hills);

}  // namespace sunder::scenes
