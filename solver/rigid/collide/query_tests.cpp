#include "solver/rigid/collide/query_tests.h"

#include "solver/base/lanes.h"

namespace sunder::solver {
namespace {

constexpr float kQueryRounding = 1e-6f;  // of lengths in floats, over the largest length

}  // namespace

bool may_meet(const Ray& ray, const Shape& shape, const Bodies& bodies) {
  if (shape.kind != ShapeDesc::Kind::kHull || shape.facet) return true;
  const Mat3f back = bodies.rotation_f[shape.body].transpose();
  const Vec3f from = back * (ray.from_W - bodies.position[shape.body]).cast<float>();
  const Vec3f along = back * ray.direction_W.cast<float>();
  const float pad_m = ray.radius_m + kQueryRounding * (from.norm() + shape.reach_m);
  const Wide3 start = splat3(from), way = splat3(along);
  Wide enter = splat(0.f), leave = splat(ray.most);
  for (const Hull::PlaneChunk& planes : shape.hull.planes()) {
    const Wide height = dot(planes.normal, start) + planes.d - pad_m;
    const Wide rise = dot(planes.normal, way);
    // Planes along the ray divide by a tiny number: they keep out all of the ray or nothing.
    const Wide tiny = splat(1e-20f);
    const Wide steep = rise >= 0.f ? max(rise, tiny) : min(rise, -tiny);
    const Wide at = -height / steep;
    enter = max(enter, rise < 0.f ? at : enter);
    leave = min(leave, rise < 0.f ? leave : at);
  }
  const float first = max_lane(enter), last = min_lane(leave);
  return first * (1 - kQueryRounding) <= last * (1 + kQueryRounding) + kQueryRounding * pad_m;
}

bool may_overlap(const FloatBox& box_W, const Shape& shape, const Bodies& bodies) {
  if (shape.kind != ShapeDesc::Kind::kHull) return true;
  const Mat3f& R = bodies.rotation_f[shape.body];
  const Vec3f middle_W = 0.5f * (box_W.min + box_W.max), half = 0.5f * (box_W.max - box_W.min);
  const Vec3f center =
      R.transpose() * (middle_W.cast<double>() - bodies.position[shape.body]).cast<float>();
  const float pad_m = kQueryRounding * (middle_W.cwiseAbs().maxCoeff() + center.norm() +
                                        shape.reach_m + half.norm());
  const Wide3 point = splat3(center);
  for (const Hull::PlaneChunk& planes : shape.hull.planes()) {
    Wide reach = splat(pad_m);
    for (int axis = 0; axis < 3; ++axis) {
      const Wide along = dot(splat3(R.row(axis).transpose()), planes.normal);
      reach += half[axis] * max(along, -along);
    }
    if (any(dot(planes.normal, point) + planes.d > reach)) return false;
  }
  return true;
}

}  // namespace sunder::solver
