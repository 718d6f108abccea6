// Read first: Cover::Cover().
#include "engine/world/act/cover.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "engine/base/parallel.h"
#include "engine/model/work_log.h"
#include "engine/world/act/charge.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

constexpr double kDepthTolerance = 1 + 1e-3;  // on the distance of an end
constexpr double kOutside = 1e-9;             // of a distance: more than rounding
constexpr int kRowsPerChunk = 4;

/// Point of the cube: a face, and coordinates there from -1 to 1.
struct CubePoint {
  int face = 0;
  double u = 0, v = 0;
};

Vec3 in_face(const Vec3& direction, int face) {
  const int axis = face / 2;
  const double ahead = face % 2 == 0 ? direction[axis] : -direction[axis];
  return {direction[(axis + 1) % 3], direction[(axis + 2) % 3], ahead};
}

CubePoint on_cube(const Vec3& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  const int face = 2 * axis + (direction[axis] < 0 ? 1 : 0);
  const Vec3 local = in_face(direction, face);
  return {face, local.x() / local.z(), local.y() / local.z()};
}

int cell_at(double u) {
  return std::clamp(static_cast<int>(std::floor(0.5 * (u + 1) * kCoverCellsPerEdge)), 0,
                    kCoverCellsPerEdge - 1);
}

/// Returns the index of a cell of a face.
std::size_t index_of(int face, int row, int column) {
  return static_cast<std::size_t>((face * kCoverCellsPerEdge + row) * kCoverCellsPerEdge + column);
}

constexpr std::size_t kCells = std::size_t{6} * kCoverCellsPerEdge * kCoverCellsPerEdge;

/// Returns the directions of the centres of all cells.
std::vector<Vec3> find_directions() {
  const auto place = [](int i) { return 2 * (i + 0.5) / kCoverCellsPerEdge - 1; };
  std::vector<Vec3> all(kCells);
  for (int face = 0; face < 6; ++face) {
    const int axis = face / 2;
    for (int row = 0; row < kCoverCellsPerEdge; ++row) {
      for (int column = 0; column < kCoverCellsPerEdge; ++column) {
        Vec3 direction;
        direction[axis] = face % 2 == 0 ? 1 : -1;
        direction[(axis + 1) % 3] = place(column);
        direction[(axis + 2) % 3] = place(row);
        all[index_of(face, row, column)] = direction.normalized();
      }
    }
  }
  return all;
}

/// Corners of a box, seen from the centre.
using Corners = std::array<Vec3, 8>;

/// Returns true if no ray through a face of the cube meets a box, as all corners are outside of one
/// side of the pyramid of such rays.
bool misses(const Corners& corners, int face) {
  for (const Eigen::Index axis : {0, 1})
    for (const double side : {-1.0, 1.0})
      if (std::ranges::all_of(corners, [&](const Vec3& corner) {
            const Vec3 local = in_face(corner, face);
            return side * local[axis] > local.z() + kOutside * local.norm();
          }))
        return true;
  return false;
}

/// Returns the distance at which a ray leaves a convex; 0 if the ray misses it, or starts inside.
double end_of(const ConvexPolyhedron& convex, const Vec3& origin_R, const Vec3& direction_R) {
  double begin = 0, end = 1e300;
  for (const ConvexPolyhedron::Face& face : convex.faces) {
    const double distance = face.plane.distance(origin_R);
    const double closing = face.plane.normal.dot(direction_R);
    if (distance > 0) {
      if (closing >= 0) return 0;
      begin = std::max(begin, -distance / closing);
    } else if (closing > 0) {
      end = std::min(end, -distance / closing);
    }
    if (begin >= end) return 0;
  }
  return begin > 0 ? end : 0;
}

}  // namespace

/// Returns the cells of a face that a box may cover; all if the box is beside the centre.
Cover::CellRange Cover::range_of(const std::array<Vec3, 8>& corners, int face) {
  if (misses(corners, face)) return {};
  CellRange range{{kCoverCellsPerEdge, kCoverCellsPerEdge}, {-1, -1}};
  bool ahead = false, behind = false;
  for (const Vec3& corner : corners) {
    const Vec3 local = in_face(corner, face);
    if (local.z() <= 1e-3 * local.norm()) {
      behind = true;
      continue;
    }
    ahead = true;
    for (std::size_t i = 0; i < 2; ++i) {
      const int cell = cell_at(local[static_cast<Eigen::Index>(i)] / local.z());
      range.first[i] = std::min(range.first[i], cell);
      range.last[i] = std::max(range.last[i], cell);
    }
  }
  if (ahead && behind) return {{0, 0}, {kCoverCellsPerEdge - 1, kCoverCellsPerEdge - 1}};
  return range;
}

