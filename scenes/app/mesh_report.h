// What the commands on meshes have in common: what they say of their input, and where solids go.
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

/// The object `input`, and the list of warnings.
Figures input_figures(const scenes::MeshSolid& solid);
/// Prints the warnings.
void print_warnings(const scenes::MeshSolid& solid);
/// Two lines for people.
std::string input_summary(const scenes::MeshSolid& solid);

/// A line on what overlaps count twice; empty where they count nothing.
std::string doubled_summary(const std::optional<fracture::DoubledVolume>& doubled);
/// The figures of it; none where it could not be measured.
void add_doubled(const std::optional<fracture::DoubledVolume>& doubled, Figures& figures);

/// Throws InputError unless -o names something that can be written; nothing is fine.
void check_output(const std::string& output);
/// Writes solids as X.glb, X.png, or as a folder of .obj files, moved apart by `explode` times
/// their distance from the middle of all; if that is not said, in a picture only. Faces are marked
/// by `paints`. Returns the number of pieces whose walls are to be removed and could not. Throws
/// InputError.
std::size_t write_solids(const std::string& output, const std::vector<Compound>& solids,
                         const std::vector<Material>& materials, std::vector<Paint> paints,
                         std::optional<double> explode, Walls walls);
/// Limestone, for solids that nobody gave a material.
std::vector<Material> stone();
/// Colours that are easily told apart.
std::vector<Material> palette();

}  // namespace sunder::app
