// Bodies and shapes of the plane: what the seam knows about them, beside Box2D's own.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "solver/planar/planar_shapes.h"

namespace sunder::solver {

inline constexpr float kSlop = b2_linearSlop;

/// A body by slot; slots are reused, generations tell old ids apart.
struct PlanarBody {
  b2Body* body = nullptr;  ///< Null: a free slot.
  std::uint32_t generation = 0;
  std::uint32_t tag = 0;
  bool reports_load = false;
  bool frozen = false;                ///< Was not finite; static since.
  double mass_kg = 0;                 ///< 0: static or kinematic.
  double inertia_kg_m2 = 0;           ///< About z.
  Pose X_WB;                          ///< When it was added: its z, and where its turns start.
  Vec3 com_R = Vec3::Zero();          ///< As in BodyDesc.
  b2Vec2 last_velocity = {0, 0};      ///< Before it fell asleep, in units.
  std::vector<std::uint32_t> shapes;  ///< Slots.

  bool dynamic() const { return body && body->GetType() == b2_dynamicBody; }
  bool kinematic() const { return body && body->GetType() == b2_kinematicBody; }
};

/// A shape of the seam: one fixture of Box2D's, or several.
struct PlanarShape {
  std::uint32_t body = 0;
  std::uint32_t tag = 0;
  std::vector<b2Fixture*> fixtures;
};

/// Of each shape of a body, what it is in the plane.
using MadeShapes = std::vector<std::vector<std::unique_ptr<b2Shape>>>;

class PlanarBodies {
 public:
  /// `world` must outlive this; impacts slower than `bounce_m_s` do not bounce.
  PlanarBodies(b2World& world, const Plane2& plane, double bounce_m_s)
      : world_(world), plane_(plane), bounce_m_s_(bounce_m_s) {}

  std::vector<PlanarBody> items;    ///< By slot.
  std::vector<PlanarShape> shapes;  ///< By slot.
  float thinnest = b2_maxFloat;     ///< Width of the thinnest shape there ever was, in units.

  /// The shapes of a body placed at `X_WB`. Throws InputError naming the shape and the body's tag.
  MadeShapes make_shapes(std::span<const ShapeDesc> descs, std::uint32_t tag, const Vec3& com_R,
                         const Pose& X_WB) const;
  /// The answer is its slot.
  std::uint32_t add(const BodyDesc& desc, const MadeShapes& made);
  void add_shapes(std::uint32_t slot, std::span<const ShapeDesc> descs, const MadeShapes& made);
  void remove(std::uint32_t slot);
  void remove_shape(std::uint32_t slot);

 private:
  b2World& world_;
  Plane2 plane_;
  double bounce_m_s_;
  std::vector<std::uint32_t> free_items_, free_shapes_;
};

/// A fixture's shape (slot) and which part of it the fixture is; orders fixtures.
inline std::uint64_t key_of(const b2Fixture* fixture) {
  return const_cast<b2Fixture*>(fixture)->GetUserData().pointer;
}
inline std::uint32_t shape_of(const b2Fixture* fixture) {
  return static_cast<std::uint32_t>(key_of(fixture) >> 16);
}
inline std::uint32_t body_of(const b2Body* body) {
  return static_cast<std::uint32_t>(const_cast<b2Body*>(body)->GetUserData().pointer);
}

}  // namespace sunder::solver
