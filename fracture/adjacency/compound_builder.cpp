#include "fracture/adjacency/compound_builder.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "engine/geometry/polygon_mesh.h"
#include "engine/model/piece_mesh.h"
#include "fracture/adjacency/adjacency.h"
#include "fracture/adjacency/flush_caps.h"
#include "fracture/adjacency/islands.h"
#include "fracture/adjacency/overlap.h"

namespace sunder::fracture {
namespace {

constexpr double kParallel = 1e-6;  // Length of the sum of two opposite unit normals.

/// Sets of coplanar faces: a union-find structure in which every face also stores its side of the
/// plane relative to its parent.
class Planes {
 public:
  explicit Planes(std::size_t faces) : parent_(faces), flipped_(faces, 0), is_flush_(faces, 0) {
    for (std::size_t i = 0; i < faces; ++i) parent_[i] = static_cast<std::uint32_t>(i);
  }

  /// Joins the planes of two faces, which are on opposite sides.
  void join_opposite(std::uint32_t a, std::uint32_t b) {
    join(a, b, 1);
    is_flush_[a] = is_flush_[b] = 1;
  }
  /// Joins the planes of two faces, which are on the same side.
  void join_level(std::uint32_t a, std::uint32_t b) { join(a, b, 0); }
  /// Returns true if a face was joined with one on the opposite side.
  bool is_flush(std::uint32_t face) const { return is_flush_[face] != 0; }

  std::pair<std::uint32_t, std::uint8_t> find(std::uint32_t face) const {
    std::uint8_t side = 0;
    for (; parent_[face] != face; face = parent_[face]) side ^= flipped_[face];
    return {face, side};
  }

 private:
  void join(std::uint32_t a, std::uint32_t b, std::uint8_t is_opposite) {
    const auto [root_a, side_a] = find(a);
    const auto [root_b, side_b] = find(b);
    if (root_a == root_b) return;
    const std::uint32_t low = std::min(root_a, root_b), high = std::max(root_a, root_b);
    parent_[high] = low;
    flipped_[high] = side_a ^ side_b ^ is_opposite;
  }

  std::vector<std::uint32_t> parent_;
  std::vector<std::uint8_t> flipped_, is_flush_;
};

/// Returns true if face `g` of `b` lies in `plane`, with the normal of that plane.
bool lies_in(const Plane& plane, const ConvexPolyhedron& b, std::size_t g, double tolerance) {
  if ((plane.normal - b.faces[g].plane.normal).squaredNorm() > kParallel * kParallel) return false;
  for (const std::uint32_t corner : b.face_corners(g)) {
    if (std::abs(plane.distance(b.vertices[corner])) > tolerance) return false;
  }
  return true;
}

/// Joins the planes of the faces of two convexes that lie in one plane: with opposite normals they
/// may touch, with equal ones a convex welded of parts of both has one face there.
void join_faces(const ConvexPolyhedron& a, std::uint32_t first_a, const ConvexPolyhedron& b,
                std::uint32_t first_b, double tolerance, Planes& planes) {
  for (std::uint32_t f = 0; f < a.faces.size(); ++f) {
    const Plane& plane = a.faces[f].plane;
    const Plane opposite = plane.flipped();
    // They can touch in face f only if all of b is beyond its plane.
    const bool may_touch = plane.distance(b.vertices[0]) >= -tolerance;
    for (std::uint32_t g = 0; g < b.faces.size(); ++g) {
      if (may_touch && lies_in(opposite, b, g, tolerance))
        planes.join_opposite(first_a + f, first_b + g);
      if (lies_in(plane, b, g, tolerance)) planes.join_level(first_a + f, first_b + g);
    }
  }
}

/// Returns a mesh whose caps have the new ids of the faces that they lie in; caps in no face get
/// unused ids, after `spare`.
std::shared_ptr<const PolygonMesh> caps_with_new_ids(const PolygonMesh& visual,
                                                     std::span<const PlaneId> old_ids,
                                                     const ConvexPolyhedron& renamed,
                                                     std::uint64_t& spare) {
  auto mesh = std::make_shared<PolygonMesh>(visual);
  for (std::size_t cap = first_cap(*mesh); cap < mesh->faces.size(); ++cap) {
    PlaneId& id = mesh->faces[cap].id;
    const auto old = std::find(old_ids.begin(), old_ids.end(), id);
    id = old == old_ids.end() ? PlaneId{2 * ++spare}
                              : renamed.faces[static_cast<std::size_t>(old - old_ids.begin())].id;
  }
  return mesh;
}

/// Assigns plane ids to all faces; faces in contact share a plane, and meshes get caps there.
void assign_plane_ids(std::vector<Part>& parts, const PartPairs& pairs, double tolerance) {
  std::vector<std::uint32_t> first_face;
  std::uint32_t faces = 0;
  for (const Part& part : parts) {
    first_face.push_back(faces);
    faces += static_cast<std::uint32_t>(part.polyhedron.faces.size());
  }
  Planes planes(faces);
  for (const auto& [i, j] : pairs) {
    join_faces(parts[i].polyhedron, first_face[i], parts[j].polyhedron, first_face[j], tolerance,
               planes);
  }
  std::uint64_t spare = faces;
  std::vector<PlaneId> old_ids;
  std::vector<std::uint32_t> flush;
  for (std::uint32_t i = 0; i < parts.size(); ++i) {
    old_ids.clear();
    flush.clear();
    for (std::uint32_t f = 0; f < parts[i].polyhedron.faces.size(); ++f) {
      PlaneId& id = parts[i].polyhedron.faces[f].id;
      old_ids.push_back(id);
      const auto [root, side] = planes.find(first_face[i] + f);
      id = {2 * (std::uint64_t{root} + 1) + side};
      if (planes.is_flush(first_face[i] + f)) flush.push_back(f);
    }
    std::shared_ptr<const PolygonMesh>& visual = parts[i].visual;
    if (!visual) continue;
    if (first_cap(*visual) < visual->faces.size())
      visual = caps_with_new_ids(*visual, old_ids, parts[i].polyhedron, spare);
    visual = with_flush_caps(std::move(visual), parts[i].polyhedron, flush, tolerance);
  }
}

/// Returns a mesh whose caps of one plane id show broken material; the mesh itself if they do.
std::shared_ptr<const PolygonMesh> with_inner_caps(std::shared_ptr<const PolygonMesh> visual,
                                                   PlaneId id) {
  for (std::size_t cap = first_cap(*visual); cap < visual->faces.size(); ++cap) {
    const PolygonMesh::Face& face = visual->faces[cap];
    if (face.id != id || face.kind == FaceKind::kInterior) continue;
    auto mesh = std::make_shared<PolygonMesh>(*visual);
    mesh->faces[cap].kind = FaceKind::kInterior;
    visual = std::move(mesh);
  }
  return visual;
}

/// Marks faces that a neighbour covers as interior: if exposed, they show broken material.
void mark_inner_faces(Compound& compound) {
  const auto hidden = hidden_faces(compound);
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    const Convex& convex = *compound.convexes[c];
    ConvexPolyhedron polyhedron = convex.polyhedron;
    std::shared_ptr<const PolygonMesh> visual = convex.visual;
    for (std::size_t f = 0; f < polyhedron.faces.size(); ++f) {
      if (!hidden[c][f]) continue;
      polyhedron.faces[f].kind = FaceKind::kInterior;
      if (visual) visual = with_inner_caps(std::move(visual), polyhedron.faces[f].id);
    }
    compound.convexes[c] = make_convex(std::move(polyhedron), convex.material, std::move(visual));
  }
}

}  // namespace

