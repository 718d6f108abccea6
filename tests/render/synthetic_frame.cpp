#include "tests/render/synthetic_frame.h"

#include <cmath>
#include <vector>

#include "engine/geometry/convex_polyhedron.h"
#include "engine/geometry/hull.h"
#include "engine/model/compound.h"
#include "engine/model/piece_mesh.h"

namespace sunder::render {
namespace {

Material make_material(const char* name, Texture texture, const Vec3f& surface,
                       const Vec3f& interior) {
  Material material;
  material.name = name;
  material.surface = {texture, surface};
  material.interior = {texture, interior};
  return material;
}

std::shared_ptr<const Mesh> mesh_of(ConvexPolyhedron polyhedron, Stuff stuff) {
  Convex convex;
  convex.box = bounds(polyhedron);
  convex.material = MaterialIndex(static_cast<std::size_t>(stuff));
  const std::vector<std::uint8_t> hidden(polyhedron.faces.size());
  convex.polyhedron = std::move(polyhedron);
  return make_mesh(convex, hidden);
}

}  // namespace

SyntheticFrame::SyntheticFrame() {
  frame.materials = std::make_shared<const std::vector<Material>>(std::vector<Material>{
      make_material("brick", Texture::kBrick, {0.42f, 0.15f, 0.075f}, {0.45f, 0.18f, 0.095f}),
      make_material("concrete", Texture::kConcrete, {0.42f, 0.41f, 0.38f}, {0.4f, 0.385f, 0.35f}),
      make_material("plaster", Texture::kPlaster, {0.68f, 0.64f, 0.56f}, {0.5f, 0.46f, 0.4f}),
      make_material("wood", Texture::kWood, {0.36f, 0.22f, 0.12f}, {0.5f, 0.34f, 0.2f}),
      make_material("steel", Texture::kMetal, {0.16f, 0.165f, 0.17f}, {0.3f, 0.3f, 0.3f}),
      make_material("glass", Texture::kGlass, {0.5f, 0.62f, 0.6f}, {0.62f, 0.8f, 0.76f})});
  frame.meshes = meshes_;
}

void SyntheticFrame::add(std::shared_ptr<const Mesh> mesh, const Vec3& com_R, const Pose& X_WB) {
  FrameBody body;
  body.key = frame.bodies.size();
  body.com_R = com_R;
  body.X_WB = X_WB;
  frame.instances.push_back(
      {MeshIndex(meshes_->size()), static_cast<std::uint32_t>(frame.bodies.size())});
  frame.bodies.push_back(body);
  meshes_->push_back(std::move(mesh));
}

void SyntheticFrame::add_box(const Vec3& min, const Vec3& max, Stuff stuff) {
  const Vec3 center = 0.5 * (min + max);
  add_box(min, max, stuff, {center, Quat::Identity()});
}

void SyntheticFrame::add_box(const Vec3& min, const Vec3& max, Stuff stuff, const Pose& X_WB) {
  add(mesh_of(make_box(min, max), stuff), 0.5 * (min + max), X_WB);
}

void SyntheticFrame::add_ball(const Vec3& center, double radius_m, Stuff stuff) {
  add(make_ball_mesh(radius_m, MaterialIndex(static_cast<std::size_t>(stuff))), Vec3::Zero(),
      {center, Quat::Identity()});
}

void SyntheticFrame::add_chunk(const Vec3& center, double size_m, Stuff stuff, Random& random) {
  const Vec3 half = 0.5 * size_m * Vec3(1, random.uniform(0.5, 1), random.uniform(0.5, 0.9));
  // Position of the chunk in the rest frame of the solid that it broke from.
  const Vec3 center_R(random.uniform(-9, 9), random.uniform(0, 6), random.uniform(-4, 4));
  std::vector<Vec3> points;
  for (int i = 0; i < 11; ++i) points.push_back(center_R + random.direction().cwiseProduct(half));
  ConvexPolyhedron polyhedron = make_hull(points);
  for (ConvexPolyhedron::Face& face : polyhedron.faces) {
    face.kind = random.below(5) > 0 ? FaceKind::kInterior : FaceKind::kSurface;
  }
  const Quat turn(Eigen::AngleAxisd(random.uniform(0, 6.28), random.direction()));
  add(mesh_of(std::move(polyhedron), stuff), center_R, {center, turn});
}

Frame house_frame(int chunks) {
  SyntheticFrame s;
  constexpr double kStorey = 2.9, kSlab = 0.22, kWall = 0.3;
  for (const int storey : {0, 1}) {
    const double y = storey * (kStorey + kSlab);
    const double top = y + kStorey;
    // Back wall, left wall, and the left part of the front with a window.
    s.add_box({-6, y, -3.5}, {6, top, -3.5 + kWall}, storey == 0 ? Stuff::kPlaster : Stuff::kBrick);
    s.add_box({-6, y, -3.5 + kWall}, {-6 + kWall, top, 3.5}, Stuff::kBrick);
    s.add_box({-6 + kWall, y, 3.2}, {-4.6, top, 3.5}, Stuff::kBrick);
    s.add_box({-4.6, y, 3.2}, {-3.2, y + 0.9, 3.5}, Stuff::kBrick);
    s.add_box({-4.6, y + 2.2, 3.2}, {-3.2, top, 3.5}, Stuff::kBrick);
    s.add_box({-3.2, y, 3.2}, {-1.5, top, 3.5}, Stuff::kBrick);
    // A pillar and a partition inside, the right wall's stump.
    s.add_box({1.5, y, -0.2}, {1.9, top, 0.2}, Stuff::kConcrete);
    s.add_box({5.7, y, -3.2}, {6, y + (storey == 0 ? kStorey : 1.2), 1}, Stuff::kBrick);
    s.add_box({-6.2, top, -3.7}, {6.2, top + kSlab, storey == 0 ? 1.5 : -0.5}, Stuff::kConcrete);
    s.add_box({-6.2, top, storey == 0 ? 1.5 : -0.5}, {-1.2, top + kSlab, 3.7}, Stuff::kConcrete);
  }
  s.add_box({-4.6, 0.9, 3.33}, {-3.2, 2.2, 3.36}, Stuff::kGlass);
  s.add_box({2.2, 0, -1}, {3.4, 1.9, -0.92}, Stuff::kWood);
  s.add_ball({2.4, 1.6, 4.5}, 0.45, Stuff::kSteel);
  s.add_ball({7.5, 0.6, 3}, 0.6, Stuff::kSteel);

  Random random(7);
  for (int i = 0; i < chunks; ++i) {
    const double x = random.uniform(-4, 8) + random.uniform(-1.5, 1.5);
    const double z = 1.2 + random.uniform(-1.5, 4.5) + random.uniform(-2, 2);
    const double heap = 1.6 * std::exp(-((x - 2.5) * (x - 2.5) / 12 + (z - 2) * (z - 2) / 4));
    const bool flies = random.below(40) == 0;
    const double size =
        flies ? random.uniform(0.1, 0.4) : 0.12 + 0.6 * std::pow(random.uniform(), 3.0);
    const double y = flies ? random.uniform(1, 6.5) : 0.3 * size + heap * random.uniform();
    const Stuff stuff = random.below(5) < 2    ? Stuff::kBrick
                        : random.below(4) == 0 ? Stuff::kPlaster
                                               : Stuff::kConcrete;
    s.add_chunk({x, y, z}, size, stuff, random);
  }
  s.frame.view.eye_W = {3.5, 2.6, 15};
  s.frame.view.target_W = {0.4, 2.6, 0};
  s.frame.view.fov_rad = 0.75;
  s.frame.view.to_sun_W = {-0.62, 0.62, 0.55};
  s.frame.report.counts.awake = static_cast<std::uint32_t>(chunks);
  return s.frame;
}

}  // namespace sunder::render
