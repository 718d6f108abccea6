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

/// Linear RGB. The first three are for what is held, what is awake and what is asleep.
const std::array<Vec3f, 12> kColors = {
    Vec3f(0.25f, 0.25f, 0.25f), Vec3f(0.8f, 0.25f, 0.05f),  Vec3f(0.08f, 0.2f, 0.6f),
    Vec3f(0.1f, 0.45f, 0.12f),  Vec3f(0.75f, 0.6f, 0.08f),  Vec3f(0.4f, 0.1f, 0.5f),
    Vec3f(0.1f, 0.5f, 0.5f),    Vec3f(0.75f, 0.12f, 0.25f), Vec3f(0.45f, 0.28f, 0.12f),
    Vec3f(0.6f, 0.62f, 0.6f),   Vec3f(0.85f, 0.4f, 0.45f),  Vec3f(0.3f, 0.6f, 0.05f)};
enum : std::uint32_t { kHeld, kAwake, kSleeping };
constexpr std::uint32_t kHeats = 17;
/// After them: the same for who sleeps, and steps from cold to hot.
constexpr std::uint32_t kFirstDim = kColors.size(), kFirstHeat = 2 * kColors.size();

/// From blue at 0 by green and yellow to red at 1.
Vec3f heat(float t) {
  static const std::array<Vec3f, 5> kSteps = {Vec3f(0.03f, 0.08f, 0.5f), Vec3f(0.03f, 0.35f, 0.45f),
                                              Vec3f(0.08f, 0.45f, 0.08f), Vec3f(0.8f, 0.6f, 0.05f),
                                              Vec3f(0.8f, 0.05f, 0.02f)};
  const float place = std::clamp(t, 0.f, 1.f) * (kSteps.size() - 1);
  const auto step = std::min(static_cast<std::size_t>(place), kSteps.size() - 2);
  const float part = place - static_cast<float>(step);
  return (1 - part) * kSteps[step] + part * kSteps[step + 1];
}

/// All colours, in that order.
std::vector<Vec3f> palette() {
  std::vector<Vec3f> colors(kColors.begin(), kColors.end());
  for (const Vec3f& color : kColors) colors.push_back(0.25f * color + Vec3f::Constant(0.02f));
  for (std::uint32_t i = 0; i < kHeats; ++i)
    colors.push_back(heat(static_cast<float>(i) / (kHeats - 1)));
  return colors;
}

std::uint32_t state_of(const FrameBody& body) {
  return body.is_static ? kHeld : body.asleep ? kSleeping : kAwake;
}

// A mark grows with the cube root of its force, as a block does with that of its weight: the
// picture is the same at every scale.
constexpr float kMark_m = 0.006f;  // radius, of 1 N
constexpr float kSlender = 3;      // along the force
constexpr float kMostDecades = 6;  // red: 1 MN

Mark mark_of(const FrameContact& contact, float force_N) {
  const float radius = kMark_m * std::cbrt(force_N);
  const Vec3f along = contact.force_W / force_N;
  const Vec3f aside = along.unitOrthogonal();
  Mark mark;
  mark.center_W = contact.point_W;
  mark.half_axes_W.col(0) = kSlender * radius * along;
  mark.half_axes_W.col(1) = radius * aside;
  mark.half_axes_W.col(2) = radius * along.cross(aside);
  mark.color = heat(std::log10(std::max(force_N, 1.f)) / kMostDecades);
  return mark;
}

Mark mark_of(const FrameBox& box, const FrameBody& body) {
  Mark mark;
  mark.center_W = 0.5f * (box.min_W + box.max_W);
  mark.half_axes_W = (0.5f * (box.max_W - box.min_W)).asDiagonal();
  mark.color = kColors[state_of(body)] + Vec3f::Constant(0.1f);
  mark.through = 0.12f;
  return mark;
}

/// How far each is moved, in its distance from the middle.
constexpr double kApart = 0.5;

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
  shown_.dust.clear();  // it would veil what is to be seen
  if (kind_ == Kind::kExploded) {
    move_apart();
    return shown_;
  }
  if (looks_inside()) {
    if (!frame.inspection) {
      throw InputError("--view-mode " + name_ + ": frame " + std::to_string(frame.index) +
                       " does not say what happens inside, as takes and older frame files do not; "
                       "render the scene itself");
    }
    shown_.debris.clear();
    mark(frame);
  }
  color(frame);
  return shown_;
}

std::uint32_t ViewMode::color_of(const Frame& frame, std::size_t instance) const {
  const Instance& given = frame.instances[instance];
  const FrameBody& body = frame.bodies[given.body];
  const auto one_of_all = [&](std::uint64_t key, std::uint64_t part, std::uint32_t first) {
    const auto choice = combine(key, part) % (kColors.size() - first);
    return first + static_cast<std::uint32_t>(choice);
  };
  switch (kind_) {
    case Kind::kAsleep:
      return state_of(body);
    case Kind::kContacts:
    case Kind::kBroadphase:
      return kHeld;
    case Kind::kConvexes:
      return one_of_all(body.key, given.mesh.value, 0);
    case Kind::kStress: {
      const float part = frame.inspection->stresses[instance];
      if (!(part >= 0)) return kHeld;
      return kFirstHeat + static_cast<std::uint32_t>(std::min(part, 1.f) * (kHeats - 1) + 0.5f);
    }
    case Kind::kIslands: {
      if (body.is_static) return kHeld;
      const FrameBody& first = frame.bodies[frame.inspection->islands[given.body]];
      return one_of_all(first.key, 0, kHeld + 1) + (body.asleep ? kFirstDim : 0);
    }
    default:
      return one_of_all(body.key, 0, 0);
  }
}

/// Every piece in one colour, outside and inside; the ground as it is.
void ViewMode::color(const Frame& frame) {
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

void ViewMode::mark(const Frame& frame) {
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
