#include "scenes/file/mesh_solid.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <set>
#include <sstream>

#include "engine/base/check.h"
#include "engine/base/trace.h"
#include "engine/geometry/approximate_hull.h"
#include "engine/geometry/polygon_mesh.h"
#include "engine/io/mesh/mesh_reader.h"
#include "fracture/solids.h"
#include "scenes/file/keys.h"
#include "scenes/file/mesh_cache.h"
#include "scenes/file/text_file.h"
#include "scenes/sculpture/statue.h"

namespace sunder::scenes {
namespace {

constexpr const char* kSolids[] = {"box", "column", "torus", "grid", "voronoi", "hall"};
constexpr std::size_t kNamesShown = 20;  // most names that a message lists
constexpr const char* kStatue = "statue";
constexpr std::uint32_t kFewestTriangles = 1000, kMostTriangles = 1000000;

/// Returns the whole number from `low` to `high` in a text; none if the text is anything else.
std::optional<std::uint32_t> whole_number(std::string_view text, std::uint32_t low,
                                          std::uint32_t high) {
  std::uint32_t number = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return number < low || number > high ? std::nullopt : std::optional(number);
}

/// Returns the text before the first colon, or all of it if there is none.
std::string kind_of(const std::string& mesh) { return mesh.substr(0, mesh.find(':')); }

Fit fit_of(const std::string& text) {
  if (const std::optional<Fit> fit = parse_fit(text)) return *fit;
  throw InputError("fit " + text + ": expected " + std::string(kFitNames));
}

bool is_number(const std::string& text) {
  return !text.empty() && std::all_of(text.begin(), text.end(), [](unsigned char c) {
    return std::isdigit(c) != 0 || c == '-' || c == '+' || c == '.';
  });
}

void scale_mesh(RawMesh& mesh, const MeshOptions& options, fracture::VacdOptions& vacd) {
  double scale = options.scale;
  if (options.size_m) {
    Box box;
    for (const std::uint32_t vertex : mesh.corners) box.extend(mesh.vertices[vertex]);
    scale = *options.size_m / std::max(box.empty() ? 0 : box.extent().maxCoeff(), 1e-300);
  }
  for (Vec3& vertex : mesh.vertices) vertex *= scale;
  for (Vec3& node : vacd.nodes) node *= scale;
}

/// Moves a mesh that is far from its origin to its middle, which it returns, rounded to a multiple
/// of a power of two above its size, so that what is moved and what was not have the same bits.
Vec3 move_to_middle(RawMesh& mesh, fracture::VacdOptions& vacd) {
  constexpr double kSizesAway = 16;
  Box box;
  for (const std::uint32_t vertex : mesh.corners) box.extend(mesh.vertices[vertex]);
  const double size_m = box.empty() ? 0 : box.extent().maxCoeff();
  if (!(box.center().cwiseAbs().maxCoeff() > kSizesAway * size_m)) return Vec3::Zero();
  int exponent = 0;
  std::frexp(size_m, &exponent);
  const double unit_m = std::ldexp(1, exponent);
  const Vec3 middle = unit_m * (box.center() / unit_m).array().round().matrix();
  for (Vec3& vertex : mesh.vertices) vertex -= middle;
  for (Vec3& node : vacd.nodes) node -= middle;
  return middle;
}

/// Returns the material of each group of a mesh: i + 1 if the first name of the group that is given
/// a material is options.materials[i], 0 if no name is. Throws InputError for a name that the mesh
/// does not have.
std::vector<MaterialIndex> materials_of(const RawMesh& mesh, const std::string& file,
                                        const MeshOptions& options) {
  std::vector<MaterialIndex> of_groups(mesh.groups.size(), MaterialIndex(0u));
  std::set<std::string_view> all;
  for (const RawMesh::Group& group : mesh.groups) {
    for (const std::string& name : group.names) all.insert(name);
  }
  for (const auto& [name, material] : options.materials) {
    if (all.contains(name)) continue;
    std::vector<std::string_view> names(all.begin(), all.end());
    const std::size_t more = names.size() - std::min(names.size(), kNamesShown);
    const std::string nearest = did_you_mean(name, names);
    names.resize(names.size() - more);
    throw InputError(
        file + ": no object, group or material in it is named '" + name + "'" + nearest +
        (names.empty() ? "; only OBJ and glTF files have such names" : "; names: " + join(names)) +
        (more > 0 ? " and " + std::to_string(more) + " more" : ""));
  }
  for (std::size_t g = 0; g < of_groups.size(); ++g) {
    for (const std::string& name : mesh.groups[g].names) {
      const auto found = std::ranges::find(
          options.materials, name, [](auto& one) -> const auto& { return one.first; });
      if (found == options.materials.end()) continue;
      of_groups[g] = MaterialIndex(1 + static_cast<std::size_t>(found - options.materials.begin()));
      break;
    }
  }
  return of_groups;
}

bool same(const EncodedImage& a, const EncodedImage& b) {
  return a && b ? *a == *b : a == b;  // one file may have been read twice
}

bool same(const std::optional<MetallicRoughness>& a, const std::optional<MetallicRoughness>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->roughness == b->roughness && a->metallic == b->metallic && same(a->picture, b->picture);
}

/// Appends the appearances of a file's groups to those of the scene. Returns the index of each
/// group's appearance plus one; 0 if it has none.
std::vector<std::uint32_t> add_appearances(const std::vector<std::optional<Appearance>>& of_groups,
                                           std::vector<Appearance>& appearances) {
  std::vector<std::uint32_t> numbers;
  for (const std::optional<Appearance>& appearance : of_groups) {
    numbers.push_back(0);
    if (!appearance) continue;
    const auto known = std::ranges::find_if(
        appearances, [&](const Appearance& other) { return same_appearance(*appearance, other); });
    numbers.back() = static_cast<std::uint32_t>(known - appearances.begin()) + 1;
    if (known == appearances.end()) appearances.push_back(*appearance);
  }
  return numbers;
}

/// Changes the appearances of all faces from those of the file to those of the scene: i + 1 to
/// of_groups[i], and to 0 if that does not exist.
void set_appearances(Compound& compound, const std::vector<std::uint32_t>& of_groups) {
  for (ConvexPtr& convex : compound.convexes) {
    if (!convex->visual) continue;
    auto mesh = std::make_shared<PolygonMesh>(*convex->visual);
    for (PolygonMesh::Face& face : mesh->faces) {
      const std::uint32_t in_file = face.appearance;
      face.appearance = in_file > 0 && in_file <= of_groups.size() ? of_groups[in_file - 1] : 0;
    }
    const auto changed = std::make_shared<Convex>(*convex);
    changed->visual = std::move(mesh);
    convex = changed;
  }
}

/// Returns a warning that names the missing files; empty if there are none.
std::string missing_warning(const std::string& file, const std::vector<std::string>& missing) {
  if (missing.empty()) return "";
  std::string names;
  for (std::size_t i = 0; i < std::min(missing.size(), kNamesShown); ++i) {
    names += (i == 0 ? "'" : ", '") + missing[i] + "'";
  }
  if (missing.size() > kNamesShown) {
    names += " and " + std::to_string(missing.size() - kNamesShown) + " more";
  }
  return file + ": files of textures or materials cannot be read: " + names +
         "; put them into the folder of the mesh, or export it as .glb with textures";
}

/// Returns a warning if a decomposition is not as its user may expect; empty if it is.
std::string decomposition_warning(const std::string& file, const fracture::VacdOptions& options,
                                  const MeshSolid& solid) {
  const std::size_t made = solid.compound.convexes.size();
  if (options.convexes > 0 && made > options.convexes)
    return file + ": it has " + std::to_string(made) + " separate parts, each of which needs a " +
           "convex, so that there are " + std::to_string(made) + " convexes in place of " +
           std::to_string(options.convexes);
  if (!options.chooses_nodes() || solid.vacd->has_tight_hulls()) return "";
  char text[300];
  std::snprintf(text, sizeof text,
                ": its %zu convexes have %.3g times its volume, so that they may close openings; "
                "give a number of nodes or of convexes for tighter ones",
                made, solid.vacd->hull_volume_ratio());
  return file + text;
}

/// Repairs and decomposes a mesh, or loads the result from the cache.
MeshSolid decomposed(RawMesh raw, const std::string& file, fracture::VacdOptions vacd_of,
                     const MeshOptions& options) {
  if (options.progress) {
    vacd_of.progress = [&](double share) { options.progress("decomposing", 0.4 + 0.6 * share); };
  }
  const std::string warning = missing_warning(file, raw.missing_files);
  scale_mesh(raw, options, vacd_of);
  const Vec3 origin = move_to_middle(raw, vacd_of);
  if (!options.materials.empty())
    vacd_of.materials_by_appearance = materials_of(raw, file, options);
  std::vector<std::optional<Appearance>> appearances;
  for (const RawMesh::Group& group : raw.groups) {
    appearances.push_back(group.appearance);
    if (options.appearances) vacd_of.textured_by_appearance.push_back(group.appearance ? 1 : 0);
  }
  const std::uint64_t key = options.cached ? cache_key(raw, vacd_of, options.repair) : 0;
  std::optional<MeshSolid> known = options.cached ? load_cached(key) : std::nullopt;
  MeshSolid solid = known ? std::move(*known) : MeshSolid();
  if (!known) {
    solid.vertices = raw.vertices.size();
    solid.faces = raw.polygons.size();
    if (options.progress) options.progress("repairing", 0.1);
    RepairedMesh repaired = repair_mesh(std::move(raw), file, {.repair = options.repair != "off"});
    if (options.progress) options.progress("decomposing", 0.4);
    fracture::Vacd vacd = fracture::decompose(repaired, vacd_of);
    solid.closed = repaired.closed;
    solid.repairs = std::move(repaired.repairs);
    solid.compound = std::move(vacd.compound);
    solid.vacd = vacd.figures;
    if (options.cached) store_cached(key, solid);
  }
  solid.origin = origin;
  solid.name = std::filesystem::path(file).filename().string();
  if (!warning.empty()) solid.warnings.push_back(warning);
  const std::string coarse = decomposition_warning(file, vacd_of, solid);
  if (!coarse.empty()) solid.warnings.push_back(coarse);
  set_appearances(solid.compound, options.appearances
                                      ? add_appearances(appearances, *options.appearances)
                                      : std::vector<std::uint32_t>());
  return solid;
}

}  // namespace

bool same_appearance(const Appearance& a, const Appearance& b) {
  return a.color == b.color && same(a.picture, b.picture) && a.v_from_bottom == b.v_from_bottom &&
         same(a.relief, b.relief) && a.normal_scale == b.normal_scale && same(a.gloss, b.gloss);
}

bool is_built_in_solid(const std::string& mesh) {
  return std::ranges::count(kSolids, kind_of(mesh)) > 0 && !std::filesystem::exists(mesh);
}

bool is_built_in(const std::string& mesh) {
  return is_built_in_solid(mesh) || (kind_of(mesh) == kStatue && !std::filesystem::exists(mesh));
}

RawMesh make_raw_mesh(const std::string& mesh) {
  if (kind_of(mesh) != kStatue || std::filesystem::exists(mesh)) return read_mesh(mesh);
  const std::size_t colon = std::string_view(kStatue).size();
  const std::string_view count = std::string_view(mesh).substr(std::min(colon + 1, mesh.size()));
  if (const auto triangles = whole_number(count, kFewestTriangles, kMostTriangles))
    return make_statue(*triangles);
  throw InputError("'" + mesh +
                   "' is not a built-in mesh; expected statue:N with N triangles, from " +
                   std::to_string(kFewestTriangles) + " to " + std::to_string(kMostTriangles));
}

fracture::VacdOptions vacd_options(const MeshOptions& options) {
  fracture::VacdOptions vacd;
  vacd.fit = fit_of(options.fit);
  vacd.convexes = options.convexes;
  vacd.material = MaterialIndex(0u);
  if (is_number(options.nodes)) {
    vacd.node_count = whole_number(options.nodes, 1, fracture::kMostNodes);
    if (!vacd.node_count) {
      throw InputError("nodes " + options.nodes + ": expected a whole number from 1 to " +
                       std::to_string(fracture::kMostNodes) +
                       ", or a file with x y z on each line");
    }
  } else if (!options.nodes.empty()) {
    std::istringstream text(read_text(options.nodes, file_kinds::kText));
    vacd.nodes = fracture::read_nodes(text, options.nodes);
  }
  if (options.repair != "auto" && options.repair != "off") {
    throw InputError("repair " + options.repair + ": expected auto | off");
  }
  return vacd;
}

MeshSolid as_mesh_solid(const std::string& name, Compound compound) {
  MeshSolid solid;
  solid.name = name;
  solid.compound = std::move(compound);
  for (const ConvexPtr& convex : solid.compound.convexes) {
    solid.vertices += convex->polyhedron.vertices.size();
    solid.faces += convex->polyhedron.faces.size();
  }
  return solid;
}

void need_no_scale(const std::string& mesh, double scale) {
  if (scale != 1)
    throw InputError(mesh + ": a built-in solid has no scale; give its size in its name");
}

MeshSolid make_mesh_solid(const std::string& mesh, const MeshOptions& options) {
  const Stopwatch watch;
  MeshSolid solid;
  if (is_built_in_solid(mesh)) {
    vacd_options(options);
    need_no_scale(mesh, options.size_m ? 0 : options.scale);
    if (!options.materials.empty()) {
      throw InputError(
          mesh + ": a built-in solid has no named parts; remove `materials`, and give `material`");
    }
    solid = as_mesh_solid(mesh, fracture::make_solid(mesh));
  } else {
    fracture::VacdOptions vacd = vacd_options(options);
    if (options.progress) options.progress("reading", 0);
    solid = decomposed(make_raw_mesh(mesh), mesh, std::move(vacd), options);
  }
  solid.prepare_ms = watch.ms();
  return solid;
}

MeshSolid make_mesh_solid(RawMesh mesh, const std::string& name, const MeshOptions& options) {
  const Stopwatch watch;
  MeshSolid solid = decomposed(std::move(mesh), name, vacd_options(options), options);
  solid.prepare_ms = watch.ms();
  return solid;
}

void set_materials(Compound& compound, const std::vector<MaterialIndex>& materials) {
  const auto change = [&](ConvexPtr& convex) {
    const auto changed = std::make_shared<Convex>(*convex);
    changed->material = materials[convex->material.value];
    convex = changed;
  };
  for (ConvexPtr& convex : compound.convexes) change(convex);
  for (Ghost& ghost : compound.ghosts) change(ghost.convex);
}

}  // namespace sunder::scenes
