// Break cases as text. Each write function is followed by its read function.
#include "fracture/check/case_file.h"

#include <charconv>
#include <cmath>
#include <cstdlib>
#include <iomanip>
#include <istream>
#include <ostream>
#include <type_traits>

#include "engine/base/check.h"
#include "engine/geometry/approximate_hull.h"
#include "engine/geometry/polygon_mesh.h"

namespace sunder::fracture {
namespace {

constexpr const char* kFirstLine = "sunder-break-case-4";
constexpr std::uint64_t kMost = 10000000;  // Limit of all counts.

class Writer {
 public:
  explicit Writer(std::ostream& out) : out_(out) {}

  void word(const std::string& text) { out_ << text << ' '; }
  /// Writes a number, the coefficients of a matrix, or any value that a stream accepts.
  template <class T>
  void put(const T& value) {
    if constexpr (std::is_floating_point_v<T>) {
      put_number(value);
    } else if constexpr (requires { value.derived().size(); }) {
      for (Eigen::Index i = 0; i < value.size(); ++i) put(value(i));
    } else {
      out_ << value << ' ';
    }
  }
  void end_line() { out_ << '\n'; }

 private:
  /// Writes a number like `std::hexfloat`, but faster than a stream.
  void put_number(double value) {
    char text[40];
    char* end = text;
    if (std::signbit(value)) *end++ = '-';
    if (std::isfinite(value)) *end++ = '0', *end++ = 'x';
    end = std::to_chars(end, text + sizeof text, std::abs(value), std::chars_format::hex).ptr;
    *end++ = ' ';
    out_.write(text, end - text);
  }

  std::ostream& out_;
};

class Reader {
 public:
  Reader(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}

  void expect(const std::string& wanted) {
    if (word() != wanted) fail("'" + wanted + "' was expected");
  }
  std::string word() {
    std::string text;
    if (!(in_ >> text)) fail("the file ends too early");
    return text;
  }
  double number() {
    const std::string text = word();
    char* end = nullptr;
    // Streams do not read hexadecimal numbers.
    const double value = std::strtod(text.c_str(), &end);
    if (*end != 0 || std::isnan(value)) fail("'" + text + "' is not a number");
    return value;
  }
  std::uint64_t integer(std::uint64_t most) {
    const std::string text = word();
    char* end = nullptr;
    const std::uint64_t value = std::strtoull(text.c_str(), &end, 10);
    if (*end != 0 || value > most)
      fail("'" + text + "' is not a whole number from 0 to " + std::to_string(most));
    return value;
  }
  std::uint32_t index(std::size_t count) {
    if (count == 0) fail("an index refers to an empty list");
    return static_cast<std::uint32_t>(integer(count - 1));
  }
  template <class Matrix>
  Matrix matrix() {
    Matrix result;
    for (Eigen::Index i = 0; i < result.size(); ++i) {
      result(i) = static_cast<typename Matrix::Scalar>(number());
    }
    return result;
  }
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(name_ + ": " + what +
                     "; the file is not a valid case of a break; write it again");
  }

