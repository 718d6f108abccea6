// Procedural structures: what [[solid]] structure = "..." can name.
//
// Every structure is built around the middle of its foot: y = 0 is its lowest level, x and z are
// centred.
#pragma once

#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include "fracture/adjacency/compound_builder.h"
#include "scenes/file/keys.h"

namespace sunder::scenes {

/// One solid of a structure: parts that move as one, placed at `at`.
struct Piece {
  std::vector<fracture::Part> parts;
  Vec3 at = Vec3::Zero();
};

/// A kind of structure: its keys in the scene file and how it is built.
struct StructureType {
  std::string_view name;
  std::string_view help;
  std::vector<Key> keys;
  std::shared_ptr<void> (*parameters)();                ///< With their defaults.
  std::vector<Piece> (*build)(const void* parameters);  ///< Throws InputError without a place.
};

/// A structure whose parameters are a `P`.
template <class P, std::vector<Piece> (*build)(const P&)>
StructureType make_structure(std::string_view name, std::string_view help, std::vector<Key> keys) {
  return {name, help, std::move(keys),
          []() -> std::shared_ptr<void> { return std::make_shared<P>(); },
          [](const void* parameters) { return build(*static_cast<const P*>(parameters)); }};
}

/// All there are, by name.
std::span<const StructureType> structures();

StructureType box_structure();
StructureType brick_wall_structure();
StructureType bridge_structure();
StructureType column_structure();
StructureType hall_structure();
StructureType house_structure();
StructureType pane_structure();
StructureType reinforced_structure();
StructureType stack_structure();
StructureType temple_structure();
StructureType wheel_structure();

/// Throws InputError for more parts than any scene may hold.
void check_parts(double parts);

/// The box [min, max] cut into equal blocks no longer than `longest_m`, appended to `parts`. Throws
/// InputError for too many.
void add_blocks(std::vector<fracture::Part>& parts, const Vec3& min, const Vec3& max,
                double longest_m, MaterialIndex material);

}  // namespace sunder::scenes
