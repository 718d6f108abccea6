#include "scenes/app/mesh_report.h"

#include <filesystem>

#include "engine/base/check.h"
#include "engine/io/glb_writer.h"
#include "engine/io/obj_writer.h"

namespace sunder::app {
namespace {

bool is_folder(const std::string& output) {
  return output.ends_with('/') || std::filesystem::path(output).extension().empty();
}

std::string text(const Repair& repair) {
  return repair.name + " (" + std::to_string(repair.count) + ")";
}

/// Limestone, for solids that nobody gave a material.
std::vector<Material> stone() {
  Material stone;
  stone.name = "stone";
  stone.surface.color = Vec3f(0.55f, 0.52f, 0.46f);
  stone.interior.color = Vec3f(0.45f, 0.2f, 0.1f);
  return {stone};
}

}  // namespace

Figures input_figures(const scenes::MeshSolid& solid) {
  Figures figures;
  figures["/input/vertices"] = static_cast<std::int64_t>(solid.vertices);
  figures["/input/faces"] = static_cast<std::int64_t>(solid.faces);
  figures["/input/closed"] = solid.closed;
  if (solid.repairs.empty()) figures["/input/repairs"] = EmptyList();
  for (std::size_t i = 0; i < solid.repairs.size(); ++i) {
    figures["/input/repairs/" + std::to_string(i)] = text(solid.repairs[i]);
  }
  return figures;
}

std::string input_summary(const scenes::MeshSolid& solid) {
  std::string line = "input    " + solid.name + ": " + std::to_string(solid.vertices) +
                     " vertices, " + std::to_string(solid.faces) + " faces, " +
                     (solid.closed ? "closed" : "not closed") + "\n";
  std::string repairs;
  for (const Repair& repair : solid.repairs)
    repairs += (repairs.empty() ? "" : ", ") + text(repair);
  return line + "repairs  " + (repairs.empty() ? "none" : repairs) + "\n";
}

void check_output(const std::string& output) {
  if (output.empty() || output.ends_with(".glb") || is_folder(output)) return;
  throw InputError("-o " + output + ": expected X.glb, or a folder for .obj files (DIR/)");
}

void write_solids(const std::string& output, std::span<const Compound> solids, double explode) {
  const Model model = make_model(solids, stone(), explode);
  if (is_folder(output)) {
    write_obj_folder(output, model);
  } else {
    write_glb(output, model);
  }
}

}  // namespace sunder::app
