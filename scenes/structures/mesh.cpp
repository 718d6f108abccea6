// The structure `mesh`: a decomposed mesh, for parts of a compound.
#include "scenes/file/body.h"
#include "scenes/file/moved_part.h"
#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

std::vector<Piece> build_mesh(const void* parameters, const Value& table,
                              const BuildContext& context) {
  try {
    MeshTable given = *static_cast<const MeshTable*>(parameters);
    read_named_materials(table, context.materials, given);
    const Compound compound =
        read_compound(given, context.folder, context.appearances, context.warnings);
    const Pose to_foot{-foot_of(compound), Quat::Identity()};
    Piece piece;
    for (Part& part : parts_of(compound)) piece.parts.push_back(moved(std::move(part), to_foot));
    return {piece};
  } catch (const InputError& error) {
    throw InputError(table.where + ": " + error.what());
  }
}

}  // namespace

StructureType mesh_structure() {
  return {"mesh", "A mesh, decomposed into convexes; for one mesh, a [[body]] is simpler.",
          mesh_keys().keys, []() -> std::shared_ptr<void> { return std::make_shared<MeshTable>(); },
          build_mesh};
}

}  // namespace sunder::scenes