/// Returns the convexes that may give cover, in order.
std::vector<Cover::Cast> Cover::in_reach(const WorldState& world, const Blast& blast) {
  constexpr std::size_t kActors = 64;
  const BodyStates states = world.physics->states();
  const double most_m = reach_m(blast);
  return collect_chunks<Cast>(
      world.actors.size(), kActors,
      [&](std::size_t begin, std::size_t end, std::vector<Cast>& found) {
        for (std::size_t i = begin; i < end; ++i) {
          const Actor& actor = world.actors[i];
          const Pose X_WR = rest_pose(actor, states[actor.body].X_WB);
          const Pose X_RW = X_WR.inverse();
          const Vec3 center_R = X_RW * blast.center_W;
          actor.structure.for_each([&](ConvexSlot slot, const Convex& convex) {
            const Vec3 nearest_R = center_R.cwiseMax(convex.box.min).cwiseMin(convex.box.max);
            const double near_m = (nearest_R - center_R).norm();
            if (!(near_m < most_m)) return;
            std::array<Vec3, 8> corners;
            for (std::size_t k = 0; k < corners.size(); ++k) {
              const Vec3 corner_R(k & 1 ? convex.box.max.x() : convex.box.min.x(),
                                  k & 2 ? convex.box.max.y() : convex.box.min.y(),
                                  k & 4 ? convex.box.max.z() : convex.box.min.z());
              corners[k] = X_WR * corner_R - blast.center_W;
            }
            Cast cast{&convex, actor.key, slot, X_RW.rotation, center_R, near_m, {}};
            for (std::size_t face = 0; face < 6; ++face)
              cast.ranges[face] = range_of(corners, static_cast<int>(face));
            found.push_back(cast);
          });
        }
      });
}

/// Rows are drawn in parallel, each by one thread. Near convexes come first, as those behind them
/// then cost little; where several end at one distance, the first of the world is kept.
Cover::Cover(WorldState& world, const Blast& blast) : center_W_(blast.center_W) {
  if (!blast.cover) return;
  WorkSpan span(world.log.work_counts, Stage::kAct, "rays for cover");
  cells_.resize(kCells);
  std::vector<Cast> casts = in_reach(world, blast);
  for (std::uint32_t i = 0; i < casts.size(); ++i) casts[i].place = i;
  std::ranges::stable_sort(casts, {}, &Cast::near_m);
  constexpr int kChunks = kCoverCellsPerEdge / kRowsPerChunk;
  static_assert(kChunks * kRowsPerChunk == kCoverCellsPerEdge);
  std::array<std::uint64_t, std::size_t{6} * kChunks> rays{};
  for_chunks(rays.size(), 1, [&](std::size_t chunk, std::size_t, std::size_t) {
    const int face = static_cast<int>(chunk) / kChunks;
    const int row = static_cast<int>(chunk) % kChunks * kRowsPerChunk;
    for (const Cast& cast : casts) rays[chunk] += draw(cast, face, row, row + kRowsPerChunk - 1);
  });
  for (const std::uint64_t number : rays) span.count(number);
}

/// Draws a convex into rows of a face; returns the number of rays that this took.
std::uint64_t Cover::draw(const Cast& cast, int face, int first_row, int last_row) {
  const CellRange& range = cast.ranges[static_cast<std::size_t>(face)];
  const double least_m = (1 - kOutside) * cast.near_m;
  static const std::vector<Vec3> directions = find_directions();
  std::uint64_t rays = 0;
  for (int row = std::max(first_row, range.first[1]); row <= std::min(last_row, range.last[1]);
       ++row) {
    for (int column = range.first[0]; column <= range.last[0]; ++column) {
      const std::size_t index = index_of(face, row, column);
      Cell& cell = cells_[index];
      if (least_m > cell.end_m) continue;
      ++rays;
      const Vec3 direction_R = cast.rotation_RW * directions[index];
      const double end_m = end_of(cast.convex->polyhedron, cast.center_R, direction_R);
      if (end_m > 0 && std::pair(end_m, cast.place) < std::pair(cell.end_m, cell.place))
        cell = {end_m, cast.place, cast.actor_key, cast.slot};
    }
  }
  return rays;
}

bool Cover::covers(const Vec3& point_W, std::uint32_t actor_key, ConvexSlot slot) const {
  const Vec3 away = point_W - center_W_;
  if (cells_.empty() || away.isZero()) return false;
  const CubePoint place = on_cube(away);
  const int row = cell_at(place.v), column = cell_at(place.u);
  const Cell& cell = cells_[index_of(place.face, row, column)];
  if (cell.actor_key == actor_key && cell.slot == slot) return false;
  return away.norm() > kDepthTolerance * cell.end_m;
}

}  // namespace sunder
