// Procedural structures, which [[solid]] structure = "..." names.
//
// Every structure is built about the middle of its foot: its lowest level is y = 0, and it is
// centred in x and z.
#pragma once

#include <filesystem>
#include <initializer_list>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "engine/base/check.h"
#include "fracture/adjacency/compound_builder.h"
#include "scenes/file/keys.h"

namespace sunder::scenes {

/// Parts of a structure that move as one, and the copies of them, which share their convexes.
struct Piece {
  std::vector<fracture::Part> parts;
  Vec3 at = Vec3::Zero();               ///< Position of the parts' origin in each copy.
  std::vector<Pose> copies = {Pose()};  ///< Poses of the copies, rotated about y.
};

/// Data of a scene for builders of structures.
struct BuildContext {
  std::span<const Material> materials;
  std::filesystem::path folder;          ///< Folder in which files are sought.
  std::vector<Appearance>& appearances;  ///< Appearances of the scene; builders append to them.
  std::vector<std::string>& warnings;    ///< Warnings of the scene; builders append to them.
};

/// A kind of structure: its keys in the scene file, and its builder.
struct StructureType {
  std::string_view name;
  std::string_view help;
  std::vector<Key> keys;
  std::shared_ptr<void> (*parameters)();  ///< Returns new parameters with their defaults.
  /// Builds the structure from parameters, which were read from the table. Throws InputError with
  /// file and line.
  std::vector<Piece> (*build)(const void* parameters, const Value& table,
                              const BuildContext& context);
};

/// Returns a structure that is built from its parameters, a `P`, alone; `build` throws InputError
/// without file and line.
template <class P, std::vector<Piece> (*build)(const P&)>
StructureType make_structure(std::string_view name, std::string_view help, std::vector<Key> keys) {
  return {name, help, std::move(keys),
          []() -> std::shared_ptr<void> { return std::make_shared<P>(); },
          [](const void* parameters, const Value& table, const BuildContext&) {
            try {
              return build(*static_cast<const P*>(parameters));
            } catch (const InputError& error) {
              throw InputError(table.where + ": " + error.what());
            }
          }};
}

/// Returns all kinds of structures, sorted by name.
std::span<const StructureType> structures();

/// Builds the structure of a table, which errors call `name`. The table may also have the keys in
/// `more`, which the caller reads. Throws InputError.
std::vector<Piece> read_structure(const Value& table, std::string_view name,
                                  const std::string& structure,
                                  std::initializer_list<std::span<const Key>> more,
                                  const BuildContext& context);
/// Adds an anchored block under every part that reaches the structure's lowest level. The block is
/// of the material `foundation`, or of the part's own material if that yields, as a steel bar that
/// continues into the ground.
void add_foundation(std::vector<Piece>& pieces, MaterialIndex foundation,
                    std::span<const Material> materials);

StructureType arch_structure();
StructureType arena_structure();
StructureType box_structure();
StructureType brick_wall_structure();
StructureType bridge_structure();
StructureType column_structure();
StructureType compound_structure();
StructureType hall_structure();
StructureType house_structure();
StructureType mesh_structure();
StructureType pane_structure();
StructureType prism_structure();
StructureType reinforced_structure();
StructureType stack_structure();
StructureType temple_structure();
StructureType terrain_structure();
StructureType wheel_structure();

/// Throws InputError for more parts than any scene may have.
void check_parts(double parts);
/// Throws InputError with the place of the table for more parts than any scene may have.
void check_parts(double parts, const Value& table);

/// Appends the box [min, max], cut into equal blocks no longer than `longest_m`. Throws InputError
/// for too many.
void add_blocks(std::vector<fracture::Part>& parts, const Vec3& min, const Vec3& max,
                double longest_m, MaterialIndex material);
/// Appends a convex polygon in x and y that is extruded along z from -depth_m / 2 to depth_m / 2,
/// in slices no thicker than `longest_m`. Throws InputError for too many.
void add_slices(std::vector<fracture::Part>& parts, std::span<const Vec2> corners, double depth_m,
                double longest_m, MaterialIndex material);

}  // namespace sunder::scenes
