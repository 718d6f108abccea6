#include "scenes/app/picture.h"

#include <cmath>
#include <utility>

#include "engine/model/frame.h"
#include "engine/model/piece_mesh.h"
#include "render/sinks.h"

namespace sunder::app {
namespace {

/// Returns a view of a whole box from the front, a little from above and from the right.
View view_of(const Box& box) {
  View view;
  const double radius = 0.5 * box.extent().norm();
  view.fov_rad = 0.6;
  view.target_W = box.center();
  const double distance = 1.05 * radius / std::sin(0.5 * view.fov_rad);
  view.eye_W = view.target_W + distance * Vec3(0.45, 0.35, 1).normalized();
  view.to_sun_W = Vec3(0.3, 1, 0.8);
  view.ground_m = box.min.y() - 0.02 * radius;
  return view;
}

}  // namespace

void draw_solids(const std::filesystem::path& file, std::span<const Compound> solids,
                 const std::vector<Material>& materials, std::vector<Appearance> appearances,
                 double explode) {
  Box all, shown;
  for (const Compound& solid : solids) all.extend(bounds(solid));
  Frame frame;
  auto meshes = std::make_shared<MeshStore>();
  for (const Compound& solid : solids) {
    const Box box = bounds(solid);
    const Vec3 offset = explode * (box.center() - all.center());
    shown.extend(Box{box.min + offset, box.max + offset});
    FrameBody body;
    body.key = frame.bodies.size() + 1;
    body.X_WB.position = offset;
    const auto hidden = hidden_faces(solid);
    for (std::size_t c = 0; c < solid.convexes.size(); ++c) {
      auto mesh = make_mesh(*solid.convexes[c], hidden[c]);
      if (!mesh) continue;
      frame.instances.push_back(
          {MeshIndex(meshes->size()), static_cast<std::uint32_t>(frame.bodies.size())});
      meshes->push_back(std::move(mesh));
    }
    frame.bodies.push_back(body);
  }
  frame.view = view_of(shown);
  frame.meshes = std::move(meshes);
  frame.materials = std::make_shared<std::vector<Material>>(materials);
  if (!appearances.empty())
    frame.appearances = std::make_shared<const std::vector<Appearance>>(std::move(appearances));
  const auto sink = render::make_picture_sink(file, render::RenderOptions());
  sink->take(std::make_shared<Frame>(std::move(frame)));
  sink->finish();
}

}  // namespace sunder::app
