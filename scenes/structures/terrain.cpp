// The structure `terrain`: a height field, with a prism under every triangle.
#include <algorithm>

#include "engine/geometry/hull.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

struct Terrain {
  HeightGrid heights_m;
  double spacing_m = 1;
  double floor_m = 1;
  MaterialRef material{"foundation", {}};
};

class TerrainBuilder {
 public:
  explicit TerrainBuilder(const Terrain& terrain) : terrain_(terrain) {
    const HeightGrid& grid = terrain.heights_m;
    bottom_ = *std::min_element(grid.values.begin(), grid.values.end()) - terrain.floor_m;
  }

  std::vector<fracture::Part> build() {
    const HeightGrid& grid = terrain_.heights_m;
    check_parts(2.0 * static_cast<double>((grid.rows() - 1) * (grid.columns - 1)));
    for (std::size_t row = 0; row + 1 < grid.rows(); ++row) {
      for (std::size_t column = 0; column + 1 < grid.columns; ++column) {
        const Vec3 near = corner(row, column), far = corner(row + 1, column + 1);
        add_prism(near, far, corner(row, column + 1));
        add_prism(near, far, corner(row + 1, column));
      }
    }
    return std::move(parts_);
  }

 private:
  /// Returns a point of the grid. Rows extend along x and columns along z, both centred.
  Vec3 corner(std::size_t row, std::size_t column) const {
    const HeightGrid& grid = terrain_.heights_m;
    const auto place = [&](std::size_t i, std::size_t count) {
      return terrain_.spacing_m * (static_cast<double>(i) - 0.5 * static_cast<double>(count - 1));
    };
    return {place(column, grid.columns), grid.at(row, column) - bottom_, place(row, grid.rows())};
  }

  void add_prism(const Vec3& a, const Vec3& b, const Vec3& c) {
    std::vector<Vec3> points = {a, b, c};
    for (const Vec3& top : {a, b, c}) points.emplace_back(top.x(), 0, top.z());
    parts_.push_back({make_hull(points), terrain_.material.index});
  }

  const Terrain& terrain_;
  double bottom_ = 0;
  std::vector<fracture::Part> parts_;
};

std::vector<Piece> build_terrain(const Terrain& terrain) {
  return {{TerrainBuilder(terrain).build(), Vec3::Zero()}};
}

}  // namespace

StructureType terrain_structure() {
  return make_structure<Terrain, build_terrain>(
      "terrain", "Ground by heights on a square grid; let anchored be all.",
      {key<&Terrain::heights_m>("heights_m", "m", Range{-1000, 1000},
                                "Rows along z, in each the heights along x.")
           .must(),
       key<&Terrain::spacing_m>("spacing_m", "m", Range{0.01, 1000}, "From height to height."),
       key<&Terrain::floor_m>("floor_m", "m", Range{0.01, 1000},
                              "Thickness under the lowest height: it stands on its foot, as all "
                              "structures."),
       key<&Terrain::material>("material", "What it is made of.")});
}

}  // namespace sunder::scenes
