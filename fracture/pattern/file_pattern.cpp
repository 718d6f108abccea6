// Patterns from files: an .obj of convex cells that fill a box around the impact.
//
// Cells are rebuilt from the planes of their faces, so that adjacent cells share one plane exactly,
// whatever the rounding in the file.
#include <cmath>
#include <istream>
#include <map>
#include <sstream>

#include "engine/base/check.h"
#include "fracture/pattern/pattern.h"

namespace sunder::fracture {
namespace {

constexpr std::size_t kMostCells = 1000, kMostVertices = 100000, kMostFaces = 20000;
constexpr double kSamePlane = 1e-6;  // Relative to the size of the box.
constexpr double kSameVolume = 1e-5;

struct Group {
  std::vector<std::vector<std::size_t>> faces;  ///< Indices of vertices.
  std::string material;
};

struct ObjCells {
  std::vector<Vec3> vertices;
  std::vector<Group> groups;
};

class ObjReader {
 public:
  ObjReader(std::istream& in, std::string name) : in_(in), name_(std::move(name)) {}

  ObjCells read() {
    std::string line;
    for (line_ = 1; std::getline(in_, line); ++line_) read_line(line);
    std::erase_if(cells_.groups, [](const Group& group) { return group.faces.empty(); });
    if (cells_.groups.empty()) fail("has no cells; each group (g or o) of faces is one");
    return std::move(cells_);
  }

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(name_ + ":" + std::to_string(line_) + ": " + what);
  }

 private:
  void read_line(const std::string& line) {
    std::istringstream words(line);
    std::string key;
    words >> key;
    if (key == "v") {
      read_vertex(words);
    } else if (key == "g" || key == "o") {
      if (cells_.groups.size() > 4 * kMostCells) fail("has too many groups");
      cells_.groups.emplace_back();
    } else if (key == "usemtl") {
      if (cells_.groups.empty()) cells_.groups.emplace_back();
      words >> cells_.groups.back().material;
    } else if (key == "f") {
      read_face(words);
    }
  }

  void read_vertex(std::istream& words) {
    Vec3 vertex;
    if (!(words >> vertex.x() >> vertex.y() >> vertex.z()) || !vertex.allFinite()) {
      fail("a vertex needs three numbers");
    }
    if (cells_.vertices.size() == kMostVertices) fail("has too many vertices");
    cells_.vertices.push_back(vertex);
  }

  void read_face(std::istream& words) {
    if (cells_.groups.empty()) cells_.groups.emplace_back();
    if (++faces_ > kMostFaces) fail("has too many faces");
    std::vector<std::size_t> face;
    const auto count = static_cast<long long>(cells_.vertices.size());
    for (std::string word; words >> word;) {
      long long index = 0;
      std::istringstream number(word.substr(0, word.find('/')));
      if (!(number >> index)) fail("'" + word + "' is no vertex");
      if (index < 0) index += count + 1;
      if (index < 1 || index > count) fail("vertex " + word + " is not among those above");
      face.push_back(static_cast<std::size_t>(index - 1));
    }
    if (face.size() < 3) fail("a face needs three vertices");
    cells_.groups.back().faces.push_back(std::move(face));
  }

  std::istream& in_;
  std::string name_;
  std::size_t line_ = 0;
  std::size_t faces_ = 0;
  ObjCells cells_;
};

/// Builds a pattern from the cells of a file.
class Rebuilder {
 public:
  Rebuilder(const ObjCells& cells, std::string name) : cells_(cells), name_(std::move(name)) {
    for (const Group& group : cells_.groups) {
      for (const auto& face : group.faces) {
        for (const std::size_t vertex : face) box_.extend(cells_.vertices[vertex]);
      }
    }
    tolerance_ = kSamePlane * box_.extent().maxCoeff();
  }

