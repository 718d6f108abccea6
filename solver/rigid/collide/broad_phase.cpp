// Boxes, trees and new pairs.
#include "solver/rigid/collide/broad_phase.h"

#include <algorithm>

#include "engine/base/hash.h"
#include "engine/base/parallel.h"
#include "engine/base/state_checks.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

constexpr std::size_t kChunk = 512;
constexpr std::size_t kAhead = 4;  // number of hulls to prefetch
constexpr int kRefitsPerBuild = 12;
constexpr std::uint64_t kPairSeed = 24;  // of the hash that chooses pairs of a dense cluster

/// Returns the bounds of a hull rotated by R, about the body's centre.
FloatBox turned_bounds(const Hull& hull, const Mat3f& R) {
  Vec3f low, high;
  for (int axis = 0; axis < 3; ++axis) {
    const Wide3 row = {splat(R(axis, 0)), splat(R(axis, 1)), splat(R(axis, 2))};
    Wide least = splat(1e30f), most = splat(-1e30f);
    for (const Wide3& vertices : hull.vertices()) {
      const Wide along = dot(row, vertices);
      least = min(least, along);
      most = max(most, along);
    }
    low[axis] = min_lane(least), high[axis] = max_lane(most);
  }
  return {low, high};
}

/// Returns the bounds of a hull or sphere as its body is turned, about the body's centre.
FloatBox turned_bounds(const Shape& shape, const Bodies& bodies) {
  const Mat3f& R = bodies.rotation_f[shape.body];
  if (shape.kind == ShapeDesc::Kind::kHull) return turned_bounds(shape.hull, R);
  const Vec3f center = R * shape.center;
  return {center.array() - shape.radius_m, center.array() + shape.radius_m};
}

FloatBox swept_box(const StepContext& step, const Shape& shape, const Bodies& bodies) {
  const BodySlot body = shape.body;
  FloatBox box = turned_bounds(shape, bodies);
  float grow = kBoxMargin * shape.inner_radius_m;
  if (bodies.awake(body) || bodies.is_moving_kinematic(body)) {
    const double dt_s = step.dt_s;
    const Vec3f shift =
        (bodies.velocity[body] * dt_s + step.gravity_W * (dt_s * dt_s)).cast<float>();
    box.min += shift.cwiseMin(0.f);
    box.max += shift.cwiseMax(0.f);
    const double angle = std::min(2.0, bodies.angular_velocity[body].norm() * dt_s);
    grow += static_cast<float>(angle) * shape.reach_m;
  }
  const Vec3f at = bodies.position[body].cast<float>();
  grow += 4e-7f * (at.cwiseAbs().maxCoeff() + shape.reach_m);
  return {at + box.min - Vec3f::Constant(grow), at + box.max + Vec3f::Constant(grow)};
}

/// Returns a fat box, with room for a few steps of the same motion.
FloatBox fattened(const StepContext& step, const FloatBox& swept, const Shape& shape,
                  const Bodies& bodies) {
  FloatBox box = swept;
  if (!bodies.mobile(shape.body)) return box;
  const Vec3f shift = (2 * step.dt_s * bodies.velocity[shape.body]).cast<float>();
  const Vec3f grow = Vec3f::Constant(3 * kBoxMargin * shape.inner_radius_m);
  box.min += shift.cwiseMin(0.f) - grow;
  box.max += shift.cwiseMax(0.f) + grow;
  return box;
}

/// Returns the pair of two shapes, in the order of Pair.
FoundPair found_pair(ShapeSlot s, ShapeSlot t, const Shapes& shapes) {
  const Shape &first = shapes[s], &second = shapes[t];
  const bool swap = first.kind != second.kind ? first.kind == ShapeDesc::Kind::kSphere ||
                                                    second.kind == ShapeDesc::Kind::kHalfSpace
                    : first.facet != second.facet ? second.facet
                                                  : t < s;
  return {swap ? t : s, swap ? s : t};
}

}  // namespace

void BroadPhase::add(std::span<const ShapeSlot> added, const Shapes& shapes, const Bodies& bodies) {
  role_.resize(shapes.size(), Role::kAbsent);
  swept_.resize(shapes.size());
  fat_.resize(shapes.size());
  moved_.resize(shapes.size());
  has_skipped_.resize(shapes.size());
  half_space_of_.resize(shapes.size(), -1);
  for (const ShapeSlot s : added) {
    fat_[s] = FloatBox();
    has_skipped_[s] = 0;
    if (shapes[s].kind == ShapeDesc::Kind::kHalfSpace) {
      add_half_space(s, shapes, bodies);
    } else if (bodies.mobile(shapes[s].body)) {
      role_[s] = Role::kMover;
      movers_changed_ = true;
    } else {
      role_[s] = Role::kStatic;
      new_statics_.push_back(s);
    }
  }
}

