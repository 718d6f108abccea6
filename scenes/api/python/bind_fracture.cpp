// Breaks a solid into pieces, without a world.
#include <algorithm>

#include "engine/base/check.h"
#include "engine/geometry/triangulate_face.h"
#include "engine/io/mesh/export_model.h"
#include "engine/io/statistics.h"
#include "scenes/api/python/bindings.h"
#include "scenes/file/make_compound.h"
#include "scenes/file/mesh_solid.h"
#include "scenes/solid_break.h"

namespace sunder::python {
namespace {

/// The outer surface of a piece as triangles.
struct PieceSurface {
  std::vector<Vec3> vertices;
  std::vector<std::array<std::uint32_t, 3>> triangles;
  std::vector<std::uint8_t> is_inside;  ///< For each triangle: 1 if a break made it.
};

struct Piece {
  std::shared_ptr<const PieceSurface> surface;
  MassProperties mass;  ///< At unit density.
  Compound compound;
};

/// Returns the triangles of the shells of a piece, with the vertices that they have.
PieceSurface surface_of(const std::vector<Model::Shell>& shells) {
  constexpr std::uint32_t kUnused = ~std::uint32_t{0};
  PieceSurface surface;
  for (const Model::Shell& shell : shells) {
    const PolygonMesh& mesh = *shell.mesh;
    std::vector<std::uint32_t> number(mesh.vertices.size(), kUnused);
    for (std::size_t f = 0; f < mesh.faces.size(); ++f) {
      for (const Triangle& corners : triangulate(mesh, f)) {
        std::array<std::uint32_t, 3> triangle;
        for (std::size_t i = 0; i < 3; ++i) {
          const std::uint32_t vertex = mesh.corners[corners[i]];
          if (number[vertex] == kUnused) {
            number[vertex] = static_cast<std::uint32_t>(surface.vertices.size());
            surface.vertices.push_back(mesh.vertices[vertex]);
          }
          triangle[i] = number[vertex];
        }
        surface.triangles.push_back(triangle);
        surface.is_inside.push_back(mesh.faces[f].kind == FaceKind::kInterior ? 1 : 0);
      }
    }
  }
  return surface;
}

/// Returns the pattern and the radius with which a material breaks at an energy.
scenes::SolidBreak break_of(const Material& material, double energy_J) {
  scenes::SolidBreak options;
  options.name = "material " + material.name;
  options.pattern = material.pattern;
  options.radius_m = material.impact_radius_m;
  for (const ImpactResponse& response : material.stronger) {
    if (energy_J < response.energy_J) continue;
    options.pattern = response.pattern;
    options.radius_m = response.impact_radius_m;
  }
  if (options.pattern.kind == PatternSpec::Kind::kNone) {
    throw InputError("material " + material.name + " is unbreakable; give a pattern");
  }
  if (!(*options.radius_m < std::numeric_limits<double>::infinity())) options.radius_m.reset();
  return options;
}

/// The pieces of a solid, and what the break left whole.
struct Broken {
  BreakPlan plan;
  double volume_m3 = 0;
  std::size_t convexes = 0;    ///< Number of convexes before the break.
  Vec3 origin = Vec3::Zero();  ///< Of the solid that was broken, in the coordinates of the mesh.

