#include "solver/planar/planar_touches.h"

#include <algorithm>
#include <utility>

namespace sunder::solver {
namespace {

/// Returns an upper bound of the motion of any point of a fixture in a step, in units.
float max_motion_of(const b2Fixture& fixture, float dt_s) {
  const b2Body& body = *const_cast<b2Fixture&>(fixture).GetBody();
  if (body.GetType() != b2_dynamicBody) return 0;
  b2AABB box;
  fixture.GetShape()->ComputeAABB(&box, body.GetTransform(), 0);
  const float reach = (box.GetCenter() - body.GetPosition()).Length() + box.GetExtents().Length();
  const float angle = std::min(1.f, dt_s * std::abs(body.GetAngularVelocity()));
  return dt_s * body.GetLinearVelocity().Length() + angle * reach;
}

struct FindFixtures final : b2QueryCallback {
  bool ReportFixture(b2Fixture* fixture) override {
    found.push_back(fixture);
    return true;
  }
  std::vector<b2Fixture*> found;
};

/// Returns the order in which Box2D's collide functions take the kinds of shapes.
int rank(const b2Fixture* fixture) {
  return fixture->GetType() == b2Shape::e_edge     ? 0
         : fixture->GetType() == b2Shape::e_circle ? 2
                                                   : 1;
}

/// Returns a copy of the fixture's shape with its skin thicker by `by` units.
template <class Shape>
Shape with_thicker_skin(const b2Fixture* fixture, float by) {
  Shape shape = *static_cast<const Shape*>(fixture->GetShape());
  shape.m_radius += by;
  return shape;
}

/// Returns the manifold of two fixtures, rank(a) <= rank(b), with points up to `reach` apart.
b2Manifold collide(const b2Fixture* a, const b2Fixture* b, float reach) {
  b2Manifold m;
  m.pointCount = 0;
  const b2Transform &xa = a->GetBody()->GetTransform(), &xb = b->GetBody()->GetTransform();
  const auto with = [&](auto* function, const auto& shape_a, const auto& shape_b) {
    function(&m, &shape_a, xa, &shape_b, xb);
  };
  using Edge = b2EdgeShape;
  using Polygon = b2PolygonShape;
  using Circle = b2CircleShape;
  switch (3 * rank(a) + rank(b)) {
    case 1:
      with(b2CollideEdgeAndPolygon, with_thicker_skin<Edge>(a, reach),
           with_thicker_skin<Polygon>(b, 0));
      break;
    case 2:
      with(b2CollideEdgeAndCircle, with_thicker_skin<Edge>(a, reach),
           with_thicker_skin<Circle>(b, 0));
      break;
    case 4:
      with(b2CollidePolygons, with_thicker_skin<Polygon>(a, reach),
           with_thicker_skin<Polygon>(b, 0));
      break;
    case 5:
      with(b2CollidePolygonAndCircle, with_thicker_skin<Polygon>(a, reach),
           with_thicker_skin<Circle>(b, 0));
      break;
    case 8:
      with(b2CollideCircles, with_thicker_skin<Circle>(a, reach), with_thicker_skin<Circle>(b, 0));
      break;
    default:  // two edges: both are static
      break;
  }
  return m;
}

using FixturePair = std::pair<b2Fixture*, b2Fixture*>;

bool find_contact(const FixturePair& pair, const Plane2& plane, float reach,
                  FixtureContact& contact) {
  auto [a, b] = pair;
  const bool swapped = rank(a) > rank(b);
  if (swapped) std::swap(a, b);
  const b2Manifold m = collide(a, b, reach);
  if (m.pointCount == 0) return false;
  b2WorldManifold world;
  world.Initialize(&m, a->GetBody()->GetTransform(), a->GetShape()->m_radius,
                   b->GetBody()->GetTransform(), b->GetShape()->m_radius);
  const float sign = swapped ? -1.f : 1.f;
  contact.shape_a = shape_of(pair.first), contact.shape_b = shape_of(pair.second);
  contact.body_a = body_of(pair.first->GetBody()), contact.body_b = body_of(pair.second->GetBody());
  contact.normal_W =
      Vec3(double{sign * world.normal.x}, double{sign * world.normal.y}, 0).normalized();
  contact.count = m.pointCount;
  for (int i = 0; i < m.pointCount; ++i) {
    contact.points_W[i] = plane.metres(world.points[i]);
    contact.separations_m[i] = double{world.separations[i] + kSlop} / plane.units_per_m;
  }
  return true;
}

}  // namespace

std::vector<FixtureContact> find_fixture_contacts(const b2World& world,
                                                  std::span<const PlanarBody> bodies,
                                                  std::span<const PlanarShape> shapes,
                                                  const Plane2& plane, double dt_s) {
  const auto dt = static_cast<float>(dt_s);
  std::vector<FixturePair> pairs;
  for (const PlanarBody& body : bodies) {
    if (!body.dynamic()) continue;
    for (const std::uint32_t shape : body.shapes) {
      for (b2Fixture* fixture : shapes[shape].fixtures) {
        // Twice the own motion suffices: of any pair, the fixture that moves more finds the other.
        const float margin = 2 * max_motion_of(*fixture, dt) + kSlop;
        FindFixtures query;
        b2AABB box;
        fixture->GetShape()->ComputeAABB(&box, body.body->GetTransform(), 0);
        box.lowerBound -= b2Vec2(margin, margin);
        box.upperBound += b2Vec2(margin, margin);
        world.QueryAABB(&query, box);
        for (b2Fixture* other : query.found) {
          if (other->GetBody() == body.body) continue;
          const bool first = key_of(fixture) < key_of(other);
          pairs.emplace_back(first ? fixture : other, first ? other : fixture);
        }
      }
    }
  }
  const auto keys = [](const FixturePair& p) {
    return std::pair(key_of(p.first), key_of(p.second));
  };
  std::sort(pairs.begin(), pairs.end(),
            [&](const FixturePair& p, const FixturePair& q) { return keys(p) < keys(q); });
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  std::vector<FixtureContact> all;
  for (const FixturePair& pair : pairs) {
    FixtureContact contact;
    const float reach = max_motion_of(*pair.first, dt) + max_motion_of(*pair.second, dt) + kSlop;
    if (find_contact(pair, plane, reach, contact)) all.push_back(contact);
  }
  return all;
}

}  // namespace sunder::solver
