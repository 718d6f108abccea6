#include "scenes/file/body.h"

#include <utility>

#include "engine/base/trigonometry.h"
#include "scenes/file/make_compound.h"
#include "scenes/file/mesh_solid.h"

namespace sunder::scenes {
namespace {

constexpr std::string_view kRepairs[] = {"auto", "off"};
constexpr std::string_view kAnchored[] = {"none", "bottom"};
/// What reaches this part of the height is the bottom.
constexpr double kBottom = 0.01;

Keys<BodyTable> make_body_keys() {
  constexpr Range kPlace{-1e6, 1e6}, kSpeed{-1e4, 1e4}, kTurn{-6.2832, 6.2832};
  return {"[[body]]",
          {key<&BodyTable::mesh>("mesh",
                                 "A file (.obj .ply .stl .off .gltf .glb) from the scene's folder "
                                 "on, or a built-in solid, such as torus:1,0.3.")
               .must(),
           key<&BodyTable::name>("name", "Shown in messages; the mesh's name by default."),
           key<&BodyTable::scale>("scale", "", Range{1e-6, 1e6}, "Of a file: one unit of it."),
           key<&BodyTable::size_m>("size_m", "m", Range{1e-3, 1e4},
                                   "Of a file, in place of scale: its longest side."),
           key<&BodyTable::nodes>("nodes", "Of its decomposition."),
           key<&BodyTable::convexes>("convexes", "", Range{0, 10000},
                                     "Most convexes of its decomposition; 0: what nodes make."),
           key<&BodyTable::fit>("fit", "Of its convexes: aabb, 14dop, 26dop or hull:N."),
           choice<&BodyTable::repair>("repair", kRepairs, "off: a mesh that needs it is refused."),
           key<&BodyTable::material>("material", "What it is made of."),
           key<&BodyTable::position>("position", "m", kPlace, "Where the middle of its foot is."),
           key<&BodyTable::rotation_rad>("rotation_rad", "rad", kTurn,
                                         "About the axes x, then y, then z, through its foot."),
           key<&BodyTable::velocity>("velocity", "m/s", kSpeed, "At the start."),
           key<&BodyTable::angular_velocity>("angular_velocity", "rad/s", kSpeed, "At the start."),
           choice<&BodyTable::anchored>("anchored", kAnchored,
                                        "bottom: the world holds its lowest parts.")}};
}

MeshOptions options_of(const BodyTable& given, const std::filesystem::path& folder) {
  MeshOptions options;
  options.nodes = given.nodes.file.empty() ? std::to_string(given.nodes.count)
                                           : (folder / given.nodes.file).string();
  if (given.nodes.file.empty() && given.nodes.count == 0) options.nodes.clear();
  options.convexes = given.convexes;
  options.fit = given.fit;
  options.repair = kRepairs[static_cast<std::size_t>(given.repair)];
  options.scale = given.scale;
  options.size_m = given.size_m;
  options.cached = true;
  return options;
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

const Keys<BodyTable>& body_keys() {
  static const Keys<BodyTable> kKeys = make_body_keys();
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

std::string default_name(const BodyTable& given) {
  return names_built_in(given.mesh) ? given.mesh
                                    : std::filesystem::path(given.mesh).stem().string();
}

std::vector<Solid> make_body(const BodyTable& given, const std::filesystem::path& folder) {
  const bool built_in = names_built_in(given.mesh);
  const std::string mesh = built_in ? given.mesh : (folder / given.mesh).string();
  Compound compound = make_compound(mesh, given.material.index, options_of(given, folder));
  if (given.anchored == Anchored::kBottom) anchor_bottom(compound);

  const Box box = bounds(compound);
  const Vec3 foot_R(box.center().x(), box.min.y(), box.center().z());
  Pose X_WR{given.position, rotation(given.rotation_rad)};
  X_WR.position -= X_WR.rotation * foot_R;
  std::vector<Solid> solids;
  for (Compound& part : split_islands(compound)) {
    solids.push_back({"", std::move(part), X_WR, given.velocity, given.angular_velocity});
  }
  return solids;
}

}  // namespace sunder::scenes
