// Materials, assets and scenes.
#include <algorithm>
#include <cmath>
#include <sstream>

#include "engine/base/check.h"
#include "engine/geometry/hull.h"
#include "engine/geometry/raw_mesh.h"
#include "engine/model/checks/item_check.h"
#include "scenes/api/python/bindings.h"
#include "scenes/file/keys.h"
#include "scenes/file/make_compound.h"
#include "scenes/file/mesh_solid.h"
#include "scenes/file/schema.h"
#include "scenes/load.h"

namespace sunder::python {
namespace {

/// Folder of the scenes that load by name. The package sets it when it is imported.
std::filesystem::path& scenes_path() {
  static std::filesystem::path path;
  return path;
}

/// Returns a value as a scene file has it.
std::string toml_of(const py::handle& value) {
  if (py::isinstance<py::bool_>(value)) return value.cast<bool>() ? "true" : "false";
  if (py::isinstance<py::str>(value)) return value.cast<std::string>();
  if (py::isinstance<py::sequence>(value)) {
    std::string list;
    for (const py::handle element : value) list += (list.empty() ? "" : ", ") + toml_of(element);
    return "[" + list + "]";
  }
  return py::str(py::handle(value)).cast<std::string>();
}

scenes::LoadOptions load_options(const std::string& preset, const py::dict& set) {
  scenes::LoadOptions options;
  options.preset = preset;
  for (const auto& [key, value] : set) {
    options.set.push_back(py::str(key).cast<std::string>() + "=" + toml_of(value));
  }
  return options;
}

/// Options of the decomposition of a mesh, as Python passes them.
scenes::MeshOptions mesh_options(const std::string& nodes, std::uint32_t convexes,
                                 const std::string& fit, const std::string& repair, double scale,
                                 std::optional<double> size_m, bool cached) {
  scenes::MeshOptions options;
  options.nodes = nodes;
  options.convexes = convexes;
  options.fit = fit;
  options.repair = repair;
  options.scale = scale;
  options.size_m = size_m;
  options.cached = cached;
  return options;
}

/// Returns the index of a built-in material, or an index that was returned by add_material().
MaterialIndex asset_material(const MaterialName& material) {
  return material_of(material.index ? MaterialName{"", material.index} : material, builtin_names());
}

Asset asset_of_parts(std::vector<Part> parts, const MaterialName& material) {
  const py::gil_scoped_release release;
  return Asset(scenes::make_compound(std::move(parts)), names_of(material));
}

Part part_of(ConvexPolyhedron polyhedron, MaterialIndex material, bool anchored) {
  Part part;
  part.polyhedron = std::move(polyhedron);
  part.material = material;
  part.anchored = anchored ? 1 : 0;
  return part;
}

Asset asset_of_boxes(const std::vector<std::pair<Vec3, Vec3>>& boxes, const MaterialName& material,
                     bool anchored) {
  const MaterialIndex index = asset_material(material);
  std::vector<Part> parts;
  for (const auto& [low, high] : boxes)
    parts.push_back(part_of(make_box(low, high), index, anchored));
  return asset_of_parts(std::move(parts), material);
}

Asset asset_of_hulls(const std::vector<Points>& hulls, const MaterialName& material,
                     bool anchored) {
  const MaterialIndex index = asset_material(material);
  std::vector<Part> parts;
  for (std::size_t i = 0; i < hulls.size(); ++i) {
    const std::string name = "hulls[" + std::to_string(i) + "]";
    ConvexPolyhedron hull = make_hull(points_of(hulls[i], name));
    if (hull.empty()) throw InputError(name + ": the points enclose no volume");
    parts.push_back(part_of(std::move(hull), index, anchored));
  }
  return asset_of_parts(std::move(parts), material);
}

Asset asset_of_mesh(const std::filesystem::path& mesh, const MaterialName& material,
                    const scenes::MeshOptions& options) {
  const MaterialIndex index = asset_material(material);
  const py::gil_scoped_release release;
  return Asset(scenes::make_compound(mesh.string(), index, options), names_of(material));
}

Asset asset_of_triangles(const Points& vertices, const Triangles& triangles,
                         const MaterialName& material, const scenes::MeshOptions& options) {
  const MaterialIndex index = asset_material(material);
  RawMesh mesh;
  mesh.vertices = points_of(vertices, "vertices");
  if (triangles.ndim() != 2 || triangles.shape(1) != 3) {
    throw InputError("triangles: expected an array of shape (n, 3)");
  }
  const auto rows = triangles.unchecked<2>();
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    RawMesh::Polygon polygon;
    polygon.first_corner = static_cast<std::uint32_t>(mesh.corners.size());
    polygon.corner_count = 3;
    mesh.polygons.push_back(polygon);
    for (py::ssize_t corner = 0; corner < 3; ++corner) {
      const double vertex = rows(i, corner);
      if (!(vertex >= 0 && vertex < static_cast<double>(mesh.vertices.size())) ||
          vertex != std::floor(vertex)) {
        throw InputError("triangles[" + std::to_string(i) + "] has vertex " + number_text(vertex) +
                         "; expected an index from 0 and below " +
                         std::to_string(mesh.vertices.size()));
      }
      mesh.corners.push_back(static_cast<std::uint32_t>(vertex));
    }
  }
  const py::gil_scoped_release release;
  scenes::MeshSolid solid = scenes::make_mesh_solid(std::move(mesh), "the mesh", options);
  scenes::set_materials(solid.compound, {index});
  return Asset(scenes::moved(solid.compound, solid.origin), names_of(material));
}

/// Inserts a material of a name that a scene does not have, or replaces the one that it has.
/// Returns its index.
AddedMaterial add_material(Scene& scene, const Material& material) {
  const auto same = [&](const Material& other) { return other.name == material.name; };
  const auto found = std::ranges::find_if(scene.materials, same);
  const auto index = static_cast<std::uint32_t>(found - scene.materials.begin());
  if (found == scene.materials.end()) {
    scene.materials.push_back(material);
  } else {
    *found = material;
  }
  return {index, material.name};
}

/// Step, substeps and sweeps of a scene, and the preset that sets them.
struct SceneAccuracy {
  std::shared_ptr<Scene> scene;

