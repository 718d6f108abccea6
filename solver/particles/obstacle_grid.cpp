// Read first: sweep(). Shapes stay in their rest frames: only their boxes are brought to the world.
#include "solver/particles/obstacle_grid.h"

#include <algorithm>
#include <cmath>

#include "engine/base/parallel.h"

namespace sunder::solver {
namespace {

constexpr double kCell_m = 0.5;
constexpr int kMostCells = 48;                 // along an axis
constexpr std::size_t kMostEntries = 1 << 19;  // more makes cells coarser
constexpr std::size_t kChunk = 512;

VelocityField motion(const ObstacleBody& body) {
  return {body.X_WB.position, body.velocity_W, body.angular_velocity_W};
}

/// Clips a way by one plane of a convex, moved outward by the sphere's radius.
struct Clip {
  double enter = -1, leave = 1;
  double shallowest_m = -1e300;  ///< Greatest distance at the end of the way: the way out.
  std::size_t enter_face = 0, shallowest_face = 0;

  /// False once the way misses the convex.
  bool add(std::size_t face, double start_m, double end_m) {
    if (end_m > shallowest_m) {
      shallowest_m = end_m;
      shallowest_face = face;
    }
    if (start_m > 0) {
      if (end_m >= 0) return false;
      const double time = start_m / (start_m - end_m);
      if (time > enter) {
        enter = time;
        enter_face = face;
      }
    } else if (end_m > 0) {
      leave = std::min(leave, start_m / (start_m - end_m));
    }
    return enter <= leave;
  }
};

}  // namespace

/// The boxes that shapes sweep in the last step; empty for those not asked for.
void ObstacleGrid::place(std::size_t begin, std::size_t end, Which which) {
  for (std::size_t s = begin; s < end; ++s) {
    const ObstacleShape& shape = obstacles_.shapes[s];
    const ObstacleBody& body = obstacles_.bodies[shape.body];
    Box& box = boxes_[s];
    box = Box();
    if (which == Which::kMoving && !body.moves) continue;
    Vec3 center = body.X_WB.position;
    Vec3 half = Vec3::Constant(shape.radius_m);
    double reach = shape.radius_m;
    if (shape.hull) {
      const Mat3& rotation = rotations_WB_[shape.body];
      const Vec3 half_R = 0.5 * shape.box_R.extent();
      const Vec3 center_B = shape.box_R.center() - body.com_R;
      center += rotation * center_B;
      half = rotation.cwiseAbs() * half_R;
      reach = center_B.norm() + half_R.norm();
    }
    box.min = center - half;
    box.max = center + half;
    if (body.moves) {
      const Vec3 way = dt_s_ * (body.velocity_W.cwiseAbs() +
                                Vec3::Constant(body.angular_velocity_W.norm() * reach));
      box.min -= way;
      box.max += way;
    }
  }
}

void ObstacleGrid::choose_cells(const Box& region) {
  Box used;
  for (const Placed& placed : shapes_) {
    used.extend(placed.min.cast<double>());
    used.extend(placed.max.cast<double>());
  }
  used.min = used.min.cwiseMax(region.min);
  used.max = used.max.cwiseMin(region.max);
  const Vec3 extent = used.extent().cwiseMax(1e-3);
  for (int axis = 0; axis < 3; ++axis) {
    const double count = std::ceil(std::min(extent[axis] / kCell_m, double{kMostCells}));
    counts_[axis] = std::max(1, static_cast<int>(count));
  }
  origin_W_ = used.min.cast<float>();
  const auto set_scale = [&] {
    cells_per_m_ = counts_.cast<float>().cwiseQuotient(extent.cast<float>());
    last_cell_ = (counts_ - Cell::Ones()).cast<float>();
  };
  set_scale();
  const auto entries = [&] {
    std::size_t sum = 0;
    for (const Placed& placed : shapes_) {
      const Cell span = cell_of(placed.max) - cell_of(placed.min) + Cell::Ones();
      sum += static_cast<std::size_t>(span.prod());
    }
    return sum;
  };
  while (entries() > kMostEntries && counts_.maxCoeff() > 1) {
    counts_ = (counts_ / 2).cwiseMax(1);
    set_scale();
  }
}

void ObstacleGrid::sort_into_cells() {
  first_.assign(static_cast<std::size_t>(counts_.prod()) + 1, 0);
  const auto each_cell = [&](const Placed& placed, const auto& work) {
    const Cell low = cell_of(placed.min), high = cell_of(placed.max);
    for (int z = low.z(); z <= high.z(); ++z) {
      for (int y = low.y(); y <= high.y(); ++y) {
        const int row = (z * counts_.y() + y) * counts_.x();
        for (int x = low.x(); x <= high.x(); ++x) work(static_cast<std::size_t>(row + x));
      }
    }
  };
  for (const Placed& placed : shapes_) each_cell(placed, [&](std::size_t c) { ++first_[c + 1]; });
  for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
  entries_.resize(first_.back());
  // Filled from the back, the starts end where they should be and each cell is ascending.
  for (std::size_t c = first_.size() - 1; c > 0; --c) first_[c] = first_[c - 1];
  for (std::uint32_t s = 0; s < shapes_.size(); ++s) {
    each_cell(shapes_[s], [&](std::size_t c) { entries_[first_[c + 1]++] = s; });
  }
}

void ObstacleGrid::build(const Obstacles& obstacles, double dt_s, const Box& region, Which which) {
  obstacles_ = obstacles;
  dt_s_ = dt_s;
  shapes_.clear();
  if (region.empty()) return;
  const auto moves = [](const ObstacleBody& body) { return body.moves; };
  if (which == Which::kMoving && std::ranges::none_of(obstacles.bodies, moves)) return;
  rotations_WB_.resize(obstacles.bodies.size());
  for_chunks(obstacles.bodies.size(), kChunk, [&](std::size_t begin, std::size_t end, std::size_t) {
    for (std::size_t b = begin; b < end; ++b) {
      rotations_WB_[b] = obstacles.bodies[b].X_WB.rotation.toRotationMatrix();
    }
  });
  boxes_.resize(obstacles.shapes.size());
  for_chunks(boxes_.size(), kChunk,
             [&](std::size_t begin, std::size_t end, std::size_t) { place(begin, end, which); });
  for (std::uint32_t s = 0; s < boxes_.size(); ++s) {
    if (!boxes_[s].overlaps(region)) continue;
    shapes_.push_back({s, boxes_[s].min.cast<float>(), boxes_[s].max.cast<float>()});
  }
  if (shapes_.empty()) return;
  choose_cells(region);
  sort_into_cells();
}

/// One shape: the way in its rest frame, clipped by its planes.
void ObstacleGrid::meet(const Placed& placed, const Way& way, std::optional<Touch>& first) const {
  const ObstacleShape& shape = obstacles_.shapes[placed.shape];
  const ObstacleBody& body = obstacles_.bodies[shape.body];
  const VelocityField field = motion(body);
  // The way as seen from the body: its end is given at the body's end pose.
  const Vec3 start = body.moves ? Vec3(way.from + way.duration_s * field(way.from)) : way.from;
  Touch touch;
  touch.body = shape.body;
  Clip clip;
  if (shape.hull) {
    const Mat3& rotation = rotations_WB_[shape.body];
    const Vec3 start_R = rotation.transpose() * (start - body.X_WB.position) + body.com_R;
    const Vec3 end_R = rotation.transpose() * (way.to - body.X_WB.position) + body.com_R;
    for (std::size_t f = 0; f < shape.hull->faces.size(); ++f) {
      const Plane& plane = shape.hull->faces[f].plane;
      if (!clip.add(f, plane.distance(start_R) - way.radius_m,
                    plane.distance(end_R) - way.radius_m)) {
        return;
      }
    }
    const std::size_t face = clip.enter >= 0 ? clip.enter_face : clip.shallowest_face;
    touch.normal_W = rotation * shape.hull->faces[face].plane.normal;
  } else {
    // A ball: against its tangent plane where the way begins; exact for short ways.
    const Vec3 away = start - body.X_WB.position;
    const double distance = away.norm();
    if (distance > 0) touch.normal_W = away / distance;
    const double reach = shape.radius_m + way.radius_m;
    const double end_m = (way.to - body.X_WB.position).dot(touch.normal_W) - reach;
    if (!clip.add(0, distance - reach, end_m)) return;
  }
  touch.time = std::max(clip.enter, 0.0);
  if (clip.enter < 0) {
    touch.depth_m = -clip.shallowest_m;
    if (touch.depth_m <= 0) return;  // it leaves by itself
  }
  if (first && first->time <= touch.time) return;
  touch.velocity_W = field(way.to);
  first = touch;
}

std::optional<Touch> ObstacleGrid::sweep(const Way& way) const {
  std::optional<Touch> first;
  if (shapes_.empty()) return first;
  const Vec3 reach = Vec3::Constant(way.radius_m);
  const Vec3f low = (way.from.cwiseMin(way.to) - reach).cast<float>();
  const Vec3f high = (way.from.cwiseMax(way.to) + reach).cast<float>();
  const Cell first_cell = cell_of(low), last_cell = cell_of(high);
  for (int z = first_cell.z(); z <= last_cell.z(); ++z) {
    for (int y = first_cell.y(); y <= last_cell.y(); ++y) {
      for (int x = first_cell.x(); x <= last_cell.x(); ++x) {
        const auto cell = static_cast<std::size_t>((z * counts_.y() + y) * counts_.x() + x);
        for (std::uint32_t e = first_[cell]; e < first_[cell + 1]; ++e) {
          const Placed& placed = shapes_[entries_[e]];
          if (placed.reaches(low, high)) meet(placed, way, first);
        }
      }
    }
  }
  return first;
}

}  // namespace sunder::solver