  Pattern run() {
    if ((box_.min.array() >= 0).any() || (box_.max.array() <= 0).any()) {
      fail("the origin, where the impact is, must lie inside the cells' box");
    }
    if (box_.min.cwiseAbs().cwiseMax(box_.max).maxCoeff() >= Pattern::kHalfExtent) {
      fail("cells must lie within 16 units (radii of the impact) of the origin");
    }
    if (cells_.groups.size() > kMostCells) {
      fail("has more than " + std::to_string(kMostCells) + " cells");
    }
    pattern_.planes = box_planes();
    first_ = add_outer_cells(pattern_, box_);
    double volume = 0;
    for (const Group& group : cells_.groups) volume += add(group);
    if (std::abs(volume / box_.extent().prod() - 1) > kSameVolume) {
      fail("the cells do not fill their box: they overlap or leave gaps");
    }
    finish(pattern_);
    color();
    return std::move(pattern_);
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw InputError(name_ + ": " + what); }

  double add(const Group& group) {
    std::vector<PlaneId> sides;
    std::vector<Vec3> corners;
    Vec3 middle = Vec3::Zero();
    for (const auto& face : group.faces) {
      for (const std::size_t vertex : face) corners.push_back(cells_.vertices[vertex]);
    }
    for (const Vec3& corner : corners) middle += corner / static_cast<double>(corners.size());
    for (const auto& face : group.faces) {
      const Plane plane = plane_of(face, middle);
      for (const Vec3& corner : corners) {
        if (plane.distance(corner) > tolerance_) fail(label() + " is not convex");
      }
      sides.push_back(shared(plane, face));
    }
    ConvexPolyhedron cell = cut_cell(pattern_.planes, sides);
    const Box box = bounds(cell);
    const bool same_box = !cell.empty() &&
                          (box.min.array() >= box_.min.array() - 2 * tolerance_).all() &&
                          (box.max.array() <= box_.max.array() + 2 * tolerance_).all();
    if (!same_box) fail(label() + " is not closed");
    pattern_.cells.push_back({std::move(cell), 0, 0, false});
    return mass_properties(pattern_.cells.back().polyhedron).volume_m3;
  }

  std::string label() const { return "cell " + std::to_string(pattern_.cells.size() - 5); }

  /// Returns the plane of a face by Newell's normal, pointing away from the middle of the cell.
  Plane plane_of(const std::vector<std::size_t>& face, const Vec3& middle) const {
    Vec3 normal = Vec3::Zero(), center = Vec3::Zero();
    for (std::size_t i = 0; i < face.size(); ++i) {
      const Vec3& from = cells_.vertices[face[i]];
      const Vec3& to = cells_.vertices[face[(i + 1) % face.size()]];
      normal += (from - middle).cross(to - middle);
      center += from / static_cast<double>(face.size());
    }
    if (!(normal.norm() > 0)) fail(label() + " has a face without area");
    const Plane plane = Plane::through(center, normal.normalized());
    return plane.distance(middle) > 0 ? plane.flipped() : plane;
  }

  /// Returns the id of the plane, or of the plane of an earlier face if the face lies in that.
  PlaneId shared(const Plane& plane, const std::vector<std::size_t>& face) {
    for (std::uint32_t i = first_; i < pattern_.planes.size(); ++i) {
      const Plane& known = pattern_.planes[i];
      bool same = std::abs(std::abs(known.normal.dot(plane.normal)) - 1) < 1e-6;
      for (std::size_t k = 0; same && k < face.size(); ++k) {
        same = std::abs(known.distance(cells_.vertices[face[k]])) <= tolerance_;
      }
      if (same) return pattern_plane(i, known.normal.dot(plane.normal) < 0);
    }
    pattern_.planes.push_back(plane);
    return pattern_plane(static_cast<std::uint32_t>(pattern_.planes.size() - 1), false);
  }

  /// Gives the groups of one material one colour; other groups keep their own.
  void color() {
    std::map<std::string, std::uint32_t> colors;
    const std::size_t outer = pattern_.cells.size() - cells_.groups.size();
    for (std::size_t i = 0; i < cells_.groups.size(); ++i) {
      Cell& cell = pattern_.cells[outer + i];
      const std::string& material = cells_.groups[i].material;
      if (!material.empty()) cell.color = colors.emplace(material, cell.color).first->second;
    }
  }

  const ObjCells& cells_;
  std::string name_;
  Box box_;
  double tolerance_ = 0;
  Pattern pattern_;
  std::uint32_t first_ = 0;
};

}  // namespace

Pattern read_pattern(std::istream& obj, const std::string& name) {
  const ObjCells cells = ObjReader(obj, name).read();
  return Rebuilder(cells, name).run();
}

}  // namespace sunder::fracture