  /// Returns the name of the preset that has these values; "custom" if none has.
  std::string preset() const {
    for (const scenes::Preset& preset : scenes::presets()) {
      Scene other;
      preset.apply(other);
      const Scene& mine = *scene;
      if (other.accuracy.dt_s == mine.accuracy.dt_s &&
          other.accuracy.substeps == mine.accuracy.substeps &&
          other.solver.sweeps == mine.solver.sweeps &&
          other.limits.full_detail == mine.limits.full_detail &&
          other.limits.chip_size_factor == mine.limits.chip_size_factor)
        return std::string(preset.name);
    }
    return "custom";
  }
  void set_preset(const std::string& name) const {
    const std::span<const scenes::Preset> all = scenes::presets();
    all[scenes::find_named(all, name, "preset " + name + ": unknown")].apply(*scene);
  }
};

}  // namespace

void bind_materials(py::module_& module) {
  py::class_<Material>(module, "Material",
                       "Density, strength and fracture pattern of a solid. Members have the names "
                       "of the keys of a scene file.")
      .def(py::init([](const std::string& name, const std::string& like) {
             const std::vector<Material> all = scenes::builtin_materials();
             Material material;
             if (!like.empty()) material = all[material_of({like, {}}, builtin_names()).value];
             material.name = name;
             return material;
           }),
           py::arg("name"), py::arg("like") = "",
           "Makes a material: a copy of the built-in one named by `like`, if given.")
      .def_readwrite("name", &Material::name, "Name, which solids and balls refer to.")
      .def_readwrite("density_kg_m3", &Material::density_kg_m3, "Density in kg/m³.")
      .def_readwrite("friction", &Material::friction, "Coefficient of friction.")
      .def_readwrite("restitution", &Material::restitution, "Coefficient of restitution, 0 to 1.")
      .def_readwrite("rolling", &Material::rolling, "Coefficient of rolling resistance.")
      .def_readwrite("toughness_J_m2", &Material::toughness_J_m2,
                     "Energy per new crack area in J/m².")
      .def_readwrite("impact_radius_m", &Material::impact_radius_m,
                     "Radius around an impact within which a solid breaks; inf: all of it.")
      .def_readwrite("tensile_Pa", &Material::tensile_Pa, "Tensile strength; 0: unlimited.")
      .def_readwrite("shear_Pa", &Material::shear_Pa, "Shear strength; 0: unlimited.")
      .def_readwrite("compressive_Pa", &Material::compressive_Pa,
                     "Compressive strength; 0: unlimited.")
      .def_readwrite("youngs_Pa", &Material::youngs_Pa, "Young's modulus.")
      .def_readwrite("yield_Pa", &Material::yield_Pa, "Yield stress; 0: brittle.")
      .def_readwrite("hardening_Pa", &Material::hardening_Pa,
                     "Increase of the yield stress per plastic strain.")
      .def_readwrite("elongation", &Material::elongation,
                     "Plastic strain at which a yielding section tears.")
      .def_readwrite("smallest_piece_m3", &Material::smallest_piece_m3,
                     "Volume below which pieces become debris.")
      .def_property(
          "pattern", [](const Material& material) { return text_of(material.pattern); },
          [](Material& material, const std::string& text) { material.pattern = pattern_of(text); },
          "Fracture pattern, such as \"voronoi:50\"; \"none\": unbreakable.")
      .def_property(
          "color",
          [](const Material& material) { return Vec3(material.surface.color.cast<double>()); },
          [](Material& material, const Vec3& color) {
            material.surface.color = color.cast<float>();
          },
          "Colour of the surface, linear RGB.")
      .def("__repr__", [](const Material& material) { return "<Material " + material.name + ">"; });
  module.def("builtin_materials", &scenes::builtin_materials,
             "Returns the materials that every scene begins with.");
}

