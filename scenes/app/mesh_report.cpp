#include "scenes/app/mesh_report.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <utility>

#include "engine/base/check.h"
#include "engine/io/file_ending.h"
#include "engine/io/mesh/glb_writer.h"
#include "engine/io/mesh/obj_writer.h"
#include "render/image/normal_map.h"
#include "scenes/app/picture.h"
#include "scenes/load.h"

namespace sunder::app {
namespace {

bool is_folder(const std::string& output) {
  return output.ends_with('/') || std::filesystem::path(output).extension().empty();
}

/// Density of the stone that a solid without a material may be of.
double stone_kg_m3() {
  const std::vector<Material> materials = scenes::builtin_materials();
  return std::ranges::find(materials, "stone", &Material::name)->density_kg_m3;
}

InputSize size_of(const scenes::MeshSolid& solid) {
  return {bounds(solid.compound).extent(), volume(solid.compound)};
}

std::string text(const Repair& repair) {
  return repair.name + " (" + std::to_string(repair.count) + ")";
}

}  // namespace

double InputSize::mass_kg() const { return stone_kg_m3() * volume_m3; }

std::string text(const InputSize& size, double scale) {
  char line[240];
  std::snprintf(
      line, sizeof line,
      "size     %.4g x %.4g x %.4g m (--scale %g); as stone of %.0f kg/m³ it has %.4g kg\n",
      size.extent_m.x(), size.extent_m.y(), size.extent_m.z(), scale, stone_kg_m3(),
      size.mass_kg());
  return line;
}

void add_size(const InputSize& size, double scale, Figures& figures) {
  for (int axis = 0; axis < 3; ++axis)
    figures["/input/size_m/" + std::to_string(axis)] = size.extent_m[axis];
  figures["/input/scale"] = scale;
  figures["/input/stone_kg"] = size.mass_kg();
}

Figures input_figures(const scenes::MeshSolid& solid, double scale) {
  Figures figures;
  add_size(size_of(solid), scale, figures);
  figures["/input/vertices"] = static_cast<std::int64_t>(solid.vertices);
  figures["/input/faces"] = static_cast<std::int64_t>(solid.faces);
  figures["/input/closed"] = solid.closed;
  if (solid.repairs.empty()) figures["/input/repairs"] = EmptyList();
  for (std::size_t i = 0; i < solid.repairs.size(); ++i) {
    figures["/input/repairs/" + std::to_string(i)] = text(solid.repairs[i]);
  }
  if (solid.warnings.empty()) figures["/warnings"] = EmptyList();
  for (std::size_t i = 0; i < solid.warnings.size(); ++i) {
    figures["/warnings/" + std::to_string(i)] = solid.warnings[i];
  }
  return figures;
}

void print_warnings(const scenes::MeshSolid& solid) {
  for (const std::string& warning : solid.warnings)
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
}

std::string input_summary(const scenes::MeshSolid& solid, double scale) {
  std::string line = "input    " + solid.name + ": " + std::to_string(solid.vertices) +
                     " vertices, " + std::to_string(solid.faces) + " faces, " +
                     (solid.closed ? "closed" : "not closed") + "\n";
  std::string repairs;
  for (const Repair& repair : solid.repairs)
    repairs += (repairs.empty() ? "" : ", ") + text(repair);
  return line + "repairs  " + (repairs.empty() ? "none" : repairs) + "\n" +
         text(size_of(solid), scale);
}

void add_faults(const SurfaceAudit& surface, Figures& figures) {
  const auto add = [&](const char* key, std::size_t count) {
    figures[key] = static_cast<std::int64_t>(count);
  };
  add("/open_edges", surface.open_edges);
  add("/non_manifold_edges", surface.non_manifold_edges);
  add("/twin_points", surface.twin_points);
  add("/collapsed_triangles", surface.collapsed_triangles);
  add("/inside_out_islands", surface.inside_out_islands);
  figures["/inside_out_m3"] = surface.inside_out_m3;
  figures["/surface_volume_m3"] = surface.volume_m3;
}

void add_doubled(const std::optional<fracture::DoubleCountedVolume>& double_counted,
                 Figures& figures) {
  if (!double_counted) return;
  figures["/volume_doubled_m3"] = double_counted->volume_m3;
  figures["/volume_doubled_method"] =
      std::string(double_counted->is_exact ? "exact" : "upper bound");
}

std::string doubled_summary(const std::optional<fracture::DoubleCountedVolume>& double_counted) {
  if (!double_counted || !(double_counted->volume_m3 > 0)) return "";
  char text[160];
  std::snprintf(text, sizeof text,
                "overlaps %s%.3g m³ of the volume, counted with each of the parts that overlap\n",
                double_counted->is_exact ? "" : "up to ", double_counted->volume_m3);
  return text;
}

void check_output(const std::string& output) {
  if (output.empty() || has_ending(output, ".glb") || has_ending(output, ".png")) return;
  if (is_folder(output)) return;
  throw InputError("-o " + output + ": expected X.glb, X.png, or a folder for .obj files (DIR/)");
}

std::size_t write_solids(const std::string& output, const std::vector<Compound>& solids,
                         const std::vector<Material>& materials,
                         std::vector<Appearance> appearances, std::optional<double> explode,
                         Walls walls, const Vec3& origin) {
  if (has_ending(output, ".png")) {
    constexpr double kDefaultExplode = 0.3;  // makes cracks visible
    draw_solids(output, solids, materials, std::move(appearances),
                explode.value_or(kDefaultExplode));
    return 0;
  }
  std::map<EncodedImage, EncodedImage>
      normals;  // normal maps, as other programs read no height maps
  for (Appearance& appearance : appearances) {
    if (!appearance.relief) continue;
    EncodedImage& known = normals[appearance.relief];
    if (!known) known = render::as_normal_map(appearance.relief);
    appearance.relief = known;
  }
  Model model = make_model(solids, materials, explode.value_or(0), appearances, walls);
  for (Model::Part& part : model.parts) part.offset += origin;
  if (is_folder(output)) {
    write_obj_folder(output, model);
  } else {
    write_glb(output, model);
  }
  return model.parts_with_walls;
}

std::vector<Material> stone() {
  Material stone;
  stone.name = "stone";
  stone.surface.color = Vec3f(0.55f, 0.52f, 0.46f);
  stone.interior.color = Vec3f(0.45f, 0.2f, 0.1f);
  return {stone};
}

std::vector<Material> palette() {
  constexpr float kColors[][3] = {{.80f, .25f, .18f}, {.15f, .42f, .75f}, {.90f, .62f, .12f},
                                  {.20f, .58f, .27f}, {.55f, .27f, .62f}, {.12f, .62f, .62f},
                                  {.85f, .42f, .55f}, {.45f, .34f, .20f}, {.60f, .68f, .20f},
                                  {.35f, .38f, .48f}, {.90f, .80f, .45f}, {.40f, .65f, .85f}};
  std::vector<Material> materials;
  for (const auto& c : kColors) {
    Material material;
    material.name = "color " + std::to_string(materials.size());
    material.surface.color = Vec3f(c[0], c[1], c[2]);
    material.interior.color = 0.6f * material.surface.color;
    materials.push_back(material);
  }
  return materials;
}

}  // namespace sunder::app
