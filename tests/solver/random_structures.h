// Test fixture: random piles, arches, lintels and frames, each with a support to be removed.
#pragma once

#include <array>
#include <vector>

#include "tests/fixtures/rigid_world.h"

namespace sunder::solver {

/// Ways in which the support is lost.
enum class Loss { kRemoved, kShrunk, kEdited, kDriven, kTeleported, kCut };
inline constexpr std::array kLossNames = {"removed", "shrunk",     "edited",
                                          "driven",  "teleported", "cut"};

enum class Kind { kPile, kArch, kFrame };
inline constexpr std::array kKindNames = {"piles", "arches", "frames"};

/// Bodies on the ground, with the index of the support that the test removes.
struct Structure {
  std::vector<BodyDesc> bodies;
  std::size_t support = 0;
  Loss loss = Loss::kRemoved;
  Vec3 top_W = Vec3::Zero();  ///< Top of the support; only frames set it.
};

/// Returns boxes that fall onto each other.
inline Structure make_pile(Random& random) {
  Structure pile;
  const std::uint32_t count = 3 + random.below(8);
  for (std::uint32_t i = 0; i < count; ++i) {
    const Vec3 size(random.uniform(0.2, 0.5), random.uniform(0.1, 0.3), random.uniform(0.2, 0.5));
    const Vec3 at(random.uniform(-0.2, 0.2), 0.17 + 0.33 * i, random.uniform(-0.2, 0.2));
    pile.bodies.push_back(RigidWorld::box(size, at, random.uniform(500, 3000)));
  }
  pile.support = random.below(count);
  return pile;
}

/// Returns two piers of boxes, a lintel on them, and boxes on the lintel.
inline Structure make_lintel(Random& random) {
  Structure portal;
  const std::uint32_t high = 1 + random.below(4), loads = random.below(4);
  const double span = random.uniform(0.6, 1.2), height = random.uniform(0.2, 0.4);
  for (std::uint32_t i = 0; i < 2 * high; ++i)
    portal.bodies.push_back(RigidWorld::box(
        Vec3(0.3, height, 0.3), Vec3((i % 2 ? 0.5 : -0.5) * span, (i / 2 + 0.5) * height, 0),
        random.uniform(500, 3000)));
  portal.support = random.below(2 * high);
  const double level = high * height;
  portal.bodies.push_back(
      RigidWorld::box(Vec3(span + 0.3, 0.15, 0.3), Vec3(0, level + 0.075, 0), 2000));
  for (std::uint32_t i = 0; i < loads; ++i)
    portal.bodies.push_back(RigidWorld::box(
        Vec3(0.25, 0.2, 0.25), Vec3(random.uniform(-0.05, 0.05), level + 0.25 + 0.2 * i, 0), 2000));
  return portal;
}

inline Structure make_arch(Random& random) {
  if (random.below(4) == 0) return make_lintel(random);
  Structure arch;
  const int count = 5 + static_cast<int>(random.below(8));
  const double thickness = random.uniform(0.2, 0.35);
  for (int i = 0; i < count; ++i) arch.bodies.push_back(RigidWorld::voussoir(i, count, thickness));
  arch.support = random.below(static_cast<std::uint32_t>(count));
  return arch;
}

/// Returns slabs on three or four legs each, with a load on top; the support is one of the legs.
inline Structure make_frame(Random& random) {
  Structure frame;
  frame.loss = static_cast<Loss>(random.below(kLossNames.size()));
  const std::uint32_t storeys = 1 + random.below(2), legs = 3 + random.below(2);
  const double length = random.uniform(0.8, 1.6), width = random.uniform(0.8, 1.6);
  const double leg_m = random.uniform(0.12, 0.2), height = random.uniform(0.3, 0.6);
  const std::uint32_t lost_of = random.below(storeys), lost = random.below(legs);
  double level = 0;
  for (std::uint32_t storey = 0; storey < storeys; ++storey) {
    for (std::uint32_t leg = 0; leg < legs; ++leg) {
      const double inset = random.uniform(0, 0.25);
      const Vec2 at(0.5 - leg_m / length - inset, 0.5 - leg_m / width - inset);
      const Vec3 foot((leg % 2 ? 1 : -1) * at.x() * length, level + height / 2,
                      (leg / 2 ? 1 : -1) * at.y() * width);
      if (storey == lost_of && leg == lost) frame.support = frame.bodies.size();
      frame.bodies.push_back(RigidWorld::box(Vec3(leg_m, height, leg_m), foot, 2000));
    }
    level += height + 0.1;
    // Three legs support a slab only if its centre is on their side of the diagonal.
    const double shift = legs == 3 ? 0.2 : random.uniform(-0.1, 0.1);
    frame.bodies.push_back(RigidWorld::box(
        Vec3(length, 0.1, width), Vec3(-shift * length / 2, level - 0.05, -shift * width / 2),
        random.uniform(500, 3000)));
  }
  const std::uint32_t loads = random.below(4);
  for (std::uint32_t i = 0; i < loads; ++i)
    frame.bodies.push_back(
        RigidWorld::box(Vec3(0.2, 0.2, 0.2),
                        Vec3(random.uniform(-0.3, 0.1) * length, level + 0.1 + 0.2 * i,
                             random.uniform(-0.3, 0.1) * width),
                        random.uniform(500, 3000)));
  BodyDesc& support = frame.bodies[frame.support];
  if (frame.loss == Loss::kEdited) support.is_static = true;
  if (frame.loss == Loss::kDriven || frame.loss == Loss::kTeleported) support.is_kinematic = true;
  frame.top_W = support.X_WB.position + Vec3(0, height / 2, 0);
  return frame;
}

inline Structure make_structure(Kind kind, Random& random) {
  if (kind == Kind::kPile) return make_pile(random);
  return kind == Kind::kArch ? make_arch(random) : make_frame(random);
}

}  // namespace sunder::solver
