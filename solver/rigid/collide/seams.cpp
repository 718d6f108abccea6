#include "solver/rigid/collide/seams.h"

#include <algorithm>
#include <cstdint>
#include <vector>

#include "engine/base/parallel.h"
#include "solver/rigid/collide/narrow_phase.h"
#include "solver/rigid/collide/speculative_contacts.h"
#include "solver/rigid/tuning.h"

namespace sunder::solver {
namespace {

using Kind = ShapeDesc::Kind;

/// A pair as seen from one of its shapes, the slider; the other shape bears it.
struct Support {
  ShapeSlot bearer;
  BodySlot bearing_body;
  PairSlot pair;
  bool bearer_is_a;
  const Manifold* manifold;  ///< Null if they are only near.

  /// Returns the unit normal away from the bearer.
  Vec3f normal_W() const { return bearer_is_a ? manifold->normal_W : Vec3f(-manifold->normal_W); }
  /// Returns a contact point on the bearer, in its frame.
  const Vec3f& point(std::size_t i) const {
    return bearer_is_a ? manifold->points[i].anchor_A : manifold->points[i].anchor_B;
  }
};

Support support_of(const Pair& pair, PairSlot slot, bool bearer_is_a, const Manifold* manifold) {
  return bearer_is_a ? Support{pair.shape_a, pair.body_a, slot, true, manifold}
                     : Support{pair.shape_b, pair.body_b, slot, false, manifold};
}

/// A plane through a point in the frame of a body.
struct Plane {
  Vec3f normal_W;
  BodySlot body;
  Vec3f point;
};

bool stands(const StepContext& step, const Bodies& bodies, BodySlot body) {
  return !bodies.dynamic(body) || bodies.fastest_m_s(body) < step.rest_speed_m_s;
}

/// True if a shape may form a surface with others: with those of its body, or of others that stand.
bool may_continue(const StepContext& step, const Shapes& shapes, const Bodies& bodies,
                  ShapeSlot slot) {
  const Shape& shape = shapes[slot];
  return shape.kind == Kind::kHull &&
         (!shape.next.none() || !shape.previous.none() || stands(step, bodies, shape.body));
}

class Seams {
 public:
  Seams(const StepContext& step, const Shapes& shapes, const Bodies& bodies)
      : step_(step), shapes_(shapes), bodies_(bodies) {}

  /// True if one of the contacts of a slider, whose pairs are `near`, covers another.
  bool is_covered(const Support& contact, std::span<const Support> near) const {
    return std::any_of(near.begin(), near.end(),
                       [&](const Support& other) { return covers(other, contact, near); });
  }

 private:
  bool covers(const Support& second, const Support& first, std::span<const Support> near) const {
    if (!second.manifold || first.pair == second.pair) return false;
    if (first.bearing_body != second.bearing_body && !(stands(step_, bodies_, first.bearing_body) &&
                                                       stands(step_, bodies_, second.bearing_body)))
      return false;
    if (shapes_[second.bearer].kind == Kind::kSphere) return false;
    const Vec3f normal_W = first.normal_W();
    if (normal_W.dot(second.normal_W()) > kSeamCosine) return false;
    const Plane top = face_toward(second.normal_W(), second);
    const float tolerance_m = kSeamTolerance * first.manifold->size_m;
    if (normal_W.dot(top.normal_W) > kSeamCosine || rises_above(top, first, tolerance_m))
      return false;
    for (std::size_t i = 0; i < first.manifold->count; ++i) {
      const Plane plane{normal_W, first.bearing_body, first.point(i)};
      if (!rises_above(plane, second, tolerance_m)) continue;
      const bool continues = std::any_of(near.begin(), near.end(), [&](const Support& other) {
        return other.pair != first.pair && holds(other, plane, tolerance_m) &&
               rises_above(plane, other, tolerance_m) && !rises_above(top, other, tolerance_m);
      });
      if (continues) return true;
    }
    return false;
  }

