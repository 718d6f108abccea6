#include "scenes/file/body.h"

#include <utility>

#include "engine/base/trigonometry.h"
#include "fracture/adjacency/compound_builder.h"
#include "scenes/file/mesh_solid.h"

namespace sunder::scenes {
namespace {

constexpr std::string_view kRepairs[] = {"auto", "off"};
constexpr std::string_view kAnchored[] = {"none", "bottom"};
/// What reaches this part of the height is the bottom.
constexpr double kBottom = 0.01;

Keys<BodyText> make_body_keys() {
  constexpr Range kPlace{-1e6, 1e6}, kSpeed{-1e4, 1e4}, kTurn{-6.2832, 6.2832};
  return {"[[body]]",
          {key<&BodyText::mesh>("mesh",
                                "A file (.obj .ply .stl .off .gltf .glb) from the scene's folder "
                                "on, or a built-in solid, such as torus:1,0.3.")
               .must(),
           key<&BodyText::name>("name", "Shown in messages; the mesh's name by default."),
           key<&BodyText::scale>("scale", "", Range{1e-6, 1e6}, "Of a file: one unit of it."),
           key<&BodyText::size_m>("size_m", "m", Range{1e-3, 1e4},
                                  "Of a file, in place of scale: its longest side."),
           key<&BodyText::nodes>("nodes", "Of its decomposition."),
           key<&BodyText::convexes>("convexes", "", Range{0, 10000},
                                    "Most convexes of its decomposition; 0: what nodes make."),
           key<&BodyText::fit>("fit", "Of its convexes: aabb, 14dop, 26dop or hull:N."),
           choice<&BodyText::repair>("repair", kRepairs, "off: a mesh that needs it is refused."),
           key<&BodyText::material>("material", "What it is made of."),
           key<&BodyText::position>("position", "m", kPlace, "Where the middle of its foot is."),
           key<&BodyText::rotation_rad>("rotation_rad", "rad", kTurn,
                                        "About the axes x, then y, then z, through its foot."),
           key<&BodyText::velocity>("velocity", "m/s", kSpeed, "At the start."),
           key<&BodyText::angular_velocity>("angular_velocity", "rad/s", kSpeed, "At the start."),
           choice<&BodyText::anchored>("anchored", kAnchored,
                                       "bottom: the world holds its lowest parts.")}};
}

MeshOptions options_of(const BodyText& text, const std::filesystem::path& folder) {
  MeshOptions options;
  options.nodes = text.nodes.file.empty() ? std::to_string(text.nodes.count)
                                          : (folder / text.nodes.file).string();
  if (text.nodes.file.empty() && text.nodes.count == 0) options.nodes.clear();
  options.convexes = text.convexes;
  options.fit = text.fit;
  options.repair = kRepairs[static_cast<std::size_t>(text.repair)];
  options.scale = text.scale;
  options.size_m = text.size_m;
  options.cached = true;
  return options;
}

/// The same convexes, of another material.
void set_material(Compound& compound, MaterialIndex material) {
  for (ConvexPtr& convex : compound.convexes) {
    const auto changed = std::make_shared<Convex>(*convex);
    changed->material = material;
    convex = changed;
  }
  for (Ghost& ghost : compound.ghosts) {
    const auto changed = std::make_shared<Convex>(*ghost.convex);
    changed->material = material;
    ghost.convex = changed;
  }
}

void anchor_bottom(Compound& compound) {
  const Box box = bounds(compound);
  const double bottom = box.min.y() + kBottom * box.extent().y();
  for (std::size_t c = 0; c < compound.convexes.size(); ++c) {
    if (compound.convexes[c]->box.min.y() <= bottom) {
      compound.anchored[c] = anchor_side(1, false);
    }
  }
}

}  // namespace

const Keys<BodyText>& body_keys() {
  static const Keys<BodyText> kKeys = make_body_keys();
  return kKeys;
}

Quat rotation(const Vec3& angles_rad) {
  Quat q = Quat::Identity();
  for (int axis = 0; axis < 3; ++axis) {
    const SinCos half = sin_cos(angles_rad[axis] / 2);
    const Vec3 v = half.sin * Vec3::Unit(axis);
    q = Quat(half.cos, v.x(), v.y(), v.z()) * q;
  }
  return q.normalized();
}

std::vector<Solid> make_body(const BodyText& text, const std::filesystem::path& folder) {
  const bool built_in = names_built_in(text.mesh);
  const std::string mesh = built_in ? text.mesh : (folder / text.mesh).string();
  MeshSolid made = make_mesh_solid(mesh, options_of(text, folder));
  set_material(made.compound, text.material.index);
  if (text.anchored == Anchored::kBottom) anchor_bottom(made.compound);

  const Box box = bounds(made.compound);
  const Vec3 foot_R(box.center().x(), box.min.y(), box.center().z());
  Pose X_WR{text.position, rotation(text.rotation_rad)};
  X_WR.position -= X_WR.rotation * foot_R;
  const std::string base =
      text.name.empty() ? (built_in ? text.mesh : std::filesystem::path(mesh).stem().string())
                        : text.name;
  std::vector<Solid> solids;
  for (Compound& part : fracture::split_islands(made.compound)) {
    solids.push_back({base, std::move(part), X_WR, text.velocity, text.angular_velocity});
  }
  for (std::size_t i = 0; solids.size() > 1 && i < solids.size(); ++i) {
    solids[i].name += "." + std::to_string(i);
  }
  return solids;
}

}  // namespace sunder::scenes
