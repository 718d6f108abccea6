#include "tests/mesh/mesh_damage.h"

#include <algorithm>
#include <stdexcept>

#include "engine/base/random.h"
#include "tests/mesh/made_meshes.h"

namespace sunder::test {
namespace {

Polygon reversed(Polygon corners) {
  std::ranges::reverse(corners);
  return corners;
}

/// Returns a mesh with the vertices of `mesh` and other polygons.
RawMesh with_polygons(const RawMesh& mesh, const std::vector<Polygon>& polygons) {
  RawMesh result;
  result.vertices = mesh.vertices;
  for (const Polygon& corners : polygons) add(result, corners);
  return result;
}

Vec3 middle(const RawMesh& mesh) {
  Box box;
  for (const Vec3& vertex : mesh.vertices) box.extend(vertex);
  return box.center();
}

/// Returns a copy scaled towards a point.
RawMesh shrunk(RawMesh mesh, const Vec3& towards, double scale) {
  for (Vec3& vertex : mesh.vertices) vertex = towards + scale * (vertex - towards);
  return mesh;
}

RawMesh unjoined(const RawMesh& mesh, double nudge_m, Random& random) {
  RawMesh result;
  for (Polygon corners : polygons_of(mesh)) {
    for (std::uint32_t& corner : corners) {
      result.vertices.push_back(mesh.vertices[corner] + nudge_m * random.direction());
      corner = static_cast<std::uint32_t>(result.vertices.size() - 1);
    }
    add(result, corners);
  }
  return result;
}

/// Makes midpoints of some edges corners of one of the two polygons at the edge.
RawMesh with_t_junctions(const RawMesh& mesh, Random& random) {
  std::vector<Polygon> all = polygons_of(mesh);
  RawMesh result = mesh;
  for (Polygon& corners : all) {
    if (random.below(8) != 0) continue;
    const std::size_t edge = random.below(static_cast<std::uint32_t>(corners.size()));
    const Vec3& a = mesh.vertices[corners[edge]];
    const Vec3& b = mesh.vertices[corners[(edge + 1) % corners.size()]];
    result.vertices.push_back(0.5 * (a + b));
    corners.insert(corners.begin() + static_cast<std::ptrdiff_t>(edge) + 1,
                   static_cast<std::uint32_t>(result.vertices.size() - 1));
  }
  return with_polygons(result, all);
}

RawMesh with_fans(RawMesh mesh, Random& random) {
  const std::vector<Polygon> polygons = polygons_of(mesh);
  for (std::size_t p = 0; p < polygons.size(); ++p) {
    if (random.below(10) != 0) continue;
    const Polygon corners = polygons[p];
    for (std::uint32_t k = 0; k < 1 + random.below(3); ++k) {
      mesh.vertices.push_back(mesh.vertices[corners[0]] + 0.3 * random.direction());
      add(mesh, {corners[0], corners[1], static_cast<std::uint32_t>(mesh.vertices.size() - 1)});
    }
  }
  return mesh;
}

}  // namespace

const char* name_of(Damage damage) {
  constexpr const char* kNames[kDamages] = {
      "unjoined",    "nudged",  "degenerate", "duplicated", "doubled",     "partly_doubled",
      "t_junctions", "flipped", "inside_out", "fans",       "touching",    "nested",
      "cavity",      "hole",    "wide_hole",  "torn",       "overlapping", "tangled"};
  return kNames[static_cast<int>(damage)];
}

RawMesh damaged(const RawMesh& mesh, Damage damage, std::uint64_t seed) {
  Random random(seed, 77);
  RawMesh result = mesh;
  std::vector<Polygon> all = polygons_of(mesh);
  const auto some = [&] { return random.below(5) == 0; };
  const std::uint32_t first = all.empty() ? 0 : all[0][0];
  switch (damage) {
    case Damage::kUnjoined:
      return unjoined(mesh, 0, random);
    case Damage::kNudged:
      return unjoined(mesh, 1e-8, random);
    case Damage::kDegenerate:
      for (const Polygon& corners : all) {
        if (some()) add(result, {corners[0], corners[1], corners[1]});
        if (some()) add(result, {corners[0], corners[1], corners[0]});
      }
      return result;
    case Damage::kDuplicated:
      for (const Polygon& corners : all)
        if (some()) add(result, corners);
      return result;
    case Damage::kDoubled:
      for (const Polygon& corners : all) add(result, reversed(corners));
      return result;
    case Damage::kPartlyDoubled:
      for (const Polygon& corners : all)
        if (some()) add(result, reversed(corners));
      return result;
    case Damage::kTJunctions:
      return with_t_junctions(mesh, random);
    case Damage::kFlipped:
      for (Polygon& corners : all)
        if (some()) corners = reversed(corners);
      return with_polygons(mesh, all);
    case Damage::kInsideOut:
      for (Polygon& corners : all) corners = reversed(corners);
      return with_polygons(mesh, all);
    case Damage::kFans:
      return with_fans(mesh, random);
    case Damage::kTouching:
      append(result, shrunk(mesh, mesh.vertices[first] * 2 - middle(mesh), 0.5));
      return result;
    case Damage::kNested: {
      const RawMesh inner = shrunk(mesh, mesh.vertices[first], 0.5);
      append(result, inner);
      add(result, all[0]);
      return result;
    }
    case Damage::kCavity:
      append(result, damaged(shrunk(mesh, middle(mesh), 0.3), Damage::kInsideOut, seed));
      return result;
    case Damage::kHole:
      all.erase(all.begin() + random.below(static_cast<std::uint32_t>(all.size())));
      return with_polygons(mesh, all);
    case Damage::kWideHole: {
      const std::uint32_t vertex =
          mesh.corners[random.below(static_cast<std::uint32_t>(mesh.corners.size()))];
      std::erase_if(
          all, [&](const Polygon& corners) { return std::ranges::count(corners, vertex) > 0; });
      return with_polygons(mesh, all);
    }
    case Damage::kTorn:
      std::erase_if(all, [&](const Polygon&) { return random.below(3) == 0; });
      return with_polygons(mesh, all);
    case Damage::kOverlapping: {
      RawMesh copy = mesh;
      for (Vec3& vertex : copy.vertices) vertex += Vec3(0.4, 0.1, 0.05);
      append(result, copy);
      return result;
    }
    case Damage::kTangled:
      for (Vec3& vertex : result.vertices) vertex += 0.15 * random.uniform() * random.direction();
      return result;
  }
  throw std::out_of_range("no such damage");
}

RawMesh make_lattice_mesh(std::uint64_t seed) {
  Random random(seed, 78);
  RawMesh mesh;
  const auto at = [&](std::uint32_t most) { return static_cast<double>(random.below(most)); };
  for (std::uint32_t part = 0; part < 2 + random.below(6); ++part) {
    const Vec3 low(at(3), at(3), at(3));
    Vec3 high = low + Vec3(1 + at(2), 1 + at(2), 1 + at(2));
    if (random.below(8) == 0) high.y() = low.y();  // a plate without thickness
    RawMesh one = make_block(low, high, random.below(3) == 0);
    if (random.below(3) == 0) one = damaged(one, Damage::kHole, random.bits());
    if (random.below(4) == 0) one = damaged(one, Damage::kDoubled, random.bits());
    if (random.below(5) == 0) one = damaged(one, Damage::kInsideOut, random.bits());
    if (random.below(6) == 0) one = damaged(one, Damage::kFlipped, random.bits());
    if (random.below(6) == 0) one = damaged(one, Damage::kFans, random.bits());
    append(mesh, one);
    if (random.below(8) == 0) append(mesh, one);
  }
  return mesh;
}

RawMesh make_hard_mesh(std::uint64_t seed) {
  Random random(seed, 79);
  if (random.below(2) == 0) return make_lattice_mesh(seed);
  RawMesh mesh;
  switch (random.below(4)) {
    case 0:
      mesh = make_ball(8 + 4 * random.below(3));
      break;
    case 1:
      mesh = make_ring(12 + 6 * random.below(3));
      break;
    case 2:
      mesh = make_star(3 + random.below(6), random.uniform(0.2, 0.9));
      break;
    default:
      mesh = make_frame();
      break;
  }
  for (std::uint32_t i = 0; i < 1 + random.below(3); ++i)
    mesh = damaged(mesh, static_cast<Damage>(random.below(kDamages)), random.bits());
  return mesh;
}

}  // namespace sunder::test