  double failed_fraction() const { return plan.failed_m3 / volume_m3; }
};

Broken broken(const Compound& compound, const scenes::SolidBreak& options) {
  scenes::PreparedSolidBreak ready(compound, scenes::break_command(compound, options));
  return {std::move(ready).apply(ready.plan()), volume(compound), compound.convexes.size()};
}

Broken broken_solid(const std::string& mesh, const scenes::MeshOptions& of,
                    scenes::SolidBreak options) {
  const scenes::MeshSolid solid = scenes::make_mesh_solid(mesh, of);
  if (options.at_R) *options.at_R -= solid.origin;
  Broken all = broken(solid.compound, options);
  all.origin = solid.origin;
  return all;
}

/// Makes a compound of the mesh that a text names, and breaks it; with more nodes, if too much of
/// the mesh is left whole.
Broken broken_mesh(const std::string& mesh, const scenes::SolidBreak& options) {
  Broken best = broken_solid(mesh, {}, options);
  scenes::NodeRetries retries(best.convexes);
  while (!scenes::is_built_in_solid(mesh)) {
    const std::optional<std::uint32_t> nodes = retries.next(best.failed_fraction());
    if (!nodes) break;
    scenes::MeshOptions more;
    more.nodes = std::to_string(*nodes);
    Broken next = broken_solid(mesh, more, options);
    if (next.plan.failed_m3 < best.plan.failed_m3) best = std::move(next);
  }
  return best;
}

/// Returns the pieces with their surfaces. Sets `warning` if the break was not perfect.
std::vector<Piece> pieces_of(Broken broken, std::string& warning) {
  BreakPlan& plan = broken.plan;
  if (plan.failed > 0) {
    warning = uncut_convexes_warning(plan.failed, plan.failed_m3, broken.volume_m3) +
              "; an asset with more nodes may help";
  }
  const Model model = make_model(plan.pieces, {}, 0);
  std::vector<Piece> pieces;
  for (std::size_t i = 0; i < plan.pieces.size(); ++i) {
    Piece piece;
    PieceSurface surface = surface_of(model.parts[i].shells);
    for (Vec3& vertex : surface.vertices) vertex += broken.origin;
    piece.surface = std::make_shared<const PieceSurface>(std::move(surface));
    for (const Model::Shell& shell : model.parts[i].shells) {
      piece.mass = piece.mass + mass_properties(*shell.mesh);
    }
    piece.mass.centroid += broken.origin;
    piece.compound = scenes::moved(plan.pieces[i], broken.origin);
    pieces.push_back(std::move(piece));
  }
  if (model.parts_with_walls > 0) {
    warning += (warning.empty() ? "" : "; ") + std::string("inner walls are kept in ") +
               std::to_string(model.parts_with_walls) +
               " pieces, whose surfaces would be open without them";
  }
  return pieces;
}

std::vector<Piece> fracture(const std::variant<std::filesystem::path, Asset>& solid,
                            const std::variant<std::string, Material>& pattern,
                            std::optional<Vec3> point, std::optional<double> radius_m,
                            double energy_J, std::uint64_t seed) {
  scenes::SolidBreak options;
  if (const auto* material = std::get_if<Material>(&pattern)) {
    options = break_of(*material, energy_J);
  } else {
    options.pattern = scenes::parse_pattern(std::get<std::string>(pattern));
  }
  options.at_R = point;
  if (radius_m) options.radius_m = radius_m;
  if (options.radius_m && !(*options.radius_m > 0)) {
    throw InputError("radius_m is " + std::to_string(*options.radius_m) +
                     "; expected a length above 0");
  }
  options.seed = seed;
  if (options.at_R && !options.at_R->allFinite()) {
    throw InputError("point is not finite; expected three numbers");
  }
  std::string warning;
  std::vector<Piece> pieces;
  {
    const py::gil_scoped_release release;
    if (const auto* asset = std::get_if<Asset>(&solid)) {
      pieces = pieces_of(broken(asset->compound(), options), warning);
    } else {
      const std::string mesh = std::get<std::filesystem::path>(solid).string();
      pieces = pieces_of(broken_mesh(mesh, options), warning);
    }
  }
  if (!warning.empty()) {
    py::module_::import("warnings").attr("warn")(warning, py::arg("stacklevel") = 2);
  }
  return pieces;
}

}  // namespace

void bind_fracture(py::module_& module) {
  py::class_<Piece>(module, "Piece",
                    "A piece of a broken solid, in the coordinates of the solid. Its arrays are "
                    "read-only views.")
      .def_property_readonly(
          "vertices",
          [](const Piece& self) {
            return rows_of<double>(self.surface, self.surface->vertices, 3);
          },
          "Vertices of the surface (n, 3), float64.")
      .def_property_readonly(
          "triangles",
          [](const Piece& self) {
            return rows_of<std::uint32_t>(self.surface, self.surface->triangles, 3);
          },
          "Vertices of triangles (m, 3), uint32, counter-clockwise seen from outside; the surface "
          "is closed.")
      .def_property_readonly(
          "is_inside",
          [](const Piece& self) { return rows_of<bool>(self.surface, self.surface->is_inside); },
          "True for triangles that the break made (m), bool.")
      .def_property_readonly(
          "volume_m3", [](const Piece& self) { return self.mass.volume_m3; }, "Volume in m³.")
      .def_property_readonly(
          "centroid", [](const Piece& self) { return self.mass.centroid; }, "Centre of volume.")
      .def_property_readonly(
          "asset", [](const Piece& self) { return Asset(self.compound); },
          "The piece as an asset, for worlds.");
  module.def(
      "fracture", &fracture, py::arg("solid"), py::arg("pattern") = "voronoi:30",
      py::arg("point") = py::none(), py::arg("radius_m") = py::none(), py::arg("energy_J") = 0.0,
      py::arg("seed") = 1,
      "Breaks an asset, or the mesh of a file, once, as `sunder fracture` does, and returns its "
      "pieces.\n\n"
      "pattern: voronoi:N[,FALLOFF], web:RINGSxSPOKES, radial:N, brick:X,Y,Z, slabs:N, grid:N, or "
      "an "
      ".obj file of cells; or a Material, which breaks by the pattern that it has for an impact of "
      "energy_J. point: the impact; None: the middle. radius_m: distance from it within which the "
      "solid breaks; None: all of it.");
}

}  // namespace sunder::python
