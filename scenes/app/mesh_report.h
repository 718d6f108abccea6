// Shared by the commands on meshes: reports on the input, and output of solids.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "engine/io/figures.h"
#include "engine/io/mesh/export_model.h"
#include "fracture/check/audit.h"
#include "scenes/file/mesh_solid.h"

namespace sunder::app {

/// Size of an input, and the mass that it would have as stone.
struct InputSize {
  Vec3 extent_m = Vec3::Zero();
  double volume_m3 = 0;

  double mass_kg() const;
};
/// Returns a line of text on a size, of a file whose unit is `scale` m long.
std::string text(const InputSize& size, double scale);
/// Adds a size to the object `input` of the JSON output.
void add_size(const InputSize& size, double scale, Figures& figures);

/// Returns the object `input` and the list `warnings` of the JSON output.
Figures input_figures(const scenes::MeshSolid& solid, double scale = 1);
/// Prints the warnings.
void print_warnings(const scenes::MeshSolid& solid);
/// Returns three lines of text on the input, its repairs and its size.
std::string input_summary(const scenes::MeshSolid& solid, double scale = 1);

/// Adds the counts of the faults of exported surfaces to the figures.
void add_faults(const SurfaceAudit& surface, Figures& figures);
/// Returns a line on the volume that overlaps count twice; empty if there is none.
std::string doubled_summary(const std::optional<fracture::DoubleCountedVolume>& double_counted);
/// Adds the volume that overlaps count twice to the figures; nothing if it was not measured.
void add_doubled(const std::optional<fracture::DoubleCountedVolume>& double_counted,
                 Figures& figures);

/// Throws InputError unless `output` is empty or the name of a format that write_solids() writes.
void check_output(const std::string& output);
/// Writes solids as X.glb, X.png, or a folder of .obj files, with their origin at `origin`. Moves
/// them apart by `explode` times their distance from the common middle; by default 0.3 for a
/// picture and 0 otherwise. Marks of faces are indices into `appearances` plus one. Returns the
/// number of pieces whose inner walls should be removed but are kept, as their surface would be
/// open. Throws InputError.
std::size_t write_solids(const std::string& output, const std::vector<Compound>& solids,
                         const std::vector<Material>& materials,
                         std::vector<Appearance> appearances, std::optional<double> explode,
                         Walls walls, const Vec3& origin);
/// Returns one material with the colours of limestone, for solids without a given material.
std::vector<Material> stone();
/// Returns materials with colours that are easy to distinguish.
std::vector<Material> palette();

}  // namespace sunder::app