void bind_assets(py::module_& module) {
  py::class_<Asset>(module, "Asset",
                    "A solid of which a world can have any number. A material is the name of a "
                    "built-in one, or the index that add_material() returned.")
      .def(py::init([](const std::filesystem::path& mesh, const MaterialName& material,
                       const std::string& nodes, std::uint32_t convexes, const std::string& fit,
                       const std::string& repair, double scale, std::optional<double> size_m,
                       bool cached) {
             return asset_of_mesh(
                 mesh, material, mesh_options(nodes, convexes, fit, repair, scale, size_m, cached));
           }),
           py::arg("mesh"), py::arg("material") = "concrete", py::arg("nodes") = "",
           py::arg("convexes") = 0, py::arg("fit") = "hull:24", py::arg("repair") = "auto",
           py::arg("scale") = 1.0, py::arg("size_m") = py::none(), py::arg("cached") = false,
           "Makes an asset of a mesh file (.obj .ply .stl .off .gltf .glb), which is repaired and "
           "decomposed, or of a built-in solid: \"box:X,Y,Z\", \"column:R,H\", \"torus:R,r\", "
           "\"grid:NX,NY,NZ\", \"voronoi:N\", \"hall:N\".\n\n"
           "nodes: number of nodes of the decomposition, or a file of them. convexes: the most "
           "convexes. scale: metres for each unit of the file. size_m: longest side, in place of "
           "scale. cached: decompositions are kept on disk.")
      .def_static(
          "from_boxes", &asset_of_boxes, py::arg("boxes"), py::arg("material") = "concrete",
          py::arg("anchored") = false,
          "Makes an asset of boxes, each a pair of its lowest and its highest corner. Boxes "
          "that touch or overlap hold together. anchored: fixed to the world from below.")
      .def_static("from_hulls", &asset_of_hulls, py::arg("hulls"), py::arg("material") = "concrete",
                  py::arg("anchored") = false,
                  "Makes an asset of convexes, each the hull of an array of points (n, 3).")
      .def_static(
          "from_triangles",
          [](const Points& vertices, const Triangles& triangles, const MaterialName& material,
             const std::string& nodes, std::uint32_t convexes, const std::string& fit,
             const std::string& repair) {
            return asset_of_triangles(
                vertices, triangles, material,
                mesh_options(nodes, convexes, fit, repair, 1, std::nullopt, false));
          },
          py::arg("vertices"), py::arg("triangles"), py::arg("material") = "concrete",
          py::arg("nodes") = "", py::arg("convexes") = 0, py::arg("fit") = "hull:24",
          py::arg("repair") = "auto",
          "Makes an asset of a triangle mesh: arrays (n, 3) of points, and of vertex indices, "
          "counter-clockwise seen from outside. The mesh is repaired and decomposed as a file is.")
      .def_property_readonly(
          "convexes", [](const Asset& asset) { return asset.compound().convexes.size(); },
          "Number of convexes.")
      .def_property_readonly(
          "volume_m3", [](const Asset& asset) { return volume(asset.compound()); },
          "Volume in m³; overlaps count once.")
      .def_property_readonly(
          "anchored", [](const Asset& asset) { return asset.compound().is_anchored(); },
          "True if any convex is fixed to the world.")
      .def_property_readonly(
          "bounds",
          [](const Asset& asset) {
            const Box box = bounds(asset.compound());
            return std::pair(box.min, box.max);
          },
          "Lowest and highest corner of the bounding box.")
      .def(
          "islands",
          [](const Asset& asset) {
            std::vector<Asset> islands;
            for (Compound& part : scenes::split_islands(asset.compound())) {
              islands.emplace_back(std::move(part));
            }
            return islands;
          },
          "Returns the parts that do not touch each other, each as an asset.")
      .def("__repr__", [](const Asset& asset) {
        return "<Asset of " + std::to_string(asset.compound().convexes.size()) + " convexes>";
      });
}