const char* BroadPhase::wrong_field() const {
  const std::size_t shapes = role_.size();
  if (!have_size(shapes, swept_, fat_, moved_, has_skipped_, half_space_of_)) return "role_";
  const auto is_box = [](const FloatBox& box) {
    const bool is_empty = box.min == FloatBox().min && box.max == FloatBox().max;
    return is_empty ||
           (is_within(box.min, double{kMostBox_m}) && is_within(box.max, double{kMostBox_m}));
  };
  if (!std::ranges::all_of(swept_, is_box)) return "swept_";
  if (!std::ranges::all_of(fat_, is_box)) return "fat_";
  const auto have_role = [&](std::span<const ShapeSlot> some, Role role) {
    return are_different_below(some, shapes) &&
           std::ranges::all_of(some, [&](ShapeSlot s) { return role_[s] == role; });
  };
  const std::span<const ShapeSlot> leaves = mover_tree_.leaves();
  if (!are_different_below(movers_, shapes)) return "movers_";
  if (!are_different_below(leaves, shapes)) return "mover_tree_";
  if (!movers_changed_) {
    const auto movers = static_cast<std::size_t>(std::ranges::count(role_, Role::kMover));
    if (!have_role(movers_, Role::kMover) || movers_.size() != movers) return "movers_";
    if (!have_role(leaves, Role::kMover) || leaves.size() != movers) return "mover_tree_";
  }
  if (!have_role(new_statics_, Role::kStatic)) return "new_statics_";
  if (!are_different_below(moved_list_, shapes)) return "moved_list_";
  for (std::size_t i = 0; i < half_spaces_.size(); ++i) {
    const HalfSpace& half = half_spaces_[i];
    if (half.shape.value >= shapes || role_[half.shape] != Role::kHalfSpace ||
        half_space_of_[half.shape] != static_cast<std::int32_t>(i))
      return "half_spaces_";
  }
  std::size_t in_forest = 0;
  for (const ShapeSlot s : role_.slots()) {
    const bool is_new = std::ranges::find(new_statics_, s) != new_statics_.end();
    if (role_[s] == Role::kStatic && !is_new) {
      if (!static_forest_.contains(s)) return "static_forest_";
      ++in_forest;
    }
    const std::int32_t half = half_space_of_[s];
    if (role_[s] == Role::kHalfSpace
            ? half < 0 || static_cast<std::size_t>(half) >= half_spaces_.size()
            : half != -1)
      return "half_space_of_";
  }
  if (in_forest != static_forest_.size()) return "static_forest_";
  return refits_ >= 0 && refits_ <= kRefitsPerBuild ? nullptr : "refits_";
}

const char* BroadPhase::wrong_field(const Shapes& shapes) const {
  if (role_.size() != shapes.size()) return "role_";
  for (const ShapeSlot s : role_.slots()) {
    const Shape& shape = shapes[s];
    if ((role_[s] == Role::kAbsent) != shape.body.none()) return "role_";
    if (role_[s] == Role::kAbsent) continue;
    if ((role_[s] == Role::kHalfSpace) != (shape.kind == ShapeDesc::Kind::kHalfSpace))
      return "role_";
  }
  return nullptr;
}

Pair pair_of(ShapeSlot s, ShapeSlot t, const Shapes& shapes) {
  const FoundPair found = found_pair(s, t, shapes);
  Pair pair;
  pair.shape_a = found.shape_a, pair.shape_b = found.shape_b;
  pair.body_a = shapes[pair.shape_a].body, pair.body_b = shapes[pair.shape_b].body;
  return pair;
}

bool is_in_order(const Pair& pair, const Shapes& shapes) {
  return found_pair(pair.shape_a, pair.shape_b, shapes).shape_a == pair.shape_a;
}

void BroadPhase::remove(std::span<const ShapeSlot> removed) {
  for (const ShapeSlot s : removed) {
    if (role_[s] == Role::kHalfSpace) {
      remove_half_space(s);
    } else if (role_[s] == Role::kMover) {
      movers_changed_ = true;
    } else if (std::erase(new_statics_, s) == 0) {
      static_forest_.remove(s);
    }
    role_[s] = Role::kAbsent;
  }
}

void BroadPhase::add_half_space(ShapeSlot s, const Shapes& shapes, const Bodies& bodies) {
  const BodySlot body = shapes[s].body;
  const Vec3 normal_W = (bodies.rotation[body] * shapes[s].normal.cast<double>()).normalized();
  const Vec3 point_W =
      bodies.position[body] + bodies.rotation[body] * shapes[s].center.cast<double>();
  half_space_of_[s] = static_cast<std::int32_t>(half_spaces_.size());
  half_spaces_.push_back({s, normal_W.cast<float>(), static_cast<float>(-normal_W.dot(point_W))});
  role_[s] = Role::kHalfSpace;
  test_all_ = true;
}

