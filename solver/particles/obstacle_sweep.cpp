// Read first: sweep_spheres(). Eight paths at a time are tested against the box of each shape
// nearby, and those that meet the box are clipped by the planes of the shape.
#include "solver/particles/obstacle_sweep.h"

#include <algorithm>
#include <bit>

#include "solver/base/wide.h"

namespace sunder::solver {
namespace {

constexpr float kInfinity_m = 1e30f;

/// Eight paths clipped by the planes of a convex, which are moved outward by the spheres' radii.
struct Clip {
  Wide enter = splat(-1), leave = splat(1);
  Wide shallowest_m = splat(-kInfinity_m);  ///< Greatest distance to a plane at the end of a path.
  WideInt enter_face{}, shallowest_face{};
  WideInt misses{};

  void add(std::int32_t face, Wide start_m, Wide end_m) {
    const WideInt shallower = end_m > shallowest_m;
    shallowest_m = shallower ? end_m : shallowest_m;
    shallowest_face = shallower ? face - WideInt{} : shallowest_face;
    const WideInt starts_out = start_m > 0, ends_out = end_m >= 0;
    misses |= starts_out & ends_out;
    const Wide time = start_m / (start_m - end_m);
    const WideInt enters = starts_out & ~ends_out & (time > enter);
    enter = enters ? time : enter;
    enter_face = enters ? face - WideInt{} : enter_face;
    leave = (~starts_out & (end_m > 0) & (time < leave)) ? time : leave;
    misses |= enter > leave;
  }
};

Wide3 wide3(const Vec3f& v) { return {splat(v.x()), splat(v.y()), splat(v.z())}; }

/// Returns the lanes in which the interval from start to end overlaps that from −reach to reach.
WideInt inside(Wide start, Wide end, Wide reach) {
  return (min(start, end) <= reach) & (max(start, end) >= -reach);
}

struct WidePaths {
  Wide3 from, to, low, high;
  Wide radius_m, duration_s;

  explicit WidePaths(std::span<const SpherePath> paths);
};

/// Eight paths relative to the centre of a shape's box, in the axes of the box.
struct LocalPaths {
  Wide3 start, end;
  std::uint32_t meet = 0;  ///< Bit mask of the paths that meet the box.

