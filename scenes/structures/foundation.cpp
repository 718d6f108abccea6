// Adds anchored foundation blocks under structures.
#include <algorithm>
#include <limits>

#include "scenes/structures/structure.h"

namespace sunder::scenes {
namespace {

constexpr double kFoundationDepth = 0.3;  // m

}  // namespace

void add_foundation(std::vector<Piece>& pieces, MaterialIndex foundation,
                    std::span<const Material> materials) {
  double bottom = std::numeric_limits<double>::max();
  for (const Piece& piece : pieces) {
    for (const fracture::Part& part : piece.parts) {
      bottom = std::min(bottom, piece.at.y() + bounds(part.polyhedron).min.y());
    }
  }
  for (Piece& piece : pieces) {
    const std::size_t count = piece.parts.size();
    for (std::size_t i = 0; i < count; ++i) {
      const Box box = bounds(piece.parts[i].polyhedron);
      if (piece.at.y() + box.min.y() > bottom + 1e-6) continue;
      const Vec3 max(box.max.x(), box.min.y(), box.max.z());
      const Vec3 min = box.min - Vec3(0, kFoundationDepth, 0);
      const MaterialIndex own = piece.parts[i].material;
      piece.parts.push_back(
          {make_box(min, max), materials[own.value].yields() ? own : foundation, true});
    }
  }
}

}  // namespace sunder::scenes
