// Generated hills: smooth random heights on a grid.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace sunder::scenes {

struct Hills {
  std::size_t rows = 2, columns = 2;  ///< Size of the grid.
  double spacing_m = 1;               ///< Distance of neighbouring grid points.
  double height_m = 2;   ///< Approximate height of the highest top over the lowest valley.
  double length_m = 10;  ///< Approximate distance of neighbouring tops.
  std::uint64_t seed = 1;
};

/// Returns heights in m, row by row, centred on 0: gradient noise (Perlin 2002) in three octaves.
std::vector<double> make_hills(const Hills& hills);

}  // namespace sunder::scenes