  LocalPaths() = default;
  LocalPaths(const WidePaths& paths, const PlacedObstacle& shape);
};

/// Prefetches the data of a shape that meet() reads.
void prefetch_shape(const PlacedObstacle& shape, const Obstacles& obstacles) {
  __builtin_prefetch(&obstacles.shapes[shape.shape]);
  const auto* from = reinterpret_cast<const char*>(shape.faces.data());
  for (std::size_t at = 0; at < shape.faces.size_bytes(); at += 64) __builtin_prefetch(from + at);
}

WidePaths::WidePaths(std::span<const SpherePath> paths) {
  alignas(Wide) float lanes[8][kLanes];
  for (std::uint32_t i = 0; i < kLanes; ++i) {
    const bool is_used = i < paths.size();
    for (int axis = 0; axis < 3; ++axis) {
      lanes[axis][i] = is_used ? static_cast<float>(paths[i].from[axis]) : kInfinity_m;
      lanes[3 + axis][i] = is_used ? static_cast<float>(paths[i].to[axis]) : kInfinity_m;
    }
    lanes[6][i] = is_used ? static_cast<float>(paths[i].radius_m) : 0;
    lanes[7][i] = is_used ? static_cast<float>(paths[i].duration_s) : 0;
  }
  from = {load(lanes[0]), load(lanes[1]), load(lanes[2])};
  to = {load(lanes[3]), load(lanes[4]), load(lanes[5])};
  radius_m = load(lanes[6]);
  duration_s = load(lanes[7]);
  low = {min(from.x, to.x) - radius_m, min(from.y, to.y) - radius_m, min(from.z, to.z) - radius_m};
  high = {max(from.x, to.x) + radius_m, max(from.y, to.y) + radius_m, max(from.z, to.z) + radius_m};
}

LocalPaths::LocalPaths(const WidePaths& paths, const PlacedObstacle& shape) {
  const Wide3 least = wide3(shape.min), most = wide3(shape.max);
  WideInt meets = (paths.low.x <= most.x) & (paths.low.y <= most.y) & (paths.low.z <= most.z) &
                  (paths.high.x >= least.x) & (paths.high.y >= least.y) & (paths.high.z >= least.z);
  if (bits(meets) == 0) return;
  const Wide3 center = wide3(shape.center_W);
  const Wide3 from_W = paths.from - center, to_W = paths.to - center;
  // The pose of the shape is that at the end of the step: its motion is added to the path's start.
  const Wide3 moved = wide3(shape.velocity_W) + cross(wide3(shape.angular_velocity_W), from_W);
  const Wide3 start_W = from_W + moved * paths.duration_s;
  const auto seen = [&](int axis, Wide& from, Wide& until) {
    const Wide3 row = wide3(shape.rotation_BW.row(axis));
    from = dot(row, start_W);
    until = dot(row, to_W);
    meets &= inside(from, until, shape.half_m[axis] + paths.radius_m);
  };
  seen(0, start.x, end.x);
  seen(1, start.y, end.y);
  seen(2, start.z, end.z);
  meet = bits(meets);
}

/// Finds the contacts of paths that meet a shape's box; keeps those earlier than `touches`.
void meet(const PlacedObstacles& all, const PlacedObstacle& placed, const WidePaths& wide,
          const LocalPaths& seen, std::span<const SpherePath> paths,
          std::span<std::optional<SphereContact>> touches) {
  const ObstacleShape& shape = all.obstacles.shapes[placed.shape];
  Clip clip;
  Wide front_m = splat(0);  // distance to the first face at the end of a path
  std::uint32_t left = seen.meet;
  if (!placed.faces.empty()) {
    const Vec3 center_R = shape.box_R.center();
    std::int32_t number = 0;
    for (const auto& face : placed.faces) {
      const Wide3 normal = wide3(face.plane.normal.cast<float>());
      // The sides of a facet are not moved outward, because its neighbours continue there.
      const Wide radius_m = shape.facet && number > 0 ? splat(0) : wide.radius_m;
      const Wide reach = static_cast<float>(-face.plane.distance(center_R)) + radius_m;
      const Wide end_m = dot(normal, seen.end) - reach;
      if (number == 0) front_m = end_m;
      clip.add(number++, dot(normal, seen.start) - reach, end_m);
      left &= ~bits(clip.misses);
      if (left == 0) return;
    }
  } else {
    // A ball: clipped by its tangent plane nearest to the start of the path; exact for short paths.
    const Wide distance = sqrt(dot(seen.start, seen.start));
    const Wide reach = static_cast<float>(shape.radius_m) + wide.radius_m;
    const Wide along = dot(seen.start, seen.end) / max(distance, splat(1e-9f));
    clip.add(0, distance - reach, along - reach);
    left &= ~bits(clip.misses);
  }
  for (; left != 0; left &= left - 1) {
    const auto i = static_cast<std::uint32_t>(std::countr_zero(left));
    SphereContact touch;
    touch.time = std::max(double{clip.enter[i]}, 0.0);
    std::int32_t face = clip.enter[i] >= 0 ? clip.enter_face[i] : clip.shallowest_face[i];
    const bool is_at_side = shape.facet && face != 0;  // the sphere comes from a neighbouring facet
    if (is_at_side) face = 0;
    if (clip.enter[i] < 0 || is_at_side) {
      touch.depth_m = -double{is_at_side ? front_m[i] : clip.shallowest_m[i]};
      if (touch.depth_m <= 0) continue;  // the sphere leaves the obstacle by its own motion
    }
    std::optional<SphereContact>& first = touches[i];
    if (first && first->time <= touch.time) continue;
    const ObstacleBody& body = all.obstacles.bodies[shape.body];
    if (!placed.faces.empty()) {
      touch.normal_W =
          all.rotations_WB[shape.body] * placed.faces[static_cast<std::size_t>(face)].plane.normal;
    } else {
      const Vec3 start_B(double{seen.start.x[i]}, double{seen.start.y[i]}, double{seen.start.z[i]});
      if (start_B.norm() > 0) touch.normal_W = all.rotations_WB[shape.body] * start_B.normalized();
    }
    touch.velocity_W =
        VelocityField{body.X_WB.position, body.velocity_W, body.angular_velocity_W}(paths[i].to);
    touch.body = shape.body;
    first = touch;
  }
}

}  // namespace

/// Each shape met is prefetched, and tested when the next is found: its data are then in the cache.
void sweep_spheres(const PlacedObstacles& placed, std::span<const std::uint32_t> near,
                   std::span<const SpherePath> paths,
                   std::span<std::optional<SphereContact>> touches) {
  for (std::optional<SphereContact>& touch : touches) touch.reset();
  if (near.empty()) return;
  const WidePaths wide(paths);
  const PlacedObstacle* pending = nullptr;
  LocalPaths pending_paths;
  for (const std::uint32_t index : near) {
    const PlacedObstacle& shape = placed.shapes[index];
    const LocalPaths seen(wide, shape);
    if (seen.meet == 0) continue;
    prefetch_shape(shape, placed.obstacles);
    if (pending) meet(placed, *pending, wide, pending_paths, paths, touches);
    pending = &shape;
    pending_paths = seen;
  }
  if (pending) meet(placed, *pending, wide, pending_paths, paths, touches);
}

}  // namespace sunder::solver