Compound make_compound(std::vector<Part> parts, double tolerance_m) {
  PartPairs pairs = find_pairs(parts, tolerance_m);
  PartPairs overlaps = find_overlaps(parts, pairs, tolerance_m);
  if (cut_deep_overlaps(parts, overlaps, tolerance_m)) {
    pairs = find_pairs(parts, tolerance_m);
    overlaps = find_overlaps(parts, pairs, tolerance_m);
  }
  assign_plane_ids(parts, pairs, tolerance_m);
  Compound compound;
  for (Part& part : parts) {
    compound.convexes.push_back(
        make_convex(std::move(part.polyhedron), part.material, std::move(part.visual)));
    compound.anchored.push_back(part.anchored);
  }
  compound.bonds = find_contacts(compound.convexes);
  compound.ghosts = find_ghosts(compound.convexes, overlaps, tolerance_m);
  mark_inner_faces(compound);
  return compound;
}

std::vector<Compound> split_islands(const Compound& compound) {
  const std::vector<std::uint32_t> island = find_islands(compound);
  const std::size_t count = compound.convexes.size();
  if (count == 0 || *std::max_element(island.begin(), island.end()) == 0) return {compound};
  std::vector<Compound> islands;
  std::vector<std::uint32_t> index(count);
  for (std::size_t c = 0; c < count; ++c) {
    if (island[c] == islands.size()) islands.emplace_back();
    Compound& part = islands[island[c]];
    index[c] = static_cast<std::uint32_t>(part.convexes.size());
    part.convexes.push_back(compound.convexes[c]);
    part.anchored.push_back(compound.anchored[c]);
  }
  for (Bond bond : compound.bonds) {
    std::vector<Bond>& bonds = islands[island[bond.a]].bonds;
    bond.a = index[bond.a];
    bond.b = index[bond.b];
    bonds.push_back(bond);
  }
  for (Ghost ghost : compound.ghosts) {
    std::vector<Ghost>& ghosts = islands[island[ghost.of[0]]].ghosts;
    for (std::uint32_t& c : ghost.of) c = index[c];
    ghosts.push_back(std::move(ghost));
  }
  return islands;
}

}  // namespace sunder::fracture
