#include "solver/planar/planar_reports.h"

#include <algorithm>
#include <tuple>

namespace sunder::solver {
namespace {

/// A contact point with a positive normal impulse.
struct LoadedPoint {
  const b2Contact& contact;
  const b2WorldManifold& manifold;
  int point = 0;
};

template <class Use>
void for_each_loaded(const b2World& world, const Use& use) {
  for (const b2Contact* c = world.GetContactList(); c; c = c->GetNext()) {
    if (!c->IsTouching()) continue;
    b2WorldManifold manifold;
    c->GetWorldManifold(&manifold);
    for (int i = 0; i < c->GetManifold()->pointCount; ++i) {
      if (c->GetManifold()->points[i].normalImpulse > 0) use(LoadedPoint{*c, manifold, i});
    }
  }
}

/// Returns the body of a fixture.
const PlanarBody& owner(const b2Fixture& fixture, std::span<const PlanarBody> bodies) {
  return bodies[body_of(const_cast<b2Fixture&>(fixture).GetBody())];
}

}  // namespace

std::vector<float> find_penetrations(const b2World& world, const Plane2& plane) {
  std::vector<float> depths;
  for_each_loaded(world, [&](const LoadedPoint& at) {
    const double units = -static_cast<double>(at.manifold.separations[at.point] + kSlop);
    depths.push_back(static_cast<float>(std::max(0.0, units / plane.units_per_m)));
  });
  return depths;
}

std::vector<ContactForce> find_contact_forces(const b2World& world,
                                              std::span<const PlanarBody> bodies,
                                              const Plane2& plane, double h_s) {
  struct Keyed {
    std::uint64_t key_a, key_b;
    ContactForce press;
  };
  std::vector<Keyed> contact_forces;
  if (h_s > 0) {
    for_each_loaded(world, [&](const LoadedPoint& at) {
      const b2Fixture &a = *at.contact.GetFixtureA(), &b = *at.contact.GetFixtureB();
      const b2ManifoldPoint& point = at.contact.GetManifold()->points[at.point];
      const b2Vec2& normal = at.manifold.normal;
      const b2Vec2 impulse =
          point.normalImpulse * normal + point.tangentImpulse * b2Cross(normal, 1.f);
      const PlanarBody &body_a = owner(a, bodies), &body_b = owner(b, bodies);
      const double z = (body_a.dynamic() ? body_a : body_b).X_WB.position.z();
      contact_forces.push_back(
          {key_of(&a),
           key_of(&b),
           {body_a.tag, body_b.tag, plane.metres(at.manifold.points[at.point], z),
            plane.metres(impulse) / h_s}});
    });
  }
  // Sorted, because the order of Box2D's contact list is not reproducible.
  std::ranges::stable_sort(contact_forces, {},
                           [](const Keyed& k) { return std::tuple(k.key_a, k.key_b); });
  std::vector<ContactForce> sorted;
  for (const Keyed& one : contact_forces) sorted.push_back(one.press);
  return sorted;
}

PhysicsInspection inspect_planar(std::span<const PlanarBody> bodies, const Plane2& plane) {
  PhysicsInspection seen;
  for (const PlanarBody& body : bodies) {
    if (!body.body) continue;
    for (const b2Fixture* f = body.body->GetFixtureList(); f; f = f->GetNext()) {
      if (f->GetType() == b2Shape::e_edge) continue;  // the ground, which is unbounded
      const b2AABB& box = f->GetAABB(0);
      const double z = body.X_WB.position.z();
      seen.boxes.push_back(
          {body.tag, {plane.metres(box.lowerBound, z), plane.metres(box.upperBound, z)}});
    }
  }
  return seen;
}

}  // namespace sunder::solver