void bind_scenes(py::module_& module) {
  py::class_<Limits>(module, "Limits", "Limits of a run, with the names of a scene file.")
      .def_readwrite("bodies", &Limits::bodies, "Most bodies.")
      .def_readwrite("ageing", &Limits::ageing,
                     "Bodies from which the smallest fragments at rest become debris; 0: bodies.")
      .def_readwrite("parts_a_frame", &Limits::parts_a_frame, "Parts cut per frame.")
      .def_readwrite("load_work_a_frame", &Limits::load_work_a_frame, "Bond evaluations per frame.")
      .def_readwrite("debris", &Limits::debris, "Most pieces of debris.")
      .def_readwrite("dust", &Limits::dust, "Most puffs of dust.")
      .def_readwrite("impact_bonds", &Limits::impact_bonds,
                     "Most bonds of a solid that impacts break by stress.")
      .def_readwrite("impact_evaluations", &Limits::impact_evaluations,
                     "Bond evaluations of a plan by stress.")
      .def_readwrite("loaded_convexes", &Limits::loaded_convexes,
                     "Least convexes of a piece that contacts break by stress.")
      .def_readwrite("cluster_bodies", &Limits::cluster_bodies, "Most bodies around an impact.")
      .def_readwrite("probe_events", &Limits::probe_events, "Most events of a cluster in a step.")
      .def_readwrite("break_rounds", &Limits::break_rounds, "Rounds of breaks in a step.")
      .def_readwrite("full_detail", &Limits::full_detail,
                     "Awake bodies above which the smallest piece grows; 0: never.")
      .def_readwrite("piece_size_factor", &Limits::piece_size_factor,
                     "Factor on the size of the smallest pieces.")
      .def_readwrite("chip_size_factor", &Limits::chip_size_factor,
                     "Factor on the least radius of debris.")
      .def_readwrite("passed_impacts", &Limits::passed_impacts,
                     "False: impacts break only the two bodies that meet.");

  py::class_<SceneAccuracy>(module, "Accuracy", "Step, substeps and sweeps of the run of a scene.")
      .def_property("preset", &SceneAccuracy::preset, &SceneAccuracy::set_preset,
                    "Name of the preset with these values: draft, realtime, accurate or "
                    "reference; \"custom\" if there is none. Setting a name sets its values, and "
                    "`full_detail` and `chip_size_factor` of the limits.")
      .def_property(
          "dt_s", [](const SceneAccuracy& self) { return self.scene->accuracy.dt_s; },
          [](const SceneAccuracy& self, double dt_s) { self.scene->accuracy.dt_s = dt_s; },
          "Step in s: 1/60 divided by a whole number.")
      .def_property(
          "substeps", [](const SceneAccuracy& self) { return self.scene->accuracy.substeps; },
          [](const SceneAccuracy& self, int count) { self.scene->accuracy.substeps = count; },
          "Substeps of a step.")
      .def_property(
          "sweeps", [](const SceneAccuracy& self) { return self.scene->solver.sweeps; },
          [](const SceneAccuracy& self, int count) { self.scene->solver.sweeps = count; },
          "Sweeps of the contact solver in a substep.");

  py::class_<Scene, std::shared_ptr<Scene>>(
      module, "Scene", "All inputs of a run: materials, solids, balls and a script.")
      .def(py::init([] {
             auto scene = std::make_shared<Scene>();
             scene->materials = scenes::builtin_materials();
             return scene;
           }),
           "Makes a scene of the ground plane alone, with the built-in materials.")
      .def_readwrite("name", &Scene::name, "Name in messages.")
      .def_readwrite("description", &Scene::description, "One sentence about the scene.")
      .def_readonly("warnings", &Scene::warnings, "Problems of the scene's input files.")
      .def_readwrite("duration_s", &Scene::duration_s, "Duration of the run of the program.")
      .def_readwrite("gravity", &Scene::gravity_W, "Acceleration by gravity in m/s².")
      .def_readwrite("seed", &Scene::seed, "Seed of everything random.")
      .def_readonly("planar", &Scene::planar, "True if the scene moves in the plane z = 0.")
      .def_readonly("limits", &Scene::limits, "Limits of the run.")
      .def_property_readonly(
          "accuracy", [](std::shared_ptr<Scene> self) { return SceneAccuracy{std::move(self)}; },
          "Step, substeps and sweeps, and their preset.")
      .def_property(
          "ground_friction", [](const Scene& scene) { return scene.ground.friction; },
          [](Scene& scene, double friction) { scene.ground.friction = friction; },
          "Coefficient of friction of the ground plane.")
      .def_property(
          "ground_height_m", [](const Scene& scene) { return scene.ground.height_m; },
          [](Scene& scene, double height_m) { scene.ground.height_m = height_m; },
          "Height of the ground plane.")
      .def_property(
          "eye", [](const Scene& scene) { return scene.view.eye_W; },
          [](Scene& scene, const Vec3& eye) { scene.view.eye_W = eye; }, "Position of the camera.")
      .def_property(
          "target", [](const Scene& scene) { return scene.view.target_W; },
          [](Scene& scene, const Vec3& target) { scene.view.target_W = target; },
          "Point that the camera looks at.")
      .def_property(
          "fov_rad", [](const Scene& scene) { return scene.view.fov_rad; },
          [](Scene& scene, double fov_rad) { scene.view.fov_rad = fov_rad; },
          "Vertical field of view of the camera.")
      .def_property(
          "materials", [](const Scene& scene) { return scene.materials; },
          [](Scene& scene, const std::vector<Material>& materials) { scene.materials = materials; },
          "Materials by index. The list is a copy: assign it, or call add_material().")
      .def_property_readonly(
          "solids", [](const Scene& scene) { return scene.solids.size(); }, "Number of solids.")
      .def_property_readonly(
          "balls", [](const Scene& scene) { return scene.balls.size(); }, "Number of balls.")
      .def("add_material", &add_material, py::arg("material"),
           "Adds a material, or replaces that of the same name. Returns its index.")
      .def(
          "add_solid",
          [](Scene& scene, const Asset& asset, const Vec3& origin, const Xyzw& rotation,
             const Vec3& velocity, const Vec3& angular_velocity, const std::string& name) {
            for (const auto& [index, material] : asset.materials())
              material_of({material, index.value}, names_of(scene.materials));
            Solid solid;
            solid.name = name;
            solid.compound = asset.compound();
            solid.X_WR = pose_of(origin, rotation);
            solid.velocity_W = velocity;
            solid.angular_velocity_W = angular_velocity;
            scene.solids.push_back(std::move(solid));
            return scene.solids.size() - 1;
          },
          py::arg("asset"), py::arg_v("origin", Vec3(Vec3::Zero()), "(0, 0, 0)"),
          py::arg_v("rotation", Xyzw(0, 0, 0, 1), "(0, 0, 0, 1)"),
          py::arg_v("velocity", Vec3(Vec3::Zero()), "(0, 0, 0)"),
          py::arg_v("angular_velocity", Vec3(Vec3::Zero()), "(0, 0, 0)"), py::arg("name") = "",
          "Adds a solid, with the origin of the asset at `origin`; rotation is a quaternion x, y, "
          "z, "
          "w. Returns the key that it will have in a world.")
      .def(
          "add_ball",
          [](Scene& scene, const Vec3& center, double radius_m, const MaterialName& material,
             const Vec3& velocity, const std::string& name) {
            Ball ball;
            ball.name = name;
            ball.radius_m = radius_m;
            ball.material = material_of(material, names_of(scene.materials));
            ball.center_W = center;
            ball.velocity_W = velocity;
            scene.balls.push_back(ball);
          },
          py::arg("center"), py::arg("radius_m") = 0.5, py::arg("material") = "steel",
          py::arg_v("velocity", Vec3(Vec3::Zero()), "(0, 0, 0)"), py::arg("name") = "",
          "Adds a ball. The keys of balls in a world follow those of the solids.")
      .def(
          "copy", [](const Scene& scene) { return std::make_shared<Scene>(scene); },
          "Returns a copy, which shares the geometry of the solids.")
      .def("__repr__", [](const Scene& scene) { return "<Scene " + scene.name + ">"; });

  module.def(
      "load_scene",
      [](const std::filesystem::path& scene, const std::string& preset, const py::dict& set) {
        const scenes::LoadOptions options = load_options(preset, set);
        const std::filesystem::path folder = scenes_path();
        const py::gil_scoped_release release;
        return std::make_shared<Scene>(scenes::load_scene(scene.string(), options, folder));
      },
      py::arg("scene"), py::arg("preset") = "realtime", py::arg("set") = py::dict(),
      "Loads a scene by its name, or a scene file. preset: draft, realtime, accurate or reference. "
      "set: values by dotted key, such as {\"scene.seed\": 2}.");
  module.def(
      "parse_scene",
      [](const std::string& text, const std::string& preset, const py::dict& set,
         const std::filesystem::path& file) {
        const scenes::LoadOptions options = load_options(preset, set);
        const py::gil_scoped_release release;
        return std::make_shared<Scene>(scenes::parse_scene(text, file.string(), options));
      },
      py::arg("text"), py::arg("preset") = "realtime", py::arg("set") = py::dict(),
      py::arg("file") = "scene.toml",
      "Returns the scene that a text describes. Messages name `file`, and files that the scene "
      "names are sought in its folder.");
  module.def(
      "scene_names",
      [] {
        std::vector<std::string> names;
        for (const scenes::CatalogEntry& entry : scenes::catalog(scenes_path())) {
          names.push_back(entry.name);
        }
        return names;
      },
      "Returns the names of the scenes that come with Sunder, sorted.");
  module.def(
      "_set_scenes_folder", [](const std::filesystem::path& folder) { scenes_path() = folder; },
      py::arg("folder"), "Sets the folder of the scenes that load by name.");
}

}  // namespace sunder::python
