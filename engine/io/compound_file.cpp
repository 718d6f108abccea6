#include "engine/io/compound_file.h"

#include <utility>

#include "engine/geometry/polygon_mesh.h"

namespace sunder {
namespace {

/// Reads a list of indices; throws InputError unless all are below `limit`.
std::vector<std::uint32_t> take_indices(ByteReader& in, std::size_t limit,
                                        const std::string& file) {
  std::vector<std::uint32_t> list = in.take_list<std::uint32_t>();
  for (const std::uint32_t index : list) {
    if (index >= limit) throw InputError(file + ": corrupt: an index is out of range");
  }
  return list;
}

/// Writes the plane, id and kind of a face.
template <class Face>
void put_plane(ByteWriter& out, const Face& face) {
  out.put(face.plane.normal, face.plane.d, face.id.value, static_cast<std::uint8_t>(face.kind));
}
template <class Face>
void take_plane(ByteReader& in, Face& face) {
  in.take_to(face.plane.normal, face.plane.d, face.id.value);
  face.kind = in.take<std::uint8_t>() == 0 ? FaceKind::kSurface : FaceKind::kInterior;
}

void check(bool good, const std::string& file) {
  if (!good)
    throw InputError(file + ": corrupt: the counts of a surface do not match; delete the file");
}

void put(ByteWriter& out, const ConvexPolyhedron& shape) {
  out.put_list(shape.vertices);
  out.put_list(shape.corners);
  out.put_list(shape.corner_normals);
  out.put(static_cast<std::uint32_t>(shape.faces.size()));
  for (const ConvexPolyhedron::Face& face : shape.faces) {
    put_plane(out, face);
    out.put(face.first_corner, face.corner_count);
  }
}

ConvexPolyhedron take_polyhedron(ByteReader& in, const std::string& file) {
  ConvexPolyhedron shape;
  shape.vertices = in.take_list<Vec3>();
  shape.corners = take_indices(in, shape.vertices.size(), file);
  shape.corner_normals = in.take_list<Vec3f>();
  shape.faces.resize(in.take_count(8));
  std::size_t corners = 0;
  for (ConvexPolyhedron::Face& face : shape.faces) {
    take_plane(in, face);
    in.take_to(face.first_corner, face.corner_count);
    check(face.first_corner == corners && face.corner_count >= 3, file);
    corners += face.corner_count;
  }
  check(corners == shape.corners.size() && corners == shape.corner_normals.size(), file);
  check(is_closed(shape), file);
  return shape;
}

void put(ByteWriter& out, const PolygonMesh& mesh) {
  out.put_list(mesh.vertices);
  out.put_list(mesh.corners);
  out.put_list(mesh.corner_normals);
  out.put_list(mesh.corner_uvs);
  out.put(static_cast<std::uint32_t>(mesh.contours.size()));
  for (const PolygonMesh::Contour& contour : mesh.contours) out.put(contour.corner_count);
  out.put(static_cast<std::uint32_t>(mesh.faces.size()));
  for (const PolygonMesh::Face& face : mesh.faces) {
    put_plane(out, face);
    out.put(face.contour_count, face.appearance);
  }
}

PolygonMesh take_mesh(ByteReader& in, const std::string& file) {
  PolygonMesh mesh;
  mesh.vertices = in.take_list<Vec3>();
  mesh.corners = take_indices(in, mesh.vertices.size(), file);
  mesh.corner_normals = in.take_list<Vec3f>();
  mesh.corner_uvs = in.take_list<Vec2f>();
  mesh.contours.resize(in.take_count(4));
  std::size_t corners = 0, contours = 0;
  for (PolygonMesh::Contour& contour : mesh.contours) {
    contour.first_corner = static_cast<std::uint32_t>(corners);
    contour.corner_count = in.take<std::uint32_t>();
    check(contour.corner_count >= 3, file);
    corners += contour.corner_count;
  }
  mesh.faces.resize(in.take_count(8));
  for (PolygonMesh::Face& face : mesh.faces) {
    take_plane(in, face);
    face.first_contour = static_cast<std::uint32_t>(contours);
    in.take_to(face.contour_count, face.appearance);
    check(face.contour_count >= 1, file);
    contours += face.contour_count;
  }
  check(contours == mesh.contours.size() && corners == mesh.corners.size(), file);
  check(corners == mesh.corner_normals.size(), file);
  check(mesh.corner_uvs.empty() || corners == mesh.corner_uvs.size(), file);
  return mesh;
}

void put(ByteWriter& out, const Convex& convex) {
  out.put(convex.material.value);
  put(out, convex.polyhedron);
  out.put(static_cast<std::uint8_t>(convex.visual ? 1 : 0));
  if (convex.visual) put(out, *convex.visual);
}

ConvexPtr take_convex(ByteReader& in, const std::string& file) {
  const MaterialIndex material(in.take<std::uint32_t>());
  ConvexPolyhedron shape = take_polyhedron(in, file);
  std::shared_ptr<const PolygonMesh> visual;
  if (in.take<std::uint8_t>() != 0) visual = std::make_shared<PolygonMesh>(take_mesh(in, file));
  return make_convex(std::move(shape), material, std::move(visual));
}

}  // namespace

void put(ByteWriter& out, const Compound& compound) {
  out.put(static_cast<std::uint32_t>(compound.convexes.size()));
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    put(out, *compound.convexes[c]);
    out.put(compound.anchored[c]);
  }
  out.put(static_cast<std::uint32_t>(compound.bonds.size()));
  for (const Bond& bond : compound.bonds) {
    out.put(bond.a, bond.b, bond.face_a, bond.face_b, bond.area_m2);
  }
  out.put(static_cast<std::uint32_t>(compound.ghosts.size()));
  for (const Ghost& ghost : compound.ghosts) {
    put(out, *ghost.convex);
    out.put_list(ghost.of);
    out.put(ghost.sign);
  }
}

Compound take_compound(ByteReader& in, const std::string& file) {
  Compound compound;
  compound.convexes.resize(in.take_count(8));
  for (ConvexPtr& convex : compound.convexes) {
    convex = take_convex(in, file);
    compound.anchored.push_back(in.take<std::uint8_t>());
  }
  const auto faces = [&](std::uint32_t c) {
    check(c < compound.convexes.size(), file);
    return compound.convexes[c]->polyhedron.faces.size();
  };
  compound.bonds.resize(in.take_count(24));
  for (Bond& bond : compound.bonds) {
    in.take_to(bond.a, bond.b, bond.face_a, bond.face_b, bond.area_m2);
    check(bond.a < bond.b && bond.face_a < faces(bond.a) && bond.face_b < faces(bond.b), file);
  }
  compound.ghosts.resize(in.take_count(8));
  for (Ghost& ghost : compound.ghosts) {
    ghost.convex = take_convex(in, file);
    ghost.of = take_indices(in, compound.convexes.size(), file);
    ghost.sign = in.take<std::int8_t>();
  }
  return compound;
}

}  // namespace sunder
