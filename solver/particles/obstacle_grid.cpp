// Read first: build(). Shapes stay in their rest frames; only their boxes are transformed to W.
#include "solver/particles/obstacle_grid.h"

#include <algorithm>
#include <cmath>

#include "engine/base/parallel.h"
#include "solver/particles/tuning.h"

namespace sunder::solver {
namespace {

// Rounding error of positions: absolute, and as a fraction of the distance from the origin.
constexpr double kPositionError_m = 1e-4, kRelativePositionError = 3e-7;
constexpr int kLevels = 31;
constexpr std::size_t kObstaclesPerChunk = 512;

/// Returns the number of cells of a level per metre along an axis.
float cells_per_m(int level) {
  return 1 / (kFinestObstacleCell_m * static_cast<float>(1 << level));
}

/// Returns the finest level on which a box of that extent overlaps at most kMaxCellsPerObstacle
/// cells.
int level_of(const Vec3f& extent) {
  for (int level = 0;; ++level) {
    const Vec3f cells = (extent.array() + 2 * kObstacleCellMargin_m) * cells_per_m(level) + 1;
    if (level + 1 == kLevels || cells.prod() <= kMaxCellsPerObstacle) return level;
  }
}

std::uint32_t hash_of(int level, const Eigen::Vector3i& cell) {
  return static_cast<std::uint32_t>(cell.x()) * 73856093u ^
         static_cast<std::uint32_t>(cell.y()) * 19349663u ^
         static_cast<std::uint32_t>(cell.z()) * 83492791u ^
         static_cast<std::uint32_t>(level) * 2654435761u;
}

/// Returns the cell of level 0 that holds a point; a right shift by a level gives the cell there.
Eigen::Vector3i cell_of(const Vec3f& point_W) {
  // Clamped far outside any scene, so that the cast is defined.
  return (point_W / kFinestObstacleCell_m).array().floor().max(-1e9f).min(1e9f).cast<int>();
}

/// Calls visit(hash, cell) for the cells of a level around the level-0 cells `first` to `last`.
template <class Visit>
void for_cells(int level, const Eigen::Vector3i& first, const Eigen::Vector3i& last,
               const Visit& visit) {
  for (int z = first.z() >> level; z <= last.z() >> level; ++z) {
    for (int y = first.y() >> level; y <= last.y() >> level; ++y) {
      for (int x = first.x() >> level; x <= last.x() >> level; ++x) {
        const Eigen::Vector3i cell(x, y, z);
        visit(hash_of(level, cell), cell);
      }
    }
  }
}

bool overlap(const Vec3f& min, const Vec3f& max, const Vec3f& low, const Vec3f& high) {
  return (min.array() <= high.array()).all() && (low.array() <= max.array()).all();
}

}  // namespace

/// Computes the boxes that shapes sweep in the last step; empty for shapes that `which` excludes.
void ObstacleGrid::compute_boxes(std::size_t begin, std::size_t end, Which which) {
  for (std::size_t s = begin; s < end; ++s) {
    const ObstacleShape& shape = placed_.obstacles.shapes[s];
    const ObstacleBody& body = placed_.obstacles.bodies[shape.body];
    Box& box = boxes_[s];
    box = Box();
    if (which == Which::kMoving && !body.moves) continue;
    Vec3 center = body.X_WB.position;
    Vec3 half = Vec3::Constant(shape.radius_m);
    double reach = shape.radius_m;
    if (shape.hull) {
      const Mat3& rotation = placed_.rotations_WB[shape.body];
      const Vec3 half_R = 0.5 * shape.box_R.extent();
      const Vec3 center_B = shape.box_R.center() - body.com_R;
      center += rotation * center_B;
      half = rotation.cwiseAbs() * half_R;
      reach = center_B.norm() + half_R.norm();
    }
    box.min = center - half;
    box.max = center + half;
    if (!body.moves) continue;
    const double spin_m_s = body.angular_velocity_W.norm() * reach;
    if (which == Which::kMoving && body.velocity_W.norm() + spin_m_s < kObstacleRestSpeed_m_s) {
      box = Box();
      continue;
    }
    // The pose is that at the end of the step, so the swept box extends backwards.
    const Vec3 shift = dt_s_ * body.velocity_W, spin = Vec3::Constant(dt_s_ * spin_m_s);
    box.min -= shift.cwiseMax(0) + spin;
    box.max -= shift.cwiseMin(0) - spin;
  }
}

PlacedObstacle ObstacleGrid::placed(std::uint32_t index) const {
  const ObstacleShape& shape = placed_.obstacles.shapes[index];
  const ObstacleBody& body = placed_.obstacles.bodies[shape.body];
  const Mat3& rotation = placed_.rotations_WB[shape.body];
  PlacedObstacle placed;
  placed.shape = index;
  placed.min = boxes_[index].min.cast<float>();
  placed.max = boxes_[index].max.cast<float>();
  Vec3 center_W = body.X_WB.position;
  Vec3 half = Vec3::Constant(shape.radius_m);
  if (shape.hull) {
    center_W += rotation * (shape.box_R.center() - body.com_R);
    half = 0.5 * shape.box_R.extent();
    placed.faces = shape.hull->faces;
  }
  placed.center_W = center_W.cast<float>();
  placed.half_m =
      (half.array() + kPositionError_m + kRelativePositionError * center_W.norm()).cast<float>();
  placed.rotation_BW = rotation.transpose().cast<float>();
  if (body.moves) {
    const VelocityField motion{body.X_WB.position, body.velocity_W, body.angular_velocity_W};
    placed.velocity_W = motion(center_W).cast<float>();
    placed.angular_velocity_W = body.angular_velocity_W.cast<float>();
  }
  return placed;
}

void ObstacleGrid::sort_into_cells() {
  mask_ = 255;
  while (mask_ < 4 * placed_.shapes.size()) mask_ = 2 * mask_ + 1;
  first_.assign(std::size_t{mask_} + 3, 0);
  levels_ = 0;
  const auto each_cell = [&](const PlacedObstacle& placed, const auto& visit) {
    const int level = level_of(placed.max - placed.min);
    levels_ |= 1u << level;
    for_cells(level, cell_of(placed.min.array() - kObstacleCellMargin_m),
              cell_of(placed.max.array() + kObstacleCellMargin_m),
              [&](std::uint32_t hash, const Eigen::Vector3i&) { visit(hash & mask_); });
  };
  // While entries are filled in, first_[b + 1] is the next free entry of bucket b.
  for (const PlacedObstacle& placed : placed_.shapes)
    each_cell(placed, [&](std::uint32_t b) { ++first_[b + 2]; });
  for (std::size_t b = 2; b < first_.size(); ++b) first_[b] += first_[b - 1];
  entries_.resize(first_.back());
  for (std::uint32_t s = 0; s < placed_.shapes.size(); ++s) {
    const Entry entry{four(placed_.shapes[s].min, std::bit_cast<float>(s)),
                      four(placed_.shapes[s].max)};
    each_cell(placed_.shapes[s], [&](std::uint32_t b) { entries_[first_[b + 1]++] = entry; });
  }
}

void ObstacleGrid::build(const Obstacles& obstacles, double dt_s, const Box& region, Which which) {
  placed_.obstacles = obstacles;
  dt_s_ = dt_s;
  placed_.shapes.clear();
  if (region.empty()) return;
  const auto moves = [](const ObstacleBody& body) { return body.moves; };
  if (which == Which::kMoving && std::ranges::none_of(obstacles.bodies, moves)) return;
  placed_.rotations_WB.resize(obstacles.bodies.size());
  for_chunks(obstacles.bodies.size(), kObstaclesPerChunk,
             [&](std::size_t begin, std::size_t end, std::size_t) {
               for (std::size_t b = begin; b < end; ++b) {
                 placed_.rotations_WB[b] = obstacles.bodies[b].X_WB.rotation.toRotationMatrix();
               }
             });
  boxes_.resize(obstacles.shapes.size());
  for_chunks(
      boxes_.size(), kObstaclesPerChunk,
      [&](std::size_t begin, std::size_t end, std::size_t) { compute_boxes(begin, end, which); });
  reached_.clear();
  for (std::uint32_t s = 0; s < boxes_.size(); ++s) {
    if (boxes_[s].overlaps(region)) reached_.push_back(s);
  }
  if (reached_.empty()) return;
  placed_.shapes.resize(reached_.size());
  for_chunks(reached_.size(), kObstaclesPerChunk,
             [&](std::size_t begin, std::size_t end, std::size_t) {
               for (std::size_t i = begin; i < end; ++i) placed_.shapes[i] = placed(reached_[i]);
             });
  sort_into_cells();
}

/// Returns true if the boxes overlap; branch-free, because the failing axis is unpredictable.
inline bool ObstacleGrid::overlaps_box(const Entry& entry, Four low, Four high) {
  const auto lanes = (entry.min <= high) & (low <= entry.max);
  const auto halves = std::bit_cast<std::array<std::uint64_t, 2>>(lanes);
  return (halves[0] & (halves[1] | 0xffffffff00000000)) == ~std::uint64_t{0};
}

/// Appends the shapes whose boxes overlap the box from `low` to `high`. A shape in several of the
/// visited cells is reported by the first of them only.
void ObstacleGrid::find(const Vec3f& low, const Vec3f& high,
                        std::vector<std::uint32_t>& shapes) const {
  if ((high - low).maxCoeff() > kMaxHashedQuery_m) {
    for (std::uint32_t s = 0; s < placed_.shapes.size(); ++s) {
      if (overlap(placed_.shapes[s].min, placed_.shapes[s].max, low, high)) shapes.push_back(s);
    }
    return;
  }
  const Four low_4 = four(low), high_4 = four(high);
  const Vec3f middle = 0.5f * (low + high);
  const Eigen::Vector3i first = cell_of((low.array() + kObstacleCellMargin_m).min(middle.array()));
  const Eigen::Vector3i last = cell_of((high.array() - kObstacleCellMargin_m).max(middle.array()));
  for (std::uint32_t left = levels_; left != 0; left &= left - 1) {
    const int level = std::countr_zero(left);
    for_cells(level, first, last, [&](std::uint32_t hash, const Eigen::Vector3i& cell) {
      const std::uint32_t bucket = hash & mask_;
      for (std::uint32_t e = first_[bucket]; e < first_[bucket + 1]; ++e) {
        const Entry& entry = entries_[e];
        if (!overlaps_box(entry, low_4, high_4)) continue;
        const Vec3f corner(entry.min[0], entry.min[1], entry.min[2]);
        const Eigen::Vector3i begin =
            cell_of(corner.array() - kObstacleCellMargin_m).cwiseMax(first);
        if (Eigen::Vector3i(begin.x() >> level, begin.y() >> level, begin.z() >> level) == cell) {
          shapes.push_back(entry.placed());
        }
      }
    });
  }
}

void ObstacleGrid::find(std::span<const SpherePath> paths, Near& near) const {
  if (placed_.shapes.empty()) return;
  Vec3f low = Vec3f::Constant(1e30f), high = -low;
  const auto low_of = [](const SpherePath& path) {
    return Vec3f((path.from.cwiseMin(path.to).array() - path.radius_m).cast<float>());
  };
  const auto high_of = [](const SpherePath& path) {
    return Vec3f((path.from.cwiseMax(path.to).array() + path.radius_m).cast<float>());
  };
  for (const SpherePath& path : paths) {
    low = low.cwiseMin(low_of(path));
    high = high.cwiseMax(high_of(path));
  }
  if ((low.array() >= near.low.array()).all() && (high.array() <= near.high.array()).all()) return;
  near = {std::move(near.shapes), low.array() - kObstacleQueryMargin_m,
          high.array() + kObstacleQueryMargin_m};
  near.shapes.clear();
  if ((high - low).maxCoeff() <= kMaxSharedQuery_m) {
    find(near.low, near.high, near.shapes);
    return;
  }
  near.high = near.low - Vec3f::Ones();  // empty: the result is valid for these paths alone
  for (const SpherePath& path : paths) {
    const double parts = std::ceil((path.to - path.from).cwiseAbs().maxCoeff() / kMaxPathPart_m);
    if (!(parts > 1 && parts <= kMaxPathParts)) {
      find(low_of(path), high_of(path), near.shapes);
      continue;
    }
    SpherePath part = path;
    for (double k = 1; k <= parts; ++k) {
      part.to = path.from + k / parts * (path.to - path.from);
      find(low_of(part), high_of(part), near.shapes);
      part.from = part.to;
    }
  }
  std::ranges::sort(near.shapes);
  near.shapes.erase(std::unique(near.shapes.begin(), near.shapes.end()), near.shapes.end());
}

}  // namespace sunder::solver
