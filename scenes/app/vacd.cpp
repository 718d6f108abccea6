// sunder vacd: computes the approximate convex decomposition of a mesh (paper 4.1), and measures
// how much larger its hulls are than the mesh.
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <thread>

#include "engine/base/check.h"
#include "engine/io/file_ending.h"
#include "engine/io/mesh/glb_writer.h"
#include "engine/io/mesh/obj_writer.h"
#include "scenes/app/commands.h"
#include "scenes/app/mesh_report.h"
#include "scenes/app/work_progress.h"

namespace sunder::app {
namespace {

namespace fs = std::filesystem;
using Doubled = std::optional<fracture::DoubleCountedVolume>;

/// Returns each convex as a compound of its own; colours repeat after `colors` convexes.
std::vector<Compound> one_by_one(const Compound& compound, std::size_t colors) {
  std::vector<Compound> convexes;
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    const auto convex = std::make_shared<Convex>(*compound.convexes[c]);
    convex->material = MaterialIndex(c % colors);
    convexes.push_back({{convex}, {0}, {}, {}});
  }
  return convexes;
}

/// The volume of a decomposed mesh, measured from the surfaces of its convexes as they are
/// exported.
struct Measured {
  SurfaceAudit surface;
  Doubled double_counted;
  double volume_m3 = 0;  ///< Volume of the union of all convexes.

  explicit Measured(const Compound& compound)
      : surface(fracture::audit_surfaces(one_by_one(compound, 1))),
        double_counted(fracture::double_counted_volume(compound)),
        volume_m3(surface.volume_m3 + volume(compound)) {
    for (const ConvexPtr& convex : compound.convexes) volume_m3 -= convex->solid.volume_m3;
    if (double_counted) volume_m3 -= double_counted->volume_m3;
  }

  /// Returns the kind of figure that `volume_m3` is.
  const char* method() const {
    if (!double_counted) return "upper bound";
    return double_counted->is_exact ? "exact" : "lower bound";
  }
};

Figures figures_of(const scenes::MeshSolid& solid, double scale, const Measured& measured) {
  Figures figures = input_figures(solid, scale);
  figures["/convexes"] = static_cast<std::int64_t>(solid.compound.convexes.size());
  figures["/ghosts"] = static_cast<std::int64_t>(solid.compound.ghosts.size());
  figures["/hull_volume_ratio"] = solid.vacd->hull_volume_ratio();
  figures["/max_faces_per_convex"] = static_cast<std::int64_t>(solid.vacd->max_faces_per_convex);
  figures["/volume_m3"] = measured.volume_m3;
  figures["/volume_method"] = std::string(measured.method());
  add_faults(measured.surface, figures);
  add_doubled(measured.double_counted, figures);
  figures["/prepare_ms"] = solid.prepare_ms - solid.vacd->total_ms;
  figures["/split_ms"] = solid.vacd->split_ms;
  figures["/total_ms"] = solid.vacd->total_ms;
  return figures;
}

std::string summary(const scenes::MeshSolid& solid, double scale, const Measured& measured) {
  const fracture::VacdFigures& vacd = *solid.vacd;
  char text[400];
  std::snprintf(text, sizeof text,
                "pieces   %zu convexes, at most %zu polygons each; %zu ghosts\n"
                "tightness %.4f: all hulls %.6g m³, all shells %.6g m³\n"
                "volume   %.6g m³ (%s), overlaps counted once\n"
                "time     reading and repair %.1f ms, decomposition %.1f ms (split %.1f)\n",
                solid.compound.convexes.size(), vacd.max_faces_per_convex,
                solid.compound.ghosts.size(), vacd.hull_volume_ratio(), vacd.hull_volume_m3,
                vacd.shell_volume_m3, measured.volume_m3, measured.method(),
                solid.prepare_ms - vacd.total_ms, vacd.total_ms, vacd.split_ms);
  return input_summary(solid, scale) + text + doubled_summary(measured.double_counted);
}

void check_hulls(const std::string& file) {
  if (file.empty() || has_ending(file, ".glb") || has_ending(file, ".obj")) return;
  throw InputError("--hulls " + file + ": expected X.glb or X.obj");
}

/// Writes the polyhedra of a compound, a part each, by names that Unreal ("UCX_mesh_1") and Godot
/// ("...-convcolonly") take for collision hulls.
void write_hulls(const std::string& file, const scenes::MeshSolid& solid) {
  Compound bare = solid.compound;
  for (ConvexPtr& convex : bare.convexes) {
    const auto hull = std::make_shared<Convex>(*convex);
    hull->visual = nullptr;
    convex = hull;
  }
  const std::vector<Material> materials = stone();
  Model model = make_model(one_by_one(bare, materials.size()), materials, 0, {}, Walls::kKeep);
  const std::string mesh = fs::path(solid.name).stem().string();
  for (std::size_t i = 0; i < model.parts.size(); ++i) {
    model.parts[i].name = "UCX_" + mesh + "_" + std::to_string(i + 1) + "-convcolonly";
    model.parts[i].offset += solid.origin;
  }
  has_ending(file, ".obj") ? write_obj(file, model) : write_glb(file, model);
}

void decompose_once(const VacdOptions& options) {
  scenes::MeshOptions mesh = options.solid;
  std::optional<WorkProgress> progress(std::in_place, options.mesh, options.quiet);
  mesh.progress = [&](const char* step, double share) { (*progress)(step, share); };
  const scenes::MeshSolid solid = scenes::make_mesh_solid(options.mesh, mesh);
  progress.reset();
  print_warnings(solid);
  const Measured measured(solid.compound);
  options.print(summary(solid, mesh.scale, measured));
  if (!options.output.empty()) {
    const std::vector<Material> colors = palette();
    write_solids(options.output, one_by_one(solid.compound, colors.size()), colors, {},
                 options.explode, Walls::kKeep, solid.origin);
    options.print("wrote " + options.output + "\n");
  }
  if (!options.hulls.empty()) {
    write_hulls(options.hulls, solid);
    options.print("wrote " + options.hulls + "\n");
  }
  options.write_json(format_figures(figures_of(solid, mesh.scale, measured)));
}

/// Decomposes the mesh again whenever the file of nodes changes, until the program is stopped.
/// Prints errors of the file and goes on.
[[noreturn]] void watch_nodes(const VacdOptions& options) {
  std::error_code ignored;
  for (;;) {
    const fs::file_time_type seen = fs::last_write_time(options.solid.nodes, ignored);
    try {
      decompose_once(options);
    } catch (const InputError& error) {
      std::fprintf(stderr, "error: %s\n", error.what());
    }
    std::fflush(stdout);
    while (fs::last_write_time(options.solid.nodes, ignored) == seen) {
      std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
  }
}

}  // namespace

int vacd(const VacdOptions& options) {
  options.apply();
  if (scenes::is_built_in_solid(options.mesh)) {
    throw InputError(options.mesh +
                     ": a built-in solid is made of convexes already; give a mesh file");
  }
  check_output(options.output);
  check_hulls(options.hulls);
  scenes::vacd_options(options.solid);
  if (!options.watch) {
    decompose_once(options);
    return 0;
  }
  if (!fs::is_regular_file(options.solid.nodes) || options.output.empty()) {
    throw InputError("--watch: needs --nodes FILE to watch, and -o X.png (or X.glb) to redraw");
  }
  watch_nodes(options);
}

}  // namespace sunder::app
