#include "solver/planar/planar_bodies.h"

#include <algorithm>
#include <string>

#include "engine/base/check.h"

namespace sunder::solver {

ConvertedShapes PlanarBodies::convert_shapes(std::span<const ShapeDesc> descs, std::uint32_t tag,
                                             const Vec3& com_R, const Pose& X_WB) const {
  ConvertedShapes converted;
  for (const ShapeDesc& shape : descs) {
    try {
      converted.push_back(planar_shapes(shape, com_R, X_WB, plane_));
    } catch (const InputError& error) {
      throw InputError("shape " + std::to_string(shape.tag) + " of body " + std::to_string(tag) +
                       " " + error.what() +
                       ": a planar scene takes prisms along z that reach through z = 0, spheres "
                       "about a point of that plane, and half-spaces bounded along z");
    }
  }
  return converted;
}

std::uint32_t PlanarBodies::add(const BodyDesc& desc, const ConvertedShapes& converted) {
  if (free_items_.empty()) {
    free_items_.push_back(static_cast<std::uint32_t>(items.size()));
    items.emplace_back();
  }
  const std::uint32_t slot = free_items_.back();
  free_items_.pop_back();
  PlanarBody body;
  body.generation = items[slot].generation;
  body.tag = desc.tag, body.reports_load = desc.reports_load;
  body.X_WB = {desc.X_WB.position, desc.X_WB.rotation.normalized()};
  body.com_R = desc.com_R;
  b2BodyDef def;
  def.type = desc.is_static ? b2_staticBody : desc.is_kinematic ? b2_kinematicBody : b2_dynamicBody;
  def.position = plane_.units(desc.X_WB.position);
  def.userData.pointer = slot;
  if (!desc.is_static) {
    def.linearVelocity = plane_.units(desc.velocity_W);
    def.angularVelocity = static_cast<float>(desc.angular_velocity_W.z());
  }
  if (def.type == b2_dynamicBody) {
    const Vec3 axis_B = body.X_WB.rotation.conjugate() * Vec3::UnitZ();
    body.mass_kg = desc.mass_kg;
    body.inertia_kg_m2 = axis_B.dot(desc.inertia_B * axis_B);
    SUNDER_CHECK(body.mass_kg > 0 && body.inertia_kg_m2 > 0);
  }
  body.body = world_.CreateBody(&def);
  if (def.type == b2_dynamicBody) {
    b2MassData mass;
    mass.mass = static_cast<float>(body.mass_kg);
    mass.center.SetZero();
    mass.I = static_cast<float>(body.inertia_kg_m2 * plane_.units_per_m * plane_.units_per_m);
    body.body->SetMassData(&mass);
  }
  items[slot] = std::move(body);
  add_shapes(slot, desc.shapes, converted);
  return slot;
}

void PlanarBodies::add_shapes(std::uint32_t slot, std::span<const ShapeDesc> descs,
                              const ConvertedShapes& converted) {
  PlanarBody& body = items[slot];
  for (std::size_t i = 0; i < descs.size(); ++i) {
    if (free_shapes_.empty()) {
      free_shapes_.push_back(static_cast<std::uint32_t>(shapes.size()));
      shapes.emplace_back();
    }
    const std::uint32_t shape = free_shapes_.back();
    free_shapes_.pop_back();
    shapes[shape] = {slot, descs[i].tag, {}};
    body.shapes.push_back(shape);
    for (std::size_t part = 0; part < converted[i].size(); ++part) {
      b2FixtureDef def;
      def.shape = converted[i][part].get();
      def.friction = static_cast<float>(descs[i].friction);
      def.restitution = static_cast<float>(descs[i].restitution);
      def.restitutionThreshold =
          static_cast<float>(plane_.units_per_m * restitution_threshold_m_s_);
      def.userData.pointer = std::uintptr_t{shape} << 16 | part;
      min_width = std::min(min_width, width_of(*converted[i][part]));
      shapes[shape].fixtures.push_back(body.body->CreateFixture(&def));
    }
  }
}

void PlanarBodies::remove(std::uint32_t slot) {
  PlanarBody& body = items[slot];
  while (!body.shapes.empty()) remove_shape(body.shapes.back());
  world_.DestroyBody(body.body);
  body.body = nullptr;
  ++body.generation;
  free_items_.push_back(slot);
}

/// Removes a shape; DestroyFixture() wakes the bodies in contact with it.
void PlanarBodies::remove_shape(std::uint32_t slot) {
  PlanarShape& shape = shapes[slot];
  PlanarBody& body = items[shape.body];
  for (b2Fixture* fixture : shape.fixtures) body.body->DestroyFixture(fixture);
  shape.fixtures.clear();
  std::erase(body.shapes, slot);
  free_shapes_.push_back(slot);
}

}  // namespace sunder::solver
