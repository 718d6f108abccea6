// Faces laid flat, and which of those in one plane touch. Internal to fracture/adjacency.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "fracture/adjacency/adjacency.h"
#include "fracture/adjacency/polygon.h"

namespace sunder::fracture {

/// Faces overlap from here on: of the squared size of the smaller convex.
inline constexpr double kLeastOverlap = 1e-10;

/// A face without the coordinate in which its normal is longest.
struct FlatFace {
  PlaneId id;
  const Vec2* points = nullptr;  ///< Its polygon, once its bin is complete.
  double scale = 1;              ///< Its area is this times that of the polygon.
  double size = 0;               ///< Of its convex.
  std::uint32_t convex = 0, face = 0;
  std::uint32_t first_point = 0, point_count = 0;  ///< In its bin.
  std::uint32_t cap = FaceEntry::kNoCap;
  std::uint8_t dropped = 0;  ///< That coordinate.
  bool known = false;

  std::span<const Vec2> polygon() const { return {points, point_count}; }
};

/// The longest side of its box.
inline double size_of(const Convex& convex) { return convex.box.extent().maxCoeff(); }

/// Appends the polygon of a face, or of the cap in it, without coordinate `dropped`,
/// counter-clockwise from either side.
void lay_flat(const Convex& convex, std::size_t face, std::uint32_t cap, int dropped,
              std::vector<Vec2>& points);

/// Adds the contacts within the planes of `faces`, whose polygons are those of `convexes`.
void sweep_planes(std::span<const ConvexPtr> convexes, std::vector<FlatFace>& faces,
                  std::vector<Bond>& bonds);

}  // namespace sunder::fracture
