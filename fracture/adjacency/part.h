// What a compound is made of, before it is known what touches what.
#pragma once

#include <cstdint>
#include <memory>

#include "engine/model/compound.h"

namespace sunder::fracture {

/// A convex on its way into a compound.
struct Part {
  ConvexPolyhedron polyhedron;
  MaterialIndex material;
  std::uint8_t anchored = 0;  ///< As in Compound: `true` is anchored from below.
  std::shared_ptr<const PolygonMesh> visual = nullptr;  ///< As in Convex.
};

}  // namespace sunder::fracture
