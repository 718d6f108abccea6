#include "engine/world/queries.h"

#include <algorithm>
#include <array>
#include <tuple>

namespace sunder {
namespace {

auto order_of(const CastHit& hit) { return std::tuple(hit.distance_m, hit.body, hit.slot); }

/// A shape of a body or of the ground that a query may meet.
struct Candidate {
  BodyKey body;
  std::uint32_t slot = 0;
  const Actor* actor = nullptr;  ///< Null: the ground.
  const Facet* facet = nullptr;  ///< A triangle of the ground; null: its plane.
};

/// Finds the shapes that a filter lets pass.
class Candidates {
 public:
  Candidates(const WorldState& world, const QueryFilter& filter)
      : world_(world), filter_(filter), states_(world.physics->states()) {}

  std::optional<Candidate> find(const ShapeId& shape) {
    if (shape.body_tag == kGroundKey) return find_ground(shape.shape_tag);
    if (shape.body_tag != last_tag_ || !last_) {
      last_tag_ = shape.body_tag;
      last_ = world_.actors.find(shape.body_tag);
      passes_ = last_ && passes(*last_);
    }
    if (!passes_) return std::nullopt;
    return Candidate{BodyKey(std::size_t{shape.body_tag}), shape.shape_tag, last_, nullptr};
  }
  Pose X_WR(const Actor& actor) const { return rest_pose(actor, states_[actor.body].X_WB); }

 private:
  std::optional<Candidate> find_ground(std::uint32_t tag) const {
    if (!filter_.ground) return std::nullopt;
    const bool plane = tag == kGroundPlaneTag;
    return Candidate{BodyKey(), plane ? 0 : tag, nullptr,
                     plane ? nullptr : &(*world_.landscape.facets)[tag]};
  }
  bool passes(const Actor& actor) const {
    if ((actor.filter.category & filter_.mask) == 0) return false;
    return !filter_.accepts || filter_.accepts(BodyKey(std::size_t{actor.key}));
  }

  const WorldState& world_;
  const QueryFilter& filter_;
  BodyStates states_;
  std::uint32_t last_tag_ = 0;  ///< Shapes of a body often come one after another.
  const Actor* last_ = nullptr;
  bool passes_ = false;
};

class CastVisitor : public ShapeVisitor {
 public:
  CastVisitor(const WorldState& world, const QueryFilter& filter, const MovingBall& ball)
      : world_(world), candidates_(world, filter), ball_(ball) {}

  /// Visits all shapes on the way.
  void run() {
    world_.physics->visit_on_ray(ball_.from, ball_.direction, ball_.reach_m, ball_.radius_m, *this);
  }
  double visit(const ShapeId& shape, double reach_m) override {
    const std::optional<Candidate> one = candidates_.find(shape);
    if (!one) return reach_m;
    MaterialIndex material;
    const std::optional<SurfaceHit> met = meet(*one, reach_m, material);
    if (!met) return reach_m;
    CastHit hit;
    hit.body = one->body;
    hit.slot = one->slot;
    hit.material = material;
    hit.distance_m = met->distance_m;
    hit.normal_W = met->normal;
    hit.point_W = ball_.from + met->distance_m * ball_.direction - ball_.radius_m * met->normal;
    if (met->distance_m == 0) hit.point_W = ball_.from;
    return note(hit, reach_m);
  }

 protected:
  ~CastVisitor() = default;
  /// Takes a hit; returns how far the query goes on.
  virtual double note(const CastHit& hit, double reach_m) = 0;

 private:
  std::optional<SurfaceHit> meet(const Candidate& one, double reach_m, MaterialIndex& material) {
    MovingBall ball = ball_;
    ball.reach_m = reach_m;
    if (one.facet) {
      material = one.facet->material;
      return cast_at_front(ball, front_of(*one.facet));
    }
    if (!one.actor) return cast(ball, Plane{Vec3::UnitY(), -world_.scene.ground.height_m});
    if (one.actor->structure.empty()) {
      material = one.actor->materials[0];
      const Vec3 center_W = candidates_.X_WR(*one.actor).position;
      return cast_at_ball(ball, center_W, ball_radius_m(one.actor->volume_m3));
    }
    const Convex& convex = *one.actor->structure.convex(ConvexSlot(std::size_t{one.slot}));
    material = convex.material;
    const Pose X_WR = candidates_.X_WR(*one.actor), X_RW = X_WR.inverse();
    ball.from = X_RW * ball.from;
    ball.direction = X_RW.rotation * ball.direction;
    std::optional<SurfaceHit> met = cast(ball, convex.polyhedron);
    if (met) met->normal = X_WR.rotation * met->normal;
    return met;
  }
  static std::array<Vec3, 3> front_of(const Facet& facet) {
    const std::span<const std::uint32_t> corners = facet.prism.face_corners(0);
    const std::vector<Vec3>& vertices = facet.prism.vertices;
    return {vertices[corners[0]], vertices[corners[1]], vertices[corners[2]]};
  }