  /// Returns the face of a bearer that faces a direction most.
  Plane face_toward(const Vec3f& direction_W, const Support& support) const {
    const Shape& shape = shapes_[support.bearer];
    const Mat3f& R = bodies_.rotation_f[support.bearing_body];
    if (shape.kind == Kind::kHalfSpace)
      return {R * shape.normal, support.bearing_body, shape.center};
    const Vec3f direction = R.transpose() * direction_W;
    std::uint32_t face = 0;
    for (std::uint32_t f = 1; f < shape.hull.face_count(); ++f)
      if (shape.hull.normal(f).dot(direction) > shape.hull.normal(face).dot(direction)) face = f;
    return {R * shape.hull.normal(face), support.bearing_body,
            -shape.hull.plane_d(face) * shape.hull.normal(face)};
  }
  /// True if a bearer has a point above a plane.
  bool rises_above(const Plane& plane, const Support& support, float tolerance_m) const {
    const Shape& shape = shapes_[support.bearer];
    if (shape.kind == Kind::kHalfSpace) {
      const Vec3f up_W = bodies_.rotation_f[support.bearing_body] * shape.normal;
      return up_W.dot(plane.normal_W) < kSeamCosine;
    }
    const Vec3f normal = bodies_.rotation_f[support.bearing_body].transpose() * plane.normal_W;
    const float limit =
        normal.dot(moved(plane.body, support.bearing_body, plane.point)) + tolerance_m;
    for (std::uint32_t v = 0; v < shape.hull.vertex_count(); ++v)
      if (normal.dot(shape.hull.vertex(v)) > limit) return true;
    return false;
  }
  /// True if the point of a plane is on a bearer or in it.
  bool holds(const Support& support, const Plane& plane, float tolerance_m) const {
    const Shape& shape = shapes_[support.bearer];
    const Vec3f point = moved(plane.body, support.bearing_body, plane.point);
    if (shape.kind == Kind::kSphere) return false;
    if (shape.kind == Kind::kHalfSpace)
      return shape.normal.dot(point - shape.center) <= tolerance_m;
    const float reach_m = shape.hull.reach_m() + tolerance_m;
    if (point.squaredNorm() > reach_m * reach_m) return false;
    return distance_to_hull(shape.hull, point).distance_m <= tolerance_m;
  }
  /// Returns a point in the frame of another body.
  Vec3f moved(BodySlot from, BodySlot to, const Vec3f& point) const {
    if (to == from) return point;
    const Vec3f offset_W = (bodies_.position[from] - bodies_.position[to]).cast<float>();
    return bodies_.rotation_f[to].transpose() * (offset_W + bodies_.rotation_f[from] * point);
  }

  const StepContext& step_;
  const Shapes& shapes_;
  const Bodies& bodies_;
};

/// The pairs of some shapes, by shape.
class SupportsOf {
 public:
  SupportsOf(const std::vector<ShapeSlot>& sliders, std::span<const ContactChanges> changes,
             const Shapes& shapes, const Contacts& contacts)
      : row_(shapes.size(), kNone) {
    std::uint32_t rows = 0;
    for (const ShapeSlot slider : sliders)
      if (row_[slider] == kNone) row_[slider] = rows++;
    constexpr std::size_t kChunk = 4096;
    const std::vector<PairSlot> pairs = collect_chunks<PairSlot>(
        contacts.pairs.size(), kChunk,
        [&](std::size_t begin, std::size_t end, std::vector<PairSlot>& found) {
          for (PairSlot i(begin); i.value < end; ++i.value) {
            const Pair& pair = contacts.pairs[i];
            if (pair.present() && (row_[pair.shape_a] != kNone || row_[pair.shape_b] != kNone))
              found.push_back(i);
          }
        });
    first_.assign(rows + 2, 0);
    const auto for_sides = [&](const auto& use) {
      for (const PairSlot i : pairs) {
        const Pair& pair = contacts.pairs[i];
        if (row_[pair.shape_a] != kNone) use(row_[pair.shape_a], pair, i, false);
        if (row_[pair.shape_b] != kNone) use(row_[pair.shape_b], pair, i, true);
      }
    };
    for_sides([&](std::uint32_t row, const Pair&, PairSlot, bool) { ++first_[row + 2]; });
    for (std::uint32_t row = 2; row < first_.size(); ++row) first_[row] += first_[row - 1];
    supports_.resize(first_.back());
    for_sides([&](std::uint32_t row, const Pair& pair, PairSlot i, bool bearer_is_a) {
      const Manifold* m = pair.touching() ? &contacts.manifolds[pair.manifold] : nullptr;
      supports_[first_[row + 1]++] =
          support_of(pair, i, bearer_is_a, m && m->count > 0 ? m : nullptr);
    });
    for (const ContactChanges& chunk : changes) {
      for (const auto& [i, manifold] : chunk.touched) {
        const Pair& pair = contacts.pairs[i];
        for (const ShapeSlot slider : {pair.shape_a, pair.shape_b})
          for (Support& support : of(slider))
            if (support.pair == i) support.manifold = &manifold;
      }
    }
  }