 private:
  std::istream& in_;
  std::string name_;
};

/// Writes the id, kind and plane of a face of a polyhedron or mesh.
template <class Face>
void write_plane(Writer& out, const Face& face) {
  out.put(face.id.value);
  out.put(face.kind == FaceKind::kInterior ? 1 : 0);
  out.put(face.plane.normal);
  out.put(face.plane.d);
}

template <class Face>
Face read_plane(Reader& in) {
  Face face;
  face.id.value = in.integer(~std::uint64_t{0});
  face.kind = in.integer(1) == 1 ? FaceKind::kInterior : FaceKind::kSurface;
  face.plane.normal = in.matrix<Vec3>();
  face.plane.d = in.number();
  return face;
}

void write_polyhedron(Writer& out, const ConvexPolyhedron& polyhedron) {
  for (const Vec3& vertex : polyhedron.vertices) out.put(vertex);
  out.end_line();
  for (const ConvexPolyhedron::Face& face : polyhedron.faces) {
    write_plane(out, face);
    out.put(face.corner_count);
    for (std::uint32_t c = face.first_corner; c < face.first_corner + face.corner_count; ++c) {
      out.put(polyhedron.corners[c]);
      out.put(polyhedron.corner_normals[c]);
    }
    out.end_line();
  }
}

ConvexPolyhedron read_polyhedron(Reader& in, std::uint64_t vertices, std::uint64_t faces) {
  ConvexPolyhedron polyhedron;
  for (std::uint64_t i = 0; i < vertices; ++i) polyhedron.vertices.push_back(in.matrix<Vec3>());
  for (std::uint64_t i = 0; i < faces; ++i) {
    auto face = read_plane<ConvexPolyhedron::Face>(in);
    face.first_corner = static_cast<std::uint32_t>(polyhedron.corners.size());
    face.corner_count = static_cast<std::uint32_t>(in.integer(vertices));
    for (std::uint32_t c = 0; c < face.corner_count; ++c) {
      polyhedron.corners.push_back(in.index(vertices));
      polyhedron.corner_normals.push_back(in.matrix<Vec3f>());
    }
    polyhedron.faces.push_back(face);
  }
  if (!is_closed(polyhedron)) in.fail("a convex is not closed");
  return polyhedron;
}

void write_mesh(Writer& out, const PolygonMesh& mesh) {
  for (const std::size_t count : {mesh.vertices.size(), mesh.faces.size(), mesh.contours.size(),
                                  mesh.corners.size(), mesh.corner_uvs.size()}) {
    out.put(count);
  }
  out.end_line();
  for (const Vec3& vertex : mesh.vertices) out.put(vertex);
  out.end_line();
  for (const PolygonMesh::Face& face : mesh.faces) {
    write_plane(out, face);
    out.put(face.contour_count);
  }
  out.end_line();
  for (const PolygonMesh::Contour& contour : mesh.contours) out.put(contour.corner_count);
  out.end_line();
  for (std::size_t c = 0; c < mesh.corners.size(); ++c) {
    out.put(mesh.corners[c]);
    out.put(mesh.corner_normals[c]);
    if (!mesh.corner_uvs.empty()) out.put(mesh.corner_uvs[c]);
  }
  out.end_line();
}

PolygonMesh read_mesh(Reader& in, std::uint64_t vertices) {
  const std::uint64_t faces = in.integer(kMost), contours = in.integer(kMost);
  const std::uint64_t corners = in.integer(kMost), uvs = in.integer(kMost);
  if (uvs != 0 && uvs != corners)
    in.fail("a mesh has texture coordinates for only some of its corners");
  PolygonMesh mesh;
  for (std::uint64_t i = 0; i < vertices; ++i) mesh.vertices.push_back(in.matrix<Vec3>());
  std::uint64_t next = 0;
  for (std::uint64_t i = 0; i < faces; ++i) {
    auto face = read_plane<PolygonMesh::Face>(in);
    face.first_contour = static_cast<std::uint32_t>(next);
    face.contour_count = static_cast<std::uint32_t>(in.integer(contours - next));
    if (face.contour_count == 0) in.fail("a face has no contour");
    next += face.contour_count;
    mesh.faces.push_back(face);
  }
  if (next != contours) in.fail("a mesh has contours that belong to no face");
  next = 0;
  for (std::uint64_t i = 0; i < contours; ++i) {
    const auto count = static_cast<std::uint32_t>(in.integer(corners - next));
    if (count < 3) in.fail("a contour has fewer than three corners");
    mesh.contours.push_back({static_cast<std::uint32_t>(next), count});
    next += count;
  }
  if (next != corners) in.fail("a mesh has corners that belong to no contour");
  for (std::uint64_t i = 0; i < corners; ++i) {
    mesh.corners.push_back(in.index(vertices));
    mesh.corner_normals.push_back(in.matrix<Vec3f>());
    if (uvs != 0) mesh.corner_uvs.push_back(in.matrix<Vec2f>());
  }
  if (open_edges(mesh) != 0) in.fail("a mesh is not closed");
  return mesh;
}

/// Returns the visual mesh of a convex; null if it has none.
std::shared_ptr<const PolygonMesh> read_visual(Reader& in) {
  in.expect("visual");
  const std::uint64_t vertices = in.integer(kMost);
  return vertices == 0 ? nullptr : std::make_shared<const PolygonMesh>(read_mesh(in, vertices));
}

void write_ghost(Writer& out, const Ghost& ghost) {
  const ConvexPolyhedron& polyhedron = ghost.convex->polyhedron;
  out.word("ghost");
  out.put(static_cast<int>(ghost.sign) + 1);
  out.put(ghost.of.size());
  for (const std::uint32_t of : ghost.of) out.put(of);
  out.put(ghost.convex->material.value);
  out.put(polyhedron.vertices.size());
  out.put(polyhedron.faces.size());
  write_polyhedron(out, polyhedron);
}

Ghost read_ghost(Reader& in, std::uint64_t convexes) {
  Ghost ghost;
  in.expect("ghost");
  ghost.sign = static_cast<std::int8_t>(static_cast<int>(in.integer(2)) - 1);
  const std::uint64_t count = in.integer(convexes);
  for (std::uint64_t i = 0; i < count; ++i) {
    ghost.of.push_back(in.index(convexes));
    if (i > 0 && ghost.of[i] <= ghost.of[i - 1]) in.fail("a ghost's convexes are out of order");
  }
  if (count == 0) in.fail("a ghost refers to no convex");
  const MaterialIndex material(in.integer(kMost));
  const std::uint64_t vertices = in.integer(kMost), faces = in.integer(kMost);
  ghost.convex = make_convex(read_polyhedron(in, vertices, faces), material);
  return ghost;
}

// Limits of a plug in a file.
constexpr std::uint64_t kMostPlugCorners = 64;
constexpr double kMostSlices = 1000;

void write_plug(Writer& out, const Plug& plug) {
  out.word("plug");
  out.put(plug.section_m.size());
  for (const Vec2& corner : plug.section_m) {
    out.put(corner.x());
    out.put(corner.y());
  }
  out.put(plug.depth_m);
  out.put(plug.through ? 1 : 0);
  out.put(plug.slice_m);
  out.put(plug.split ? 1 : 0);
  out.put(plug.rings);
  out.put(plug.reach_m);
  out.put(plug.clearance);
}

void write_command(Writer& out, const BreakCommand& command) {
  const PatternSpec& pattern = command.pattern;
  out.word("command");
  out.put(command.event);
  out.put(command.seed);
  out.put(command.radius_m);
  out.put(command.X_RP.position);
  out.put(command.X_RP.rotation.coeffs());
  out.put(command.stretch_P);
  out.word(name_of(command.fit));
  out.word("pattern");
  out.put(static_cast<int>(pattern.kind));
  for (const int count : {pattern.cells, pattern.rings, pattern.spokes, pattern.colors}) {
    out.put(count);
  }
  out.put(pattern.falloff);
  out.put(pattern.jitter);
  out.put(pattern.brick_m);
  out.put(std::quoted(pattern.file));
  out.word("spared");
  out.put(command.unbreakable.size());
  for (const MaterialIndex material : command.unbreakable) out.put(material.value);
  out.put(command.smallest_m3);
  write_plug(out, command.plug.value_or(Plug{}));
  out.end_line();
}

/// Reads a plug; files of earlier versions have none.
std::optional<Plug> read_plug(Reader& in, std::istream& stream) {
  stream >> std::ws;
  if (stream.eof()) return {};
  in.expect("plug");
  Plug plug;
  for (std::uint64_t left = in.integer(kMostPlugCorners); left > 0; --left) {
    const double x_m = in.number();
    plug.section_m.emplace_back(x_m, in.number());
  }
  plug.depth_m = in.number();
  plug.through = in.integer(1) != 0;
  plug.slice_m = in.number();
  plug.split = in.integer(1) != 0;
  plug.rings = static_cast<int>(in.integer(100));
  plug.reach_m = in.number();
  stream >> std::ws;
  if (!stream.eof()) plug.clearance = in.number();  // files of earlier versions have none
  if (plug.section_m.empty()) return {};
  const bool is_finite = std::ranges::all_of(
      plug.section_m, [](const Vec2& corner) { return corner.allFinite() && !corner.isZero(0); });
  if (plug.section_m.size() < 3 || !is_finite || !(plug.depth_m > 0) || !(plug.slice_m >= 0) ||
      !(plug.depth_m < kMostSlices * plug.slice_m || plug.slice_m == 0) ||
      !std::isfinite(plug.reach_m) || !(plug.clearance >= 1 && plug.clearance < 2))
    in.fail("the section or the depth of the plug is invalid");
  return plug;
}

BreakCommand read_command(Reader& in, std::istream& stream) {
  BreakCommand command;
  in.expect("command");
  command.event = in.integer(~std::uint64_t{0});
  command.seed = in.integer(~std::uint64_t{0});
  command.radius_m = in.number();
  command.X_RP.position = in.matrix<Vec3>();
  command.X_RP.rotation.coeffs() = in.matrix<Eigen::Vector4d>();
  command.stretch_P = in.matrix<Mat3>();
  // An infinite radius is allowed: it breaks the whole compound.
  if (!(command.radius_m > 0) || !command.X_RP.position.allFinite() ||
      !(std::abs(command.X_RP.rotation.norm() - 1) < 1e-6) || !command.stretch_P.allFinite() ||
      !(command.stretch_P.determinant() > 0)) {
    in.fail("the placement of the pattern is invalid");
  }
  const std::optional<Fit> fit = parse_fit(in.word());
  if (!fit) in.fail("unknown fit; allowed: " + std::string(kFitNames));
  command.fit = *fit;
  in.expect("pattern");
  PatternSpec& pattern = command.pattern;
  pattern.kind = static_cast<PatternSpec::Kind>(
      in.integer(static_cast<std::uint64_t>(PatternSpec::Kind::kFile)));
  const bool grid = pattern.kind == PatternSpec::Kind::kGrid;
  const auto count = [&](int least, std::uint64_t most) {
    const auto number = static_cast<int>(in.integer(most));
    if (number < least) in.fail("the pattern has no cells");
    return number;
  };
  pattern.cells = count(1, grid ? 30 : 5000);  // Limits as for scenes.
  pattern.rings = count(1, 100);
  pattern.spokes = count(1, 200);
  pattern.colors = count(0, 5000);
  pattern.falloff = in.number();
  pattern.jitter = in.number();
  pattern.brick_m = in.matrix<Vec3>();
  if (!(stream >> std::quoted(pattern.file))) in.fail("the pattern's file is missing");
  in.expect("spared");
  for (std::uint64_t left = in.integer(kMost); left > 0; --left) {
    command.unbreakable.emplace_back(in.integer(kMost));
  }
  command.smallest_m3 = in.number();
  command.plug = read_plug(in, stream);
  return command;
}

}  // namespace