void BroadPhase::remove_half_space(ShapeSlot s) {
  const auto at = static_cast<std::size_t>(half_space_of_[s]);
  half_spaces_.erase(half_spaces_.begin() + half_space_of_[s]);
  for (std::size_t i = at; i < half_spaces_.size(); ++i) --half_space_of_[half_spaces_[i].shape];
  half_space_of_[s] = -1;
}

std::vector<ShapeBox> BroadPhase::boxes(const Shapes& shapes, const Bodies& bodies) const {
  std::vector<ShapeBox> all;
  for (const ShapeSlot s : role_.slots()) {
    const bool has_box = role_[s] == Role::kMover || role_[s] == Role::kStatic;
    if (!has_box || fat_[s].min.x() > fat_[s].max.x()) continue;  // not tested since it was added
    all.push_back(
        {bodies.tag[shapes[s].body], {fat_[s].min.cast<double>(), fat_[s].max.cast<double>()}});
  }
  return all;
}

std::vector<ShapeSlot> BroadPhase::strays(const Shapes& shapes, const Bodies& bodies) const {
  return collect_chunks<ShapeSlot>(
      role_.size(), kChunk, [&](std::size_t begin, std::size_t end, std::vector<ShapeSlot>& found) {
        for (ShapeSlot s(begin); s.value < end; ++s.value) {
          if (role_[s] != Role::kMover && role_[s] != Role::kStatic) continue;
          const Shape& shape = shapes[s];
          const bool is_new = fat_[s].min.x() > fat_[s].max.x();
          if (!is_new && (role_[s] == Role::kStatic || !bodies.changed[shape.body])) continue;
          const Vec3f at = bodies.position[shape.body].cast<float>();
          const FloatBox box = turned_bounds(shape, bodies);
          if (is_new || !fat_[s].contains({at + box.min, at + box.max})) found.push_back(s);
        }
      });
}

void BroadPhase::update_boxes(const StepContext& step, const Shapes& shapes, const Bodies& bodies) {
  for (const ShapeSlot s : moved_list_) moved_[s] = 0;
  moved_list_.clear();
  if (movers_changed_) {
    movers_.clear();
    for (const ShapeSlot s : role_.slots())
      if (role_[s] == Role::kMover) movers_.push_back(s);
  }
  for_chunks(movers_.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const ShapeSlot s = movers_[i];
      const Shape& shape = shapes.items[s];
      if (i + kAhead < end) prefetch(shapes[movers_[i + kAhead]].hull.vertices(), 4);
      moved_[s] = test_all_ || has_skipped_[s];
      if (!bodies.changed[shape.body]) continue;
      swept_[s] = swept_box(step, shape, bodies);
      if (fat_[s].contains(swept_[s])) continue;
      fat_[s] = fattened(step, swept_[s], shape, bodies);
      moved_[s] = 1;
    }
  });
  test_all_ = false;
  for (const ShapeSlot s : movers_)
    if (moved_[s]) moved_list_.push_back(s);
  for_chunks(new_statics_.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t i = begin; i < end; ++i) {
      const ShapeSlot s = new_statics_[i];
      fat_[s] = swept_[s] = swept_box(step, shapes.items[s], bodies);
      moved_[s] = 1;
    }
  });
  moved_list_.insert(moved_list_.end(), new_statics_.begin(), new_statics_.end());
}

void BroadPhase::update_trees() {
  static_forest_.add(fat_, new_statics_);
  new_statics_.clear();
  if (movers_changed_ || (!moved_list_.empty() && ++refits_ >= kRefitsPerBuild)) {
    mover_tree_.build(fat_, movers_);
    refits_ = 0;
  } else if (!moved_list_.empty()) {
    mover_tree_.refit(fat_);
  }
  movers_changed_ = false;
}

std::vector<PairSlot> BroadPhase::pairs_with(std::span<const ShapeSlot> of, const Shapes& shapes,
                                             const Contacts& contacts) const {
  std::vector<PairSlot> slots;
  for (const ShapeSlot s : of) {
    const auto consider = [&](ShapeSlot other) {
      if (role_[other] == Role::kAbsent) return;  // removed since the tree was built
      const PairSlot slot = contacts.slot(found_pair(s, other, shapes).key());
      if (!slot.none()) slots.push_back(slot);
    };
    if (role_[s] == Role::kHalfSpace) {
      for (const ShapeSlot other : movers_) consider(other);
      continue;
    }
    mover_tree_.overlaps(fat_[s], consider);
    if (role_[s] != Role::kMover) continue;
    static_forest_.overlaps(fat_[s], consider);
    for (const HalfSpace& plane : half_spaces_) consider(plane.shape);
  }
  std::sort(slots.begin(), slots.end());
  slots.erase(std::unique(slots.begin(), slots.end()), slots.end());
  return slots;
}

