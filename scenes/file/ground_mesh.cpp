// Read first: read_ground_mesh().
#include "scenes/file/ground_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>

#include "engine/base/check.h"
#include "engine/geometry/repair/clean.h"
#include "engine/geometry/triangulate.h"
#include "scenes/file/error_list.h"
#include "scenes/file/mesh_solid.h"
#include "scenes/file/placement.h"
#include "scenes/sculpture/hills.h"

namespace sunder::scenes {
namespace {

constexpr std::size_t kMostTriangles = 1000000;
constexpr double kMaxCoordinate_m = 1e6;
constexpr const char* kGroundName = "[ground]";

Keys<GroundMeshTable> make_keys() {
  return {
      "[[ground.mesh]]",
      {key<&GroundMeshTable::mesh>("mesh",
                                   "A file (.obj .ply .stl .off .gltf .glb), relative to the "
                                   "folder of the scene, in its own coordinates; or:"),
       key<&GroundMeshTable::scale>("scale", "", Range{1e-6, 1e6},
                                    "Length of one unit of the file."),
       key<&GroundMeshTable::heights_m>("heights_m", "m", Range{-10000, 10000},
                                        "Rows along z of heights along x, about the middle; or:"),
       key<&GroundMeshTable::hills_m>(
           "hills_m", "m", Range{0, 1000},
           "Generated hills: approximate height of the highest top above the lowest valley."),
       key<&GroundMeshTable::hill_length_m>("hill_length_m", "m", Range{0.01, 10000},
                                            "hills_m: approximate distance between tops."),
       key<&GroundMeshTable::width_m>("width_m", "m", Range{0.01, 10000},
                                      "hills_m: extent along x."),
       key<&GroundMeshTable::depth_m>("depth_m", "m", Range{0.01, 10000},
                                      "hills_m: extent along z."),
       key<&GroundMeshTable::seed>("seed", "", Range{0, 9e15}, "hills_m: seed of the shape."),
       key<&GroundMeshTable::spacing_m>("spacing_m", "m", Range{0.01, 1000},
                                        "heights_m, hills_m: distance between heights."),
       key<&GroundMeshTable::material>("material",
                                       "Material of friction, restitution and appearance; by "
                                       "default those of [ground] and [view].")}};
}

void check_count(double triangles, const Value& table) {
  if (triangles <= static_cast<double>(kMostTriangles)) return;
  throw InputError(table.where + ": [[ground.mesh]] has " + format(std::round(triangles)) +
                   " triangles; allowed: at most " + std::to_string(kMostTriangles) +
                   "; increase spacing_m, reduce its size, or simplify the mesh");
}

/// Returns a mesh of a height grid, each cell of which is split along the lower diagonal.
GroundMesh mesh_of(const HeightGrid& grid, double spacing_m) {
  GroundMesh mesh;
  const auto place = [&](std::size_t i, std::size_t count) {
    return spacing_m * (static_cast<double>(i) - 0.5 * static_cast<double>(count - 1));
  };
  for (std::size_t row = 0; row < grid.rows(); ++row)
    for (std::size_t column = 0; column < grid.columns; ++column)
      mesh.vertices_W.emplace_back(place(column, grid.columns), grid.at(row, column),
                                   place(row, grid.rows()));
  for (std::size_t row = 0; row + 1 < grid.rows(); ++row) {
    for (std::size_t column = 0; column + 1 < grid.columns; ++column) {
      const auto at = [&](std::size_t down, std::size_t right) {
        return static_cast<std::uint32_t>((row + down) * grid.columns + column + right);
      };
      const bool falling = grid.at(row, column) + grid.at(row + 1, column + 1) <=
                           grid.at(row, column + 1) + grid.at(row + 1, column);
      if (falling) {
        mesh.triangles.push_back({at(0, 0), at(1, 0), at(1, 1)});
        mesh.triangles.push_back({at(0, 0), at(1, 1), at(0, 1)});
      } else {
        mesh.triangles.push_back({at(0, 0), at(1, 0), at(0, 1)});
        mesh.triangles.push_back({at(0, 1), at(1, 0), at(1, 1)});
      }
    }
  }
  return mesh;
}

HeightGrid hills_of(const GroundMeshTable& given, const Value& table) {
  const auto count = [&](double length_m) {
    return static_cast<std::size_t>(std::max(1.0, std::round(length_m / given.spacing_m))) + 1;
  };
  check_count(2 * given.width_m * given.depth_m / (given.spacing_m * given.spacing_m), table);
  HeightGrid grid;
  grid.columns = count(given.width_m);
  grid.values = make_hills({count(given.depth_m), grid.columns, given.spacing_m, *given.hills_m,
                            given.hill_length_m, given.seed});
  return grid;
}

/// Returns the triangles of the polygons in a file, with vertices at one position merged.
GroundMesh mesh_of(const std::string& file, double scale, const Value& table) {
  RawMesh raw = make_raw_mesh(file);
  join_identical(raw);
  drop_degenerate(raw);
  check_count(
      static_cast<double>(raw.corners.size()) - 2 * static_cast<double>(raw.polygons.size()),
      table);
  GroundMesh mesh;
  mesh.vertices_W = raw.vertices;
  for (Vec3& vertex : mesh.vertices_W) vertex *= scale;
  std::vector<Vec3> contour;
  for (std::size_t p = 0; p < raw.polygons.size(); ++p) {
    const auto corners = raw.polygon_corners(p);
    contour.clear();
    for (const std::uint32_t corner : corners) contour.push_back(mesh.vertices_W[corner]);
    for (const Triangle& triangle : triangulate(contour))
      mesh.triangles.push_back({corners[triangle[0]], corners[triangle[1]], corners[triangle[2]]});
  }
  return mesh;
}

/// Removes degenerate triangles, whose doubled area is at most 1e-6 of their longest side squared.
void drop_degenerate_triangles(GroundMesh& mesh) {
  std::erase_if(mesh.triangles, [&](const Triangle& t) {
    const Vec3 &a = mesh.vertices_W[t[0]], &b = mesh.vertices_W[t[1]], &c = mesh.vertices_W[t[2]];
    const double longest =
        std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
    return !((b - a).cross(c - a).norm() > 1e-6 * longest);
  });
}

/// Throws InputError if two triangles at an edge, and no others, have opposite orientations.
void check_orientation(const GroundMesh& mesh, const Value& table) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, std::array<std::uint32_t, 2>> edges;
  for (const Triangle& t : mesh.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t from = t[i], to = t[(i + 1) % 3];
      ++edges[std::minmax(from, to)][from < to ? 0 : 1];
    }
  }
  for (const auto& [edge, uses] : edges) {
    if (uses[0] + uses[1] != 2 || uses[0] == uses[1]) continue;
    const Vec3 at = 0.5 * (mesh.vertices_W[edge.first] + mesh.vertices_W[edge.second]);
    throw InputError(table.where + ": two neighbouring triangles of [[ground.mesh]] at [" +
                     format(at.x()) + ", " + format(at.y()) + ", " + format(at.z()) +
                     "] have opposite orientations; reverse one of them: bodies collide with the "
                     "side from which the vertices are counter-clockwise");
  }
}