void write_case(std::ostream& stream, const BreakCase& example) {
  Writer out(stream);
  const Compound& compound = example.compound;
  out.word(kFirstLine);
  out.put(compound.convexes.size());
  out.put(compound.bonds.size());
  out.put(compound.ghosts.size());
  out.end_line();
  for (std::size_t i = 0; i < compound.convexes.size(); ++i) {
    const Convex& convex = *compound.convexes[i];
    out.word("convex");
    out.put(convex.material.value);
    out.put(static_cast<unsigned>(compound.anchored[i]));
    out.put(convex.polyhedron.vertices.size());
    out.put(convex.polyhedron.faces.size());
    write_polyhedron(out, convex.polyhedron);
    out.word("visual");
    if (convex.visual) {
      write_mesh(out, *convex.visual);
    } else {
      out.put(0);
    }
  }
  for (const Ghost& ghost : compound.ghosts) write_ghost(out, ghost);
  for (const Bond& bond : compound.bonds) {
    for (const std::uint32_t value : {bond.a, bond.b, bond.face_a, bond.face_b}) out.put(value);
    out.put(bond.area_m2);
    out.end_line();
  }
  write_command(out, example.command);
}

BreakCase read_case(std::istream& stream, const std::string& name) {
  Reader in(stream, name);
  BreakCase example;
  Compound& compound = example.compound;
  in.expect(kFirstLine);
  const std::uint64_t convexes = in.integer(kMost), bonds = in.integer(kMost);
  const std::uint64_t ghosts = in.integer(kMost);
  for (std::uint64_t i = 0; i < convexes; ++i) {
    in.expect("convex");
    const MaterialIndex material(in.integer(kMost));
    compound.anchored.push_back(static_cast<std::uint8_t>(in.integer(kAnchoredAllSides)));
    const std::uint64_t vertices = in.integer(kMost), faces = in.integer(kMost);
    ConvexPolyhedron polyhedron = read_polyhedron(in, vertices, faces);
    compound.convexes.push_back(make_convex(std::move(polyhedron), material, read_visual(in)));
  }
  for (std::uint64_t i = 0; i < ghosts; ++i) compound.ghosts.push_back(read_ghost(in, convexes));
  for (std::uint64_t i = 0; i < bonds; ++i) {
    Bond bond;
    bond.a = in.index(convexes);
    bond.b = in.index(convexes);
    if (bond.a == bond.b) in.fail("a bond joins a convex to itself");
    bond.face_a = in.index(compound.convexes[bond.a]->polyhedron.faces.size());
    bond.face_b = in.index(compound.convexes[bond.b]->polyhedron.faces.size());
    bond.area_m2 = in.number();
    compound.bonds.push_back(bond);
  }
  example.command = read_command(in, stream);
  return example;
}

}  // namespace sunder::fracture
