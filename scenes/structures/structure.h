// Procedural structures: what [[solid]] structure = "..." can name.
//
// Every structure is built around the middle of its foot: y = 0 is its lowest level, x and z are
// centred.
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

/// One solid of a structure: parts that move as one, placed at `at`; or, turned about y, so many
/// alike, which share their convexes.
struct Piece {
  std::vector<fracture::Part> parts;
  Vec3 at = Vec3::Zero();
  std::vector<Pose> copies = {Pose()};
};

/// What building needs to know of a scene.
struct Site {
  std::span<const Material> materials;
  std::filesystem::path folder;  ///< Where files are sought.
  std::vector<Paint>& paints;    ///< Of the scene, to append to, as are:
  std::vector<std::string>& warnings;
};

/// A kind of structure: its keys in the scene file and how it is built.
struct StructureType {
  std::string_view name;
  std::string_view help;
  std::vector<Key> keys;
  std::shared_ptr<void> (*parameters)();  ///< With their defaults.
  /// From parameters as the table says. Throws InputError.
  std::vector<Piece> (*build)(const void* parameters, const Value& table, const Site& site);
};

/// A structure whose parameters are a `P`, built from them alone; `build` throws InputError without
/// a place.
template <class P, std::vector<Piece> (*build)(const P&)>
StructureType make_structure(std::string_view name, std::string_view help, std::vector<Key> keys) {
  return {name, help, std::move(keys),
          []() -> std::shared_ptr<void> { return std::make_shared<P>(); },
          [](const void* parameters, const Value& table, const Site&) {
            try {
              return build(*static_cast<const P*>(parameters));
            } catch (const InputError& error) {
              throw InputError(table.where + ": " + error.what());
            }
          }};
}

/// All there are, by name.
std::span<const StructureType> structures();

/// The structure that a table called `name` asks for. The table may have `more` keys, which are
/// read by others. Throws InputError.
std::vector<Piece> read_structure(const Value& table, std::string_view name,
                                  const std::string& structure,
                                  std::initializer_list<std::span<const Key>> more,
                                  const Site& site);
/// Puts a block under every part that reaches the structure's lowest level; the world holds the
/// blocks. What yields goes on into the ground, as a bar does.
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

/// Throws InputError for more parts than any scene may hold.
void check_parts(double parts);
/// The same, with a place.
void check_parts(double parts, const Value& table);

/// The box [min, max] cut into equal blocks no longer than `longest_m`, appended to `parts`. Throws
/// InputError for too many.
void add_blocks(std::vector<fracture::Part>& parts, const Vec3& min, const Vec3& max,
                double longest_m, MaterialIndex material);
/// A convex polygon in x and y drawn out along z, half to either side, in slices no thicker than
/// `longest_m`, appended to `parts`. Throws InputError for too many.
void add_slices(std::vector<fracture::Part>& parts, std::span<const Vec2> corners, double depth_m,
                double longest_m, MaterialIndex material);

}  // namespace sunder::scenes