  const WorldState& world_;
  Candidates candidates_;
  const MovingBall& ball_;
};

class FirstHit final : public CastVisitor {
 public:
  using CastVisitor::CastVisitor;
  std::optional<CastHit> found;

 private:
  double note(const CastHit& hit, double) override {
    if (!found || order_of(hit) < order_of(*found)) found = hit;
    return found->distance_m;
  }
};

class AllHits final : public CastVisitor {
 public:
  using CastVisitor::CastVisitor;
  std::vector<CastHit> found;

 private:
  double note(const CastHit& hit, double reach_m) override {
    found.push_back(hit);
    return reach_m;
  }
};

/// Collects the shapes for which `overlaps` is true.
template <class Overlaps>
class OverlapVisitor final : public ShapeVisitor {
 public:
  OverlapVisitor(const WorldState& world, const QueryFilter& filter, const Overlaps& overlaps)
      : candidates_(world, filter), overlaps_(overlaps) {}

  double visit(const ShapeId& shape, double reach_m) override {
    const std::optional<Candidate> one = candidates_.find(shape);
    if (one && overlaps_(*one, candidates_)) found_.push_back({one->body, one->slot});
    return reach_m;
  }
  std::vector<Overlap> take() {
    std::ranges::sort(found_);
    found_.erase(std::unique(found_.begin(), found_.end()), found_.end());
    return std::move(found_);
  }

 private:
  Candidates candidates_;
  const Overlaps& overlaps_;
  std::vector<Overlap> found_;
};

const ConvexPolyhedron& polyhedron_of(const Candidate& one) {
  if (one.facet) return one.facet->prism;
  return one.actor->structure.convex(ConvexSlot(std::size_t{one.slot}))->polyhedron;
}

}  // namespace

std::optional<CastHit> find_first(const WorldState& world, const QueryFilter& filter,
                                  const MovingBall& ball) {
  FirstHit visitor(world, filter, ball);
  visitor.run();
  return visitor.found;
}

std::vector<CastHit> find_all(const WorldState& world, const QueryFilter& filter,
                              const MovingBall& ball) {
  AllHits visitor(world, filter, ball);
  visitor.run();
  std::vector<CastHit>& found = visitor.found;
  std::ranges::sort(found, {}, order_of);
  const auto same = [](const CastHit& x, const CastHit& y) { return order_of(x) == order_of(y); };
  found.erase(std::unique(found.begin(), found.end(), same), found.end());
  return std::move(found);
}

std::vector<Overlap> find_overlaps(const WorldState& world, const QueryFilter& filter,
                                   const Vec3& center_W, double radius_m) {
  const auto overlaps = [&](const Candidate& one, const Candidates& all) {
    if (!one.actor && !one.facet) return center_W.y() - radius_m <= world.scene.ground.height_m;
    if (one.facet) return is_within(one.facet->prism, center_W, radius_m);
    const Pose X_WR = all.X_WR(*one.actor);
    if (one.actor->structure.empty())
      return (center_W - X_WR.position).norm() <= radius_m + ball_radius_m(one.actor->volume_m3);
    return is_within(polyhedron_of(one), X_WR.inverse() * center_W, radius_m);
  };
  OverlapVisitor visitor(world, filter, overlaps);
  const Vec3 half = Vec3::Constant(radius_m);
  world.physics->visit_in_box({center_W - half, center_W + half}, visitor);
  return visitor.take();
}

std::vector<Overlap> find_overlaps(const WorldState& world, const QueryFilter& filter,
                                   const Box& box_W) {
  const auto overlaps = [&](const Candidate& one, const Candidates& all) {
    if (!one.actor && !one.facet) return box_W.min.y() <= world.scene.ground.height_m;
    if (one.facet) return sunder::overlaps(one.facet->prism, Pose(), box_W);
    const Pose X_WR = all.X_WR(*one.actor);
    if (one.actor->structure.empty())
      return distance(box_W, X_WR.position) <= ball_radius_m(one.actor->volume_m3);
    return sunder::overlaps(polyhedron_of(one), X_WR, box_W);
  };
  OverlapVisitor visitor(world, filter, overlaps);
  world.physics->visit_in_box(box_W, visitor);
  return visitor.take();
}

}  // namespace sunder
