#include "scenes/file/body.h"

#include <array>
#include <utility>

#include "engine/base/check.h"
#include "scenes/file/error_list.h"
#include "scenes/file/make_compound.h"
#include "scenes/file/mesh_solid.h"
#include "scenes/file/moved_part.h"
#include "scenes/file/placement.h"

namespace sunder::scenes {
namespace {

constexpr std::string_view kRepairs[] = {"auto", "off"};
constexpr std::string_view kLooks[] = {"file", "material"};
/// Convexes that reach below this fraction of the body's height are anchored at its bottom.
constexpr double kBottomFraction = 0.01;

Keys<MeshTable> make_mesh_keys() {
  return {"[[body]]",
          {key<&MeshTable::mesh>("mesh",
                                 "A file (.obj .ply .stl .off .gltf .glb), relative to the folder "
                                 "of the scene; a built-in solid, such as torus:1,0.3; or a "
                                 "built-in mesh, statue:80000 with this number of triangles.")
               .must(),
           key<&MeshTable::scale>("scale", "", Range{1e-6, 1e6}, "Length of one unit of the file."),
           key<&MeshTable::size_m>("size_m", "m", Range{1e-3, 1e4},
                                   "Longest side of the bounding box of a file; replaces scale."),
           key<&MeshTable::nodes>("nodes", "Nodes of the decomposition of a file."),
           key<&MeshTable::convexes>(
               "convexes", "", Range{0, 10000},
               "Most convexes of the decomposition; 0: as many as the nodes give."),
           key<&MeshTable::fit>("fit",
                                "Shape that encloses each convex: aabb, 14dop, 26dop or hull:N."),
           choice<&MeshTable::repair>("repair", kRepairs,
                                      "auto: repair the mesh; off: fail if the mesh needs repair."),
           key<&MeshTable::material>("material", "Material."),
           table_key("materials",
                     "Materials of parts of a file by the name of their object, group or material: "
                     "{ roof = \"wood\", \"Wall.001\" = \"brick\" }."),
           choice<&MeshTable::look>("look", kLooks,
                                    "file: the outside has the colours and textures of the file, "
                                    "where it has any; material: those of the material.")}};
}

Keys<BodyTable> make_body_keys() {
  return {"[[body]]",
          {key<&BodyTable::name>("name", "Name in messages; that of the mesh by default."),
           key<&BodyTable::velocity>("velocity", "m/s", ranges::kSpeed_m_s, "Initial velocity."),
           key<&BodyTable::angular_velocity>("angular_velocity", "rad/s", ranges::kSpin_rad_s,
                                             "Initial angular velocity."),
           choice<&BodyTable::anchored>("anchored", anchored_names(),
                                        "bottom: the lowest parts are fixed to the world; all: all "
                                        "parts are fixed on all sides; none: the body is free.")}};
}

MeshOptions options_of(const MeshTable& given, const std::filesystem::path& folder) {
  MeshOptions options;
  options.nodes = given.nodes.file.empty() ? std::to_string(given.nodes.count)
                                           : (folder / given.nodes.file).string();
  if (given.nodes.file.empty() && given.nodes.count == 0) options.nodes.clear();
  options.convexes = given.convexes;
  options.fit = given.fit;
  options.repair = kRepairs[static_cast<std::size_t>(given.repair)];
  options.scale = given.scale;
  options.size_m = given.size_m;
  options.materials = given.materials;
  options.cached = true;
  return options;
}

void anchor(Compound& compound, Anchored how) {
  if (how == Anchored::kNone) return;
  const Box box = bounds(compound);
  const double bottom = box.min.y() + kBottomFraction * box.extent().y();
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    if (how == Anchored::kAll) {
      compound.anchored[c] = kAnchoredAllSides;
    } else if (compound.convexes[c]->box.min.y() <= bottom) {
      compound.anchored[c] = anchor_side(1, false);
    }
  }
}

Compound mirrored_whole(const Compound& compound) {
  std::vector<Part> parts;
  for (Part& part : parts_of(compound)) parts.push_back(mirrored(std::move(part)));
  return make_compound(std::move(parts));
}

std::string default_name(const std::string& mesh) {
  return is_built_in(mesh) ? mesh : std::filesystem::path(mesh).stem().string();
}

}  // namespace

