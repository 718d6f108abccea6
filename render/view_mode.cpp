#include "render/view_mode.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "engine/base/check.h"
#include "engine/base/hash.h"

namespace sunder::render {
namespace {

constexpr std::array<const char*, 10> kNames = {"materials", "convexes",  "compounds", "asleep",
                                                "wireframe", "exploded",  "contacts",  "stress",
                                                "islands",   "broadphase"};

/// Colours in linear RGB. The first three stand for static, awake and sleeping bodies.
const std::array<Vec3f, 12> kColors = {
    Vec3f(0.25f, 0.25f, 0.25f), Vec3f(0.8f, 0.25f, 0.05f),  Vec3f(0.08f, 0.2f, 0.6f),
    Vec3f(0.1f, 0.45f, 0.12f),  Vec3f(0.75f, 0.6f, 0.08f),  Vec3f(0.4f, 0.1f, 0.5f),
    Vec3f(0.1f, 0.5f, 0.5f),    Vec3f(0.75f, 0.12f, 0.25f), Vec3f(0.45f, 0.28f, 0.12f),
    Vec3f(0.6f, 0.62f, 0.6f),   Vec3f(0.85f, 0.4f, 0.45f),  Vec3f(0.3f, 0.6f, 0.05f)};
enum : std::uint32_t { kStaticColor, kAwakeColor, kSleepingColor };
constexpr std::uint32_t kHeatSteps = 17;
/// Offsets in the palette: dim copies of kColors for sleeping bodies, then kHeatSteps heat colours.
constexpr std::uint32_t kFirstDim = kColors.size(), kFirstHeat = 2 * kColors.size();

/// Returns a heat colour, from blue at 0 through green and yellow to red at 1.
Vec3f heat(float t) {
  static const std::array<Vec3f, 5> kSteps = {Vec3f(0.03f, 0.08f, 0.5f), Vec3f(0.03f, 0.35f, 0.45f),
                                              Vec3f(0.08f, 0.45f, 0.08f), Vec3f(0.8f, 0.6f, 0.05f),
                                              Vec3f(0.8f, 0.05f, 0.02f)};
  const float place = std::clamp(t, 0.f, 1.f) * (kSteps.size() - 1);
  const auto step = std::min(static_cast<std::size_t>(place), kSteps.size() - 2);
  const float part = place - static_cast<float>(step);
  return (1 - part) * kSteps[step] + part * kSteps[step + 1];
}

/// Returns the palette: kColors, their dim copies and the heat colours.
std::vector<Vec3f> palette() {
  std::vector<Vec3f> colors(kColors.begin(), kColors.end());
  for (const Vec3f& color : kColors) colors.push_back(0.25f * color + Vec3f::Constant(0.02f));
  for (std::uint32_t i = 0; i < kHeatSteps; ++i)
    colors.push_back(heat(static_cast<float>(i) / (kHeatSteps - 1)));
  return colors;
}

std::uint32_t state_of(const FrameBody& body) {
  return body.is_static ? kStaticColor : body.asleep ? kSleepingColor : kAwakeColor;
}

// The size of a mark is proportional to the cube root of its force, as the size of a block is to
// that of its weight, so that images look alike at every scale.
constexpr float kMarkRadius_m = 0.006f;  // radius for 1 N
constexpr float kMarkAspect = 3;         // length along the force / radius
constexpr float kMaxDecades = 6;         // log10 of the force in N that is drawn red

Mark mark_of(const FrameContact& contact, float force_N) {
  const float radius = kMarkRadius_m * std::cbrt(force_N);
  const Vec3f along = contact.force_W / force_N;
  const Vec3f aside = along.unitOrthogonal();
  Mark mark;
  mark.center_W = contact.point_W;
  mark.half_axes_W.col(0) = kMarkAspect * radius * along;
  mark.half_axes_W.col(1) = radius * aside;
  mark.half_axes_W.col(2) = radius * along.cross(aside);
  mark.color = heat(std::log10(std::max(force_N, 1.f)) / kMaxDecades);
  return mark;
}

Mark mark_of(const FrameBox& box, const FrameBody& body) {
  Mark mark;
  mark.center_W = 0.5f * (box.min_W + box.max_W);
  mark.half_axes_W = (0.5f * (box.max_W - box.min_W)).asDiagonal();
  mark.color = kColors[state_of(body)] + Vec3f::Constant(0.1f);
  mark.hidden_opacity = 0.12f;
  return mark;
}

/// Displacement of each body in mode "exploded", as a fraction of its distance from the centre.
constexpr double kExplodedShift = 0.5;

}  // namespace

ViewMode::ViewMode(const std::string& name) : name_(name) {
  const auto found = std::ranges::find(kNames, name);
  if (found == kNames.end()) {
    throw InputError("--view-mode " + name + ": expected " + kViewModes);
  }
  kind_ = static_cast<Kind>(std::distance(kNames.begin(), found));
}

const Frame& ViewMode::shown(const Frame& frame) {
  if (kind_ == Kind::kMaterials) return frame;
  shown_ = frame;
  shown_.dust.clear();  // dust would hide the colours
  if (kind_ == Kind::kExploded) {
    explode();
    return shown_;
  }
  if (needs_inspection()) {
    if (!frame.inspection) {
      throw InputError("--view-mode " + name_ + ": frame " + std::to_string(frame.index) +
                       " does not say what happens inside, as takes and older frame files do not; "
                       "render the scene itself");
    }
    shown_.debris.clear();
    add_marks(frame);
  }
  assign_colors(frame);
  return shown_;
}

std::uint32_t ViewMode::color_of(const Frame& frame, std::size_t instance) const {
  const Instance& given = frame.instances[instance];
  const FrameBody& body = frame.bodies[given.body];
  const auto hashed_color = [&](std::uint64_t key, std::uint64_t part, std::uint32_t first) {
    const auto choice = combine(key, part) % (kColors.size() - first);
    return first + static_cast<std::uint32_t>(choice);
  };
  switch (kind_) {
    case Kind::kAsleep:
      return state_of(body);
    case Kind::kContacts:
    case Kind::kBroadphase:
      return kStaticColor;
    case Kind::kConvexes:
      return hashed_color(body.key, given.mesh.value, 0);
    case Kind::kStress: {
      const float part = frame.inspection->stresses[instance];
      if (!(part >= 0)) return kStaticColor;
      return kFirstHeat + static_cast<std::uint32_t>(std::min(part, 1.f) * (kHeatSteps - 1) + 0.5f);
    }
    case Kind::kIslands: {
      if (body.is_static) return kStaticColor;
      const FrameBody& first = frame.bodies[frame.inspection->islands[given.body]];
      return hashed_color(first.key, 0, kStaticColor + 1) + (body.asleep ? kFirstDim : 0);
    }
    default:
      return hashed_color(body.key, 0, 0);
  }
}

/// Gives each piece one colour, on its surface and interior; the ground is unchanged.
void ViewMode::assign_colors(const Frame& frame) {
  if (frame.materials != given_materials_) {
    given_materials_ = frame.materials;
    std::vector<Material> materials = *frame.materials;
    for (const Vec3f& color : palette()) {
      Material& plain = materials.emplace_back();
      plain.surface.color = plain.interior.color = color;
    }
    materials_ = std::make_shared<const std::vector<Material>>(std::move(materials));
  }
  for (std::size_t i = 0; i < frame.instances.size(); ++i) {
    if (frame.bodies[frame.instances[i].body].key == kGroundKey) continue;
    shown_.instances[i].material = MaterialIndex(given_materials_->size() + color_of(frame, i));
  }
  shown_.materials = materials_;
}

void ViewMode::add_marks(const Frame& frame) {
  marks_ = {};
  if (kind_ == Kind::kContacts) {
    for (const FrameContact& contact : frame.inspection->contacts) {
      const float force_N = contact.force_W.norm();
      if (force_N > 0) marks_.spindles.push_back(mark_of(contact, force_N));
    }
  }
  if (kind_ == Kind::kBroadphase) {
    for (const FrameBox& box : frame.inspection->boxes)
      marks_.boxes.push_back(mark_of(box, frame.bodies[box.body]));
  }
}

/// Moves bodies away from their centre, taken at ground height so that none gets below it.
void ViewMode::explode() {
  Box box;
  for (const FrameBody& body : shown_.bodies)
    if (body.key != kGroundKey) box.extend(body.X_WB.position);
  if (box.empty()) return;
  Vec3 middle = box.center();
  middle.y() = shown_.view.ground_m;
  for (FrameBody& body : shown_.bodies) {
    if (body.key == kGroundKey) continue;
    body.X_WB.position += kExplodedShift * (body.X_WB.position - middle);
  }
}

}  // namespace sunder::render