  std::span<Support> of(ShapeSlot slider) {
    const std::uint32_t row = row_[slider];
    if (row == kNone) return {};
    return std::span(supports_).subspan(first_[row], first_[row + 1] - first_[row]);
  }

 private:
  static constexpr std::uint32_t kNone = ~std::uint32_t{0};

  ByShape<std::uint32_t> row_;
  std::vector<std::uint32_t> first_;  ///< First index into `supports_`, by row.
  std::vector<Support> supports_;     ///< By pair slot.
};

}  // namespace

bool may_be_at_seam(const StepContext& step, const Shapes& shapes, const Bodies& bodies,
                    const Pair& pair, const Manifold& m) {
  const double fastest_m_s = bodies.fastest_m_s(pair.body_a) + bodies.fastest_m_s(pair.body_b);
  if (2 * fastest_m_s < step.rest_speed_m_s) return false;
  if (shapes[pair.shape_a].kind == Kind::kHalfSpace) return false;
  if (!may_continue(step, shapes, bodies, pair.shape_a) &&
      !may_continue(step, shapes, bodies, pair.shape_b))
    return false;
  return std::any_of(m.points.begin(), m.points.begin() + m.count, [&](const ManifoldPoint& p) {
    return closing_speed(m, bodies, p.arm_A, p.arm_B) > step.rest_speed_m_s;
  });
}

void drop_covered(const StepContext& step, std::span<ContactChanges> changes, Contacts& contacts,
                  const Shapes& shapes, const Bodies& bodies) {
  constexpr std::size_t kChunk = 16;
  std::vector<PairSlot> closing;
  for (const ContactChanges& chunk : changes)
    closing.insert(closing.end(), chunk.closing.begin(), chunk.closing.end());
  if (closing.empty()) return;
  std::vector<ShapeSlot> sliders;
  for (const PairSlot i : closing) {
    const Pair& pair = contacts.pairs[i];
    if (may_continue(step, shapes, bodies, pair.shape_a)) sliders.push_back(pair.shape_b);
    if (may_continue(step, shapes, bodies, pair.shape_b)) sliders.push_back(pair.shape_a);
  }
  SupportsOf supports(sliders, changes, shapes, contacts);
  const Seams seams(step, shapes, bodies);
  const auto is_covered = [&](PairSlot i, ShapeSlot slider) {
    const std::span<const Support> near = supports.of(slider);
    const auto contact = std::ranges::find(near, i, &Support::pair);
    return contact != near.end() && shapes[contact->bearer].kind == Kind::kHull &&
           seams.is_covered(*contact, near);
  };
  const std::vector<PairSlot> covered = collect_chunks<PairSlot>(
      closing.size(), kChunk,
      [&](std::size_t begin, std::size_t end, std::vector<PairSlot>& found) {
        for (std::size_t k = begin; k < end; ++k) {
          const Pair& pair = contacts.pairs[closing[k]];
          if (is_covered(closing[k], pair.shape_a) || is_covered(closing[k], pair.shape_b))
            found.push_back(closing[k]);
        }
      });
  for (ContactChanges& chunk : changes) {
    std::erase_if(chunk.touched, [&](const auto& touched) {
      return std::ranges::binary_search(covered, touched.first);
    });
  }
  for (const PairSlot i : covered) {
    Pair& pair = contacts.pairs[i];
    pair.needs_test = true;
    if (pair.touching()) changes.front().separated.push_back(i);
  }
}

}  // namespace sunder::solver