/// Leaves out most pairs of movers in a dense cluster whose centres are close: the share that is
/// kept falls with the number of neighbours, and is alike for both shapes of a pair as far as their
/// numbers are. The next update tests the shape again.
void BroadPhase::drop_pairs(ShapeSlot shape, std::size_t neighbours, const Shapes& shapes,
                            const Bodies& bodies, std::vector<FoundPair>& found,
                            std::size_t first) {
  const std::uint64_t share = ~std::uint64_t{0} / neighbours * kMaxNeighbours;
  const auto middle = [&](const Shape& s) {
    return Vec3(bodies.position[s.body] + (bodies.rotation_f[s.body] * s.center).cast<double>());
  };
  const auto left_out = [&](const FoundPair& pair) {
    const Shape &a = shapes[pair.shape_a], &b = shapes[pair.shape_b];
    if (a.kind == ShapeDesc::Kind::kHalfSpace) return false;
    if (!bodies.dynamic(a.body) || !bodies.dynamic(b.body)) return false;
    const double deep = double{(1 - kDenseOverlap) * (a.inner_radius_m + b.inner_radius_m)};
    return combine(kPairSeed, pair.key()) > share &&
           (middle(a) - middle(b)).squaredNorm() < deep * deep;
  };
  const auto kept =
      std::remove_if(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(), left_out);
  has_skipped_[shape] = kept != found.end();
  found.erase(kept, found.end());
}

void BroadPhase::find_pairs(ShapeSlot shape, const Shapes& shapes, const Bodies& bodies,
                            const Contacts& contacts, std::vector<FoundPair>& found) {
  const Shape& own = shapes[shape];
  const bool mover = bodies.dynamic(own.body);
  const std::size_t first = found.size();
  std::size_t neighbours = 0;
  auto consider = [&](ShapeSlot other) {
    const Shape& neighbour = shapes[other];
    ++neighbours;
    if (neighbour.body == own.body || (moved_[other] && other < shape)) return;
    if (!bodies.filter[own.body].collides_with(bodies.filter[neighbour.body])) return;
    if (!mover && !bodies.dynamic(neighbour.body)) return;
    const FoundPair pair = found_pair(shape, other, shapes);
    if (contacts.slot(pair.key()).none()) found.push_back(pair);
  };
  mover_tree_.overlaps(fat_[shape], consider);
  const auto order = [&] {
    std::sort(found.begin() + static_cast<std::ptrdiff_t>(first), found.end(),
              [](const FoundPair& p, const FoundPair& q) { return p.key() < q.key(); });
  };
  if (!mover) return order();
  static_forest_.overlaps(fat_[shape], consider);
  for (const HalfSpace& plane : half_spaces_) {
    Pair pair;
    pair.shape_a = plane.shape, pair.shape_b = shape;
    if (overlaps(pair, fat_)) consider(plane.shape);
  }
  has_skipped_[shape] = 0;
  if (neighbours > kMaxNeighbours) drop_pairs(shape, neighbours, shapes, bodies, found, first);
  order();
}

void BroadPhase::update(const StepContext& step, const Shapes& shapes, const Bodies& bodies,
                        Contacts& contacts) {
  update_boxes(step, shapes, bodies);
  update_trees();
  const std::size_t chunks = (moved_list_.size() + kChunk - 1) / kChunk;
  if (found_.size() < chunks) found_.resize(chunks);
  for_chunks(moved_list_.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t c) {
    found_[c].clear();
    for (std::size_t i = begin; i < end; ++i)
      find_pairs(moved_list_[i], shapes, bodies, contacts, found_[c]);
  });
  std::size_t all = 0;
  for (std::size_t c = 0; c < chunks; ++c) all += found_[c].size();
  contacts.expect_pairs(all);
  for (std::size_t c = 0; c < chunks; ++c) {
    for (const FoundPair& found : found_[c])
      contacts.add(pair_of(found.shape_a, found.shape_b, shapes));
  }
}

bool BroadPhase::overlaps(const Pair& pair, const ByShape<FloatBox>& boxes) const {
  const std::int32_t plane = half_space_of_[pair.shape_a];
  if (plane < 0) return boxes[pair.shape_a].overlaps(boxes[pair.shape_b]);
  const HalfSpace& half = half_spaces_[static_cast<std::size_t>(plane)];
  const FloatBox& box = boxes[pair.shape_b];
  const Vec3f center = 0.5f * (box.min + box.max), extent = 0.5f * (box.max - box.min);
  return half.normal_W.dot(center) + half.d <= half.normal_W.cwiseAbs().dot(extent);
}

bool BroadPhase::may_touch(const Pair& pair) const { return overlaps(pair, swept_); }

bool BroadPhase::is_near(const Pair& pair) const { return overlaps(pair, fat_); }

}  // namespace sunder::solver
