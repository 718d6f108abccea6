// What the commands on meshes have in common: what they say of their input, and where solids go.
#pragma once

#include <span>
#include <string>

#include "engine/io/figures.h"
#include "scenes/mesh_solid.h"

namespace sunder::app {

/// The object `input`.
Figures input_figures(const scenes::MeshSolid& solid);
/// Two lines for people.
std::string input_summary(const scenes::MeshSolid& solid);

/// Throws InputError unless -o names something that can be written; nothing is fine.
void check_output(const std::string& output);
/// Writes solids as X.glb, or as a folder of .obj files, moved apart by `explode` times their
/// distance from the middle. Throws InputError.
void write_solids(const std::string& output, std::span<const Compound> solids, double explode);

}  // namespace sunder::app
