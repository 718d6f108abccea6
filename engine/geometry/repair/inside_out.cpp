#include "engine/geometry/repair/inside_out.h"

#include <algorithm>
#include <cmath>
#include <compare>

namespace sunder {
namespace {

constexpr double kLinesAlong = 64;  // lines beside each other over the longest side
constexpr double kMaxTests = 2e7;   // most pairs of a line and an edge to test

/// A place where a line enters the mesh (sign 1) or leaves it (-1).
struct Crossing {
  std::uint32_t line = 0;
  double x = 0;
  std::int32_t sign = 0;
  auto operator<=>(const Crossing&) const = default;
};

/// The lines in x through the centres of the squares of a grid in y and z.
struct Lines {
  Vec2 low = Vec2::Zero();
  double spacing = 1;
  std::uint32_t count_y = 0, count_z = 0;

  Lines(const Box& box, double along)
      : low(box.min.y(), box.min.z()), spacing(box.extent().maxCoeff() / along) {
    count_y = static_cast<std::uint32_t>(std::ceil(box.extent().y() / spacing));
    count_z = static_cast<std::uint32_t>(std::ceil(box.extent().z() / spacing));
  }
  /// Returns the number of lines, of `count`, at distances below `distance` from the low side.
  std::uint32_t lines_below(double distance, std::uint32_t count) const {
    return static_cast<std::uint32_t>(
        std::clamp(std::ceil(distance / spacing - 0.5), 0.0, static_cast<double>(count)));
  }
};

/// The lines of a grid that may cross a face: [first_y, end_y) times [first_z, end_z).
struct Range {
  std::uint32_t first_y = 0, end_y = 0, first_z = 0, end_z = 0;
  double lines() const {
    return static_cast<double>(end_y - first_y) * static_cast<double>(end_z - first_z);
  }
};

Range lines_near(const PolygonMesh& mesh, const PolygonMesh::Face& face, const Lines& lines) {
  Box box;
  for (std::uint32_t c = 0; c < face.contour_count; ++c) {
    for (const std::uint32_t v : mesh.contour_corners(face.first_contour + c))
      box.extend(mesh.vertices[v]);
  }
  const double margin = lines.spacing * 1e-9;
  return {lines.lines_below(box.min.y() - lines.low.x() - margin, lines.count_y),
          lines.lines_below(box.max.y() - lines.low.x() + margin, lines.count_y),
          lines.lines_below(box.min.z() - lines.low.y() - margin, lines.count_z),
          lines.lines_below(box.max.z() - lines.low.y() + margin, lines.count_z)};
}

/// Returns how often a contour winds about a line in the direction of x. An edge gives the same
/// decision in both faces beside it, so that a closed surface is crossed as often in as out.
std::int32_t winding(const PolygonMesh& mesh, std::uint32_t contour, const Vec2& line) {
  std::int32_t turns = 0;
  const auto corners = mesh.contour_corners(contour);
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const Vec3& from = mesh.vertices[corners[c]];
    const Vec3& to = mesh.vertices[corners[(c + 1) % corners.size()]];
    const bool up = to.z() > line.y();
    if (up == (from.z() > line.y())) continue;
    const Vec3& low = up ? from : to;
    const Vec3& high = up ? to : from;
    const double side =
        (high.y() - low.y()) * (line.y() - low.z()) - (line.x() - low.y()) * (high.z() - low.z());
    if (side > 0) turns += up ? 1 : -1;
  }
  return turns;
}

}  // namespace

double inside_out_volume(const PolygonMesh& mesh) {
  const Box box = bounds(mesh);
  if (mesh.empty() || !(box.extent().minCoeff() > 0)) return 0;
  const auto tests = [&](const Lines& lines) {
    double sum = 0;
    for (const PolygonMesh::Face& face : mesh.faces) {
      double edges = 0;
      for (std::uint32_t c = 0; c < face.contour_count; ++c)
        edges += mesh.contours[face.first_contour + c].corner_count;
      sum += edges * lines_near(mesh, face, lines).lines();
    }
    return sum;
  };
  Lines lines(box, kLinesAlong);
  if (const double sum = tests(lines); sum > kMaxTests)
    lines = Lines(box, std::max(4.0, kLinesAlong * std::sqrt(kMaxTests / sum)));

  std::vector<Crossing> crossings;
  for (const PolygonMesh::Face& face : mesh.faces) {
    const Vec3& normal = face.plane.normal;
    if (normal.x() == 0) continue;
    const Range near = lines_near(mesh, face, lines);
    for (std::uint32_t z = near.first_z; z < near.end_z; ++z) {
      for (std::uint32_t y = near.first_y; y < near.end_y; ++y) {
        const Vec2 line = lines.low + lines.spacing * Vec2(y + 0.5, z + 0.5);
        std::int32_t turns = 0;
        for (std::uint32_t c = 0; c < face.contour_count; ++c)
          turns += winding(mesh, face.first_contour + c, line);
        if (turns == 0) continue;
        const double x =
            -(face.plane.d + normal.y() * line.x() + normal.z() * line.y()) / normal.x();
        // A face that is counter-clockwise seen along -x faces +x: the line leaves there.
        crossings.push_back({z * lines.count_y + y, x, -turns});
      }
    }
  }
  std::sort(crossings.begin(), crossings.end());

  double length = 0;
  std::int32_t depth = 0;
  for (std::size_t i = 0; i + 1 < crossings.size(); ++i) {
    depth += crossings[i].sign;
    if (crossings[i + 1].line != crossings[i].line) {
      depth = 0;
      continue;
    }
    if (depth < 0) length -= depth * (crossings[i + 1].x - crossings[i].x);
  }
  return length * lines.spacing * lines.spacing;
}

}  // namespace sunder