GroundMesh make_mesh(const GroundMeshTable& given, const Value& table,
                     const std::filesystem::path& folder) {
  const int sources = (given.mesh ? 1 : 0) + (given.heights_m ? 1 : 0) + (given.hills_m ? 1 : 0);
  if (sources != 1) {
    throw InputError(table.where + ": [[ground.mesh]] has " +
                     (sources == 0 ? "none" : "more than one") +
                     " of mesh, heights_m and hills_m; give exactly one");
  }
  if (given.heights_m) return mesh_of(*given.heights_m, given.spacing_m);
  if (given.hills_m) return mesh_of(hills_of(given, table), given.spacing_m);
  const bool built_in = is_built_in(*given.mesh);
  try {
    return mesh_of(built_in ? *given.mesh : (folder / *given.mesh).string(), given.scale, table);
  } catch (const InputError& error) {
    const std::string message = error.what();
    throw InputError(message.starts_with(table.where) ? message : table.where + ": " + message);
  }
}

/// Returns the material of ground meshes that name none. The first call appends it to the scene,
/// with friction and restitution from [ground] and colour from [view].
MaterialIndex ground_material(Scene& scene) {
  const auto named = std::ranges::find(scene.materials, kGroundName, &Material::name);
  if (named != scene.materials.end())
    return MaterialIndex(static_cast<std::size_t>(named - scene.materials.begin()));
  Material& material = scene.materials.emplace_back();
  material.name = kGroundName;
  material.friction = scene.ground.friction;
  material.restitution = scene.ground.restitution;
  material.surface.color = material.interior.color = scene.view.ground_color;
  return MaterialIndex(scene.materials.size() - 1);
}

}  // namespace

const Keys<GroundMeshTable>& ground_mesh_keys() {
  static const Keys<GroundMeshTable> kKeys = make_keys();
  return kKeys;
}

void read_ground_mesh(const Value& table, const std::filesystem::path& folder, Scene& scene) {
  const Keys<GroundMeshTable>& keys = ground_mesh_keys();
  GroundMeshTable given;
  std::vector<Copy> copies;
  ErrorList errors;
  errors.collect([&] { check_known(table, keys.table, {keys.keys, placement_keys().keys}); });
  errors.collect([&] { read_keys(table, keys.table, keys.keys, {}, &given); });
  errors.collect([&] { copies = read_copies(table, keys.table); });
  errors.throw_any();
  GroundMesh model = make_mesh(given, table, folder);
  drop_degenerate_triangles(model);
  if (model.triangles.empty())
    throw InputError(table.where + ": [[ground.mesh]] has no triangle with an area above 0");
  check_orientation(model, table);
  check_count(static_cast<double>(model.triangles.size() * copies.size()), table);
  const Value* material = find(table, "material");
  model.material = given.material ? find_material(*given.material, material->where, scene.materials)
                                  : ground_material(scene);
  for (const Copy& copy : copies) {
    GroundMesh mesh = model;
    for (Vec3& vertex : mesh.vertices_W) {
      if (copy.mirrored) vertex.x() = -vertex.x();
      vertex = copy.X_FM * vertex;
      if (vertex.cwiseAbs().maxCoeff() <= kMaxCoordinate_m) continue;
      throw InputError(table.where + ": [[ground.mesh]] has a coordinate beyond " +
                       format(kMaxCoordinate_m) + " m; reduce its scale, or move it");
    }
    if (copy.mirrored)
      for (Triangle& triangle : mesh.triangles) std::swap(triangle[1], triangle[2]);
    scene.ground.meshes.push_back(std::move(mesh));
  }
}

}  // namespace sunder::scenes
