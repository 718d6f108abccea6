// Interface to the ray casts of an engine, so that all engines cast the same rays.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "engine/base/types.h"

namespace sunder::bench {

/// A ray from `from_W` over `way_W`.
struct Ray {
  Vec3 from_W, way_W;
};

/// Hulls at rest on the ground plane y = 0, and rays to cast.
struct RayScene {
  struct Hull {
    std::vector<Vec3> vertices_B;
    Pose X_WB;
  };
  std::vector<Hull> hulls;
  std::vector<Ray> rays;
};

class RayCaster {
 public:
  virtual ~RayCaster() = default;
  /// Returns the distance of the first point of a hull or the ground that a ray meets.
  virtual std::optional<double> cast(const Ray& ray) const = 0;
};

/// Makes a Bullet world of the scene. It is undefined if CMake did not find Bullet.
std::unique_ptr<RayCaster> make_bullet_rays(const RayScene& scene);

/// Times the casts of `rays` rays into `hulls` hulls at rest by Sunder and Bullet, and prints a
/// table with the largest differences of distances. Writes hulls, rays and distances as text to
/// `file` for other engines, unless it is empty.
void compare_rays(int hulls, int rays, const std::string& file);

}  // namespace sunder::bench
