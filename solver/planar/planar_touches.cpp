#include "solver/planar/planar_touches.h"

#include <algorithm>
#include <tuple>
#include <utility>

namespace sunder::solver {
namespace {

/// How far any point of a fixture may come within a step, in units.
float way_of(const b2Fixture& fixture, float dt_s) {
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

/// Edges before polygons before circles, as Box2D wants them.
int rank(const b2Fixture* fixture) {
  return fixture->GetType() == b2Shape::e_edge     ? 0
         : fixture->GetType() == b2Shape::e_circle ? 2
                                                   : 1;
}

/// A copy of the fixture's shape with a skin so much thicker.
template <class Shape>
Shape thicker(const b2Fixture* fixture, float by) {
  Shape shape = *static_cast<const Shape*>(fixture->GetShape());
  shape.m_radius += by;
  return shape;
}

/// Contact points of two fixtures, rank(a) <= rank(b), as far as `reach` apart.
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
      with(b2CollideEdgeAndPolygon, thicker<Edge>(a, reach), thicker<Polygon>(b, 0));
      break;
    case 2:
      with(b2CollideEdgeAndCircle, thicker<Edge>(a, reach), thicker<Circle>(b, 0));
      break;
    case 4:
      with(b2CollidePolygons, thicker<Polygon>(a, reach), thicker<Polygon>(b, 0));
      break;
    case 5:
      with(b2CollidePolygonAndCircle, thicker<Polygon>(a, reach), thicker<Circle>(b, 0));
      break;
    case 8:
      with(b2CollideCircles, thicker<Circle>(a, reach), thicker<Circle>(b, 0));
      break;
    default:  // edges are static: they never meet
      break;
  }
  return m;
}

using FixturePair = std::pair<b2Fixture*, b2Fixture*>;

bool make_nearby(const FixturePair& pair, const Plane2& plane, float reach, Nearby& near) {
  auto [a, b] = pair;
  const bool swapped = rank(a) > rank(b);
  if (swapped) std::swap(a, b);
  const b2Manifold m = collide(a, b, reach);
  if (m.pointCount == 0) return false;
  b2WorldManifold world;
  world.Initialize(&m, a->GetBody()->GetTransform(), a->GetShape()->m_radius,
                   b->GetBody()->GetTransform(), b->GetShape()->m_radius);
  const float sign = swapped ? -1.f : 1.f;
  near.key_a = key_of(pair.first), near.key_b = key_of(pair.second);
  near.shape_a = shape_of(pair.first), near.shape_b = shape_of(pair.second);
  near.body_a = body_of(pair.first->GetBody()), near.body_b = body_of(pair.second->GetBody());
  near.normal_W =
      Vec3(double{sign * world.normal.x}, double{sign * world.normal.y}, 0).normalized();
  near.count = m.pointCount;
  for (int i = 0; i < m.pointCount; ++i) {
    near.points_W[i] = plane.metres(world.points[i]);
    near.separations_m[i] = double{world.separations[i] + kSlop} / plane.units_per_m;
  }
  return true;
}

}  // namespace

std::vector<Nearby> find_nearby(const b2World& world, std::span<const PlanarBody> bodies,
                                std::span<const PlanarShape> shapes, const Plane2& plane,
                                double dt_s) {
  const auto dt = static_cast<float>(dt_s);
  std::vector<FixturePair> pairs;
  for (const PlanarBody& body : bodies) {
    if (!body.dynamic()) continue;
    for (const std::uint32_t shape : body.shapes) {
      for (b2Fixture* fixture : shapes[shape].fixtures) {
        // What moves more finds the other, wherever the two would meet.
        const float margin = 2 * way_of(*fixture, dt) + kSlop;
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
  std::vector<Nearby> all;
  for (const FixturePair& pair : pairs) {
    Nearby near;
    const float reach = way_of(*pair.first, dt) + way_of(*pair.second, dt) + kSlop;
    if (make_nearby(pair, plane, reach, near)) all.push_back(near);
  }
  return all;
}

}  // namespace sunder::solver