const Keys<MeshTable>& mesh_keys() {
  static const Keys<MeshTable> kKeys = make_mesh_keys();
  return kKeys;
}

const Keys<BodyTable>& body_keys() {
  static const Keys<BodyTable> kKeys = make_body_keys();
  return kKeys;
}

void read_named_materials(const Value& table, std::span<const Material> materials,
                          MeshTable& mesh) {
  const Value* named = find(table, "materials");
  if (!named) return;
  for (const Entry& entry : as_table(*named, "materials")) {
    const std::string* material = std::get_if<std::string>(&entry.value.data);
    if (!material) {
      throw InputError(entry.value.where + ": '" + entry.key + "' in materials is " +
                       describe(entry.value) + "; expected the name of a material");
    }
    mesh.materials.emplace_back(entry.key, find_material(*material, entry.value.where, materials));
  }
}

Compound read_compound(const MeshTable& given, const std::filesystem::path& folder,
                       std::vector<Appearance>& appearances, std::vector<std::string>& warnings) {
  const bool built_in = is_built_in(given.mesh);
  const std::string mesh = built_in ? given.mesh : (folder / given.mesh).string();
  MeshOptions options = options_of(given, folder);
  if (given.look == LookChoice::kFile) options.appearances = &appearances;
  options.warnings = &warnings;
  options.centered = true;  // bodies are placed by their foot
  return make_compound(mesh, given.material.index, options);
}

Vec3 foot_of(const Compound& compound) {
  const Box box = bounds(compound);
  return Vec3(box.center().x(), box.min.y(), box.center().z());
}

Body read_body(const Value& table, std::span<const Material> materials,
               const std::filesystem::path& folder, std::vector<Appearance>& appearances,
               std::vector<std::string>& warnings) {
  const std::string_view name = body_keys().table;
  MeshTable mesh;
  BodyTable given;
  std::vector<Copy> copies;
  ErrorList errors;
  errors.collect([&] {
    check_known(table, name, {mesh_keys().keys, body_keys().keys, placement_keys().keys});
  });
  errors.collect([&] { read_keys(table, name, mesh_keys().keys, materials, &mesh); });
  errors.collect([&] { read_named_materials(table, materials, mesh); });
  errors.collect([&] { read_keys(table, name, body_keys().keys, {}, &given); });
  errors.collect([&] { copies = read_copies(table, name); });
  errors.throw_any();
  Body body{given.name, default_name(mesh.mesh), {}};
  try {
    Compound compound = read_compound(mesh, folder, appearances, warnings);
    anchor(compound, given.anchored);
    std::array<std::vector<Compound>, 2> islands;  // of the body, and of its mirror image
    std::array<Vec3, 2> foot_R;
    for (const Copy& copy : copies) {
      std::vector<Compound>& parts = islands[copy.mirrored];
      if (parts.empty()) {
        const Compound whole = copy.mirrored ? mirrored_whole(compound) : compound;
        foot_R[copy.mirrored] = foot_of(whole);
        parts = split_islands(whole);
      }
      Pose X_WR = copy.X_FM;
      X_WR.position -= X_WR.rotation * foot_R[copy.mirrored];
      for (const Compound& part : parts) {
        body.solids.push_back({"", part, X_WR, copy.velocity(given.velocity),
                               copy.angular_velocity(given.angular_velocity)});
      }
    }
  } catch (const InputError& error) {
    throw InputError(table.where + ": " + error.what());
  }
  return body;
}

}  // namespace sunder::scenes
