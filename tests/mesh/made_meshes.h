// Test fixture: closed meshes made by formula.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "engine/geometry/raw_mesh.h"

namespace sunder::test {

/// Returns the names of closed meshes that need no repair; make_good() makes each of them.
std::vector<std::string> good_names();
/// Makes the mesh of a name. Throws std::out_of_range for a name that good_names() does not have.
RawMesh make_good(const std::string& name);

/// Makes a ball with waves, of `around` vertices about its axis.
RawMesh make_ball(std::uint32_t around);
/// Makes a ring of uneven thickness, of `along` vertices.
RawMesh make_ring(std::uint32_t along);
/// Makes a prism over a star.
RawMesh make_star(std::uint32_t points, double inner_radius);
/// Makes a square plate with a square hole, of quads.
RawMesh make_frame();
/// Makes a box, or half of one, with its lower corner at `low`.
RawMesh make_block(const Vec3& low, const Vec3& high, bool is_wedge);

using Polygon = std::vector<std::uint32_t>;  ///< Vertex indices of a RawMesh.
void add(RawMesh& mesh, const Polygon& corners);
std::vector<Polygon> polygons_of(const RawMesh& mesh);
void append(RawMesh& mesh, const RawMesh& other);

}  // namespace sunder::test
