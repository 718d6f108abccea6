#include "render/view_mode.h"

#include <algorithm>
#include <array>
#include <iterator>

#include "engine/base/check.h"
#include "engine/base/hash.h"

namespace sunder::render {
namespace {

constexpr std::array<const char*, 6> kNames = {"materials", "convexes",  "compounds",
                                               "asleep",    "wireframe", "exploded"};

/// Linear RGB. The first three are for what is held, what is awake and what is asleep.
const std::array<Vec3f, 12> kColors = {
    Vec3f(0.25f, 0.25f, 0.25f), Vec3f(0.8f, 0.25f, 0.05f),  Vec3f(0.08f, 0.2f, 0.6f),
    Vec3f(0.1f, 0.45f, 0.12f),  Vec3f(0.75f, 0.6f, 0.08f),  Vec3f(0.4f, 0.1f, 0.5f),
    Vec3f(0.1f, 0.5f, 0.5f),    Vec3f(0.75f, 0.12f, 0.25f), Vec3f(0.45f, 0.28f, 0.12f),
    Vec3f(0.6f, 0.62f, 0.6f),   Vec3f(0.85f, 0.4f, 0.45f),  Vec3f(0.3f, 0.6f, 0.05f)};
enum : std::uint32_t { kHeld, kAwake, kSleeping };

/// How far each is moved, in its distance from the middle.
constexpr double kApart = 0.5;

}  // namespace

ViewMode::ViewMode(const std::string& name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) {
    throw InputError("--view-mode " + name + ": expected " + kViewModes);
  }
  kind_ = static_cast<Kind>(std::distance(kNames.begin(), found));
}

const Frame& ViewMode::shown(const Frame& frame) {
  if (kind_ == Kind::kMaterials) return frame;
  shown_ = frame;
  shown_.dust.clear();  // it would veil what is to be seen
  if (kind_ == Kind::kExploded) {
    move_apart();
  } else {
    color(frame);
  }
  return shown_;
}

std::uint32_t ViewMode::color_of(const Instance& instance, const FrameBody& body) const {
  if (kind_ == Kind::kAsleep) return body.is_static ? kHeld : body.asleep ? kSleeping : kAwake;
  const std::uint64_t part = kind_ == Kind::kConvexes ? instance.mesh.value : 0;
  return static_cast<std::uint32_t>(combine(body.key, part) % kColors.size());
}

/// The mesh in a colour; made once.
MeshIndex ViewMode::colored(const std::shared_ptr<const Mesh>& mesh, MaterialIndex material) {
  const auto [entry, is_new] =
      colored_.try_emplace({mesh, material.value}, MeshIndex(meshes_.size()));
  if (is_new) {
    auto copy = std::make_shared<Mesh>(*mesh);
    copy->material = material;
    for (Mesh::Vertex& vertex : copy->vertices) vertex.look = Mesh::kSurface;
    copy->uvs.clear();
    meshes_.push_back(std::move(copy));
  }
  return entry->second;
}

/// Every piece in one colour, outside and inside; the ground as it is.
void ViewMode::color(const Frame& frame) {
  if (frame.materials != given_materials_) {
    given_materials_ = frame.materials;
    std::vector<Material> materials = *frame.materials;
    for (const Vec3f& color : kColors) {
      Material& plain = materials.emplace_back();
      plain.surface.color = plain.interior.color = color;
    }
    materials_ = std::make_shared<const std::vector<Material>>(std::move(materials));
  }
  for (Instance& instance : shown_.instances) {
    const FrameBody& body = frame.bodies[instance.body];
    const std::shared_ptr<const Mesh>& mesh = (*frame.meshes)[instance.mesh.value];
    const MaterialIndex plain(given_materials_->size() + color_of(instance, body));
    instance.mesh = colored(mesh, body.key == kGroundKey ? mesh->material : plain);
  }
  shown_.meshes = std::make_shared<const MeshStore>(meshes_);
  shown_.materials = materials_;
}

/// From the middle of all on the ground, so that nothing is moved into it.
void ViewMode::move_apart() {
  Box box;
  for (const FrameBody& body : shown_.bodies)
    if (body.key != kGroundKey) box.extend(body.X_WB.position);
  if (box.empty()) return;
  Vec3 middle = box.center();
  middle.y() = shown_.view.ground_m;
  for (FrameBody& body : shown_.bodies) {
    if (body.key == kGroundKey) continue;
    body.X_WB.position += kApart * (body.X_WB.position - middle);
  }
}

}  // namespace sunder::render
