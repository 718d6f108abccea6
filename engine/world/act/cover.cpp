// Read first: Cover::add().
#include "engine/world/act/cover.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/world/act/charge.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

constexpr double kDepthTolerance = 1 + 1e-3;  // on the distance of an end

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

/// Returns the direction of the centre of a cell.
Vec3 direction_of(int face, int row, int column) {
  const auto place = [](int i) { return 2 * (i + 0.5) / kCoverCellsPerEdge - 1; };
  const int axis = face / 2;
  Vec3 direction;
  direction[axis] = face % 2 == 0 ? 1 : -1;
  direction[(axis + 1) % 3] = place(column);
  direction[(axis + 2) % 3] = place(row);
  return direction.normalized();
}

/// Cells of a face that a box, given by its corners seen from the centre, may cover; none if all
/// corners are behind the face.
struct CellRange {
  std::array<int, 2> first{kCoverCellsPerEdge, kCoverCellsPerEdge}, last{-1, -1};
};

CellRange range_of(const std::array<Vec3, 8>& corners, int face) {
  CellRange range;
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

/// Returns the distance at which a ray leaves a convex; 0 if the ray misses it, or starts inside.
double end_of(const ConvexPolyhedron& convex, const Vec3& origin_R, const Vec3& direction_R) {
  double begin = 0, end = 1e300;
  for (const ConvexPolyhedron::Face& face : convex.faces) {
    const double distance = face.plane.distance(origin_R);
    const double closing = face.plane.normal.dot(direction_R);
    if (closing < 0) begin = std::max(begin, -distance / closing);
    if (closing > 0) end = std::min(end, -distance / closing);
    if (closing == 0 && distance > 0) return 0;
  }
  return begin > 0 && begin < end ? end : 0;
}

}  // namespace

Cover::Cover(const WorldState& world, const Blast& blast) : center_W_(blast.center_W) {
  if (!blast.cover) return;
  cells_.resize(std::size_t{6} * kCoverCellsPerEdge * kCoverCellsPerEdge);
  const BodyStates states = world.physics->states();
  for (const Actor& actor : world.actors) {
    const Pose X_WR = rest_pose(actor, states[actor.body].X_WB);
    actor.structure.for_each([&](ConvexSlot slot, const Convex& convex) {
      const Vec3 center_R = X_WR.inverse() * center_W_;
      const Vec3 nearest_R = center_R.cwiseMax(convex.box.min).cwiseMin(convex.box.max);
      if ((nearest_R - center_R).norm() < reach_m(blast)) add(convex, X_WR, actor.key, slot);
    });
  }
}

void Cover::add(const Convex& convex, const Pose& X_WR, std::uint32_t actor_key, ConvexSlot slot) {
  const Pose X_RW = X_WR.inverse();
  const Vec3 origin_R = X_RW * center_W_;
  std::array<Vec3, 8> corners;  // of its box, from the centre
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const Vec3 corner_R(i & 1 ? convex.box.max.x() : convex.box.min.x(),
                        i & 2 ? convex.box.max.y() : convex.box.min.y(),
                        i & 4 ? convex.box.max.z() : convex.box.min.z());
    corners[i] = X_WR * corner_R - center_W_;
  }
  for (int face = 0; face < 6; ++face) {
    const CellRange range = range_of(corners, face);
    for (int row = range.first[1]; row <= range.last[1]; ++row) {
      for (int column = range.first[0]; column <= range.last[0]; ++column) {
        const Vec3 direction_R = X_RW.rotation * direction_of(face, row, column);
        const double end_m = end_of(convex.polyhedron, origin_R, direction_R);
        Cell& cell = cells_[static_cast<std::size_t>(
            (face * kCoverCellsPerEdge + row) * kCoverCellsPerEdge + column)];
        if (end_m > 0 && end_m < cell.end_m) cell = {end_m, actor_key, slot};
      }
    }
  }
}

bool Cover::covers(const Vec3& point_W, std::uint32_t actor_key, ConvexSlot slot) const {
  const Vec3 away = point_W - center_W_;
  if (cells_.empty() || away.isZero()) return false;
  const CubePoint place = on_cube(away);
  const int row = cell_at(place.v), column = cell_at(place.u);
  const Cell& cell = cells_[static_cast<std::size_t>(
      (place.face * kCoverCellsPerEdge + row) * kCoverCellsPerEdge + column)];
  if (cell.actor_key == actor_key && cell.slot == slot) return false;
  return away.norm() > kDepthTolerance * cell.end_m;
}

}  // namespace sunder
