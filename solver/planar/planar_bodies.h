// Bodies and shapes of a planar scene: the data of Physics that Box2D does not keep.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "solver/planar/planar_shapes.h"

namespace sunder::solver {

inline constexpr float kSlop = b2_linearSlop;  ///< Penetration that Box2D allows, in units.

/// A body in a slot. Slots are reused; the generation invalidates old ids.
struct PlanarBody {
  b2Body* body = nullptr;  ///< Null if the slot is free.
  std::uint32_t generation = 0;
  std::uint32_t tag = 0;
  bool reports_load = false;
  bool frozen = false;                ///< True if made static because its state was not finite.
  double mass_kg = 0;                 ///< 0 for static and kinematic bodies.
  double inertia_kg_m2 = 0;           ///< Moment of inertia about z.
  Pose X_WB;                          ///< Initial pose: z is constant, Box2D's angle is relative.
  Vec3 com_R = Vec3::Zero();          ///< Centre of mass, as in BodyDesc.
  b2Vec2 last_velocity = {0, 0};      ///< Last velocity while awake, in units/s.
  std::vector<std::uint32_t> shapes;  ///< Slots of its shapes.

  bool dynamic() const { return body && body->GetType() == b2_dynamicBody; }
  bool kinematic() const { return body && body->GetType() == b2_kinematicBody; }
};

/// A shape of Physics: one or several Box2D fixtures.
struct PlanarShape {
  std::uint32_t body = 0;
  std::uint32_t tag = 0;
  std::vector<b2Fixture*> fixtures;
};

/// The Box2D shapes of each shape of a body.
using ConvertedShapes = std::vector<std::vector<std::unique_ptr<b2Shape>>>;

class PlanarBodies {
 public:
  /// `world` must outlive this. Below a closing speed of `bounce_m_s` there is no restitution.
  PlanarBodies(b2World& world, const Plane2& plane, double bounce_m_s)
      : world_(world), plane_(plane), restitution_threshold_m_s_(bounce_m_s) {}

  std::vector<PlanarBody> items;    ///< Bodies by slot.
  std::vector<PlanarShape> shapes;  ///< Shapes by slot.
  float min_width = b2_maxFloat;    ///< Least width of all shapes ever added, in units.

  /// Converts the shapes of a body at `X_WB`. Throws InputError that names the shape and body tag.
  ConvertedShapes convert_shapes(std::span<const ShapeDesc> descs, std::uint32_t tag,
                                 const Vec3& com_R, const Pose& X_WB) const;
  /// Adds a body and returns its slot.
  std::uint32_t add(const BodyDesc& desc, const ConvertedShapes& converted);
  void add_shapes(std::uint32_t slot, std::span<const ShapeDesc> descs,
                  const ConvertedShapes& converted);
  void remove(std::uint32_t slot);
  void remove_shape(std::uint32_t slot);

 private:
  b2World& world_;
  Plane2 plane_;
  double restitution_threshold_m_s_;
  std::vector<std::uint32_t> free_items_, free_shapes_;
};

/// Returns a unique key by which fixtures are ordered: the slot of the fixture's shape, shifted
/// left by 16, and the index of the fixture in the shape.
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
