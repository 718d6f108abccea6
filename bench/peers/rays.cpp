#include "bench/peers/rays.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "bench/heap.h"
#include "engine/base/check.h"
#include "engine/base/cpu_time.h"

namespace sunder::bench {
namespace {

/// Distances that differ by no more than these are counted as equal.
constexpr double kEqual_m[] = {1e-3, 0.02};
/// Number of times that all rays are cast; the fastest counts.
constexpr int kRounds = 5;

class OurRays final : public RayCaster {
 public:
  explicit OurRays(const World& world) : world_(world) {}
  std::optional<double> cast(const Ray& ray) const override {
    const std::optional<CastHit> hit = world_.cast(ray.from_W, ray.way_W, ray.way_W.norm());
    if (!hit) return std::nullopt;
    return hit->distance_m;
  }

 private:
  const World& world_;
};

RayScene ray_scene(const Scene& scene, const World& world, int rays) {
  RayScene made;
  const BodyArrays& bodies = world.bodies();
  for (std::size_t i = 0; i < scene.solids.size(); ++i) {
    const Pose X_WR = world.body(bodies.key[i]).motion.X_WR;
    made.hulls.push_back({scene.solids[i].compound.convexes[0]->polyhedron.vertices, X_WR});
  }
  Random random(2, 0);
  for (int i = 0; i < rays; ++i) {
    const auto [from_W, way_W] = ray_into(world, random);
    made.rays.push_back({from_W, 2 * way_W});
  }
  return made;
}

/// The distances of all rays, -1 where there is none, and the processor time of a ray.
struct Casts {
  std::vector<double> distances_m;
  double us = 1e300;
};

void cast_all(const RayCaster& caster, const RayScene& scene, Casts& casts) {
  casts.distances_m.clear();
  casts.distances_m.reserve(scene.rays.size());
  const double start_ms = cpu_ms();
  for (const Ray& ray : scene.rays) casts.distances_m.push_back(caster.cast(ray).value_or(-1));
  const double us = 1e3 * (cpu_ms() - start_ms) / static_cast<double>(scene.rays.size());
  casts.us = std::min(casts.us, us);
}

void write_scene(const RayScene& scene, const Casts& ours, const std::string& name) {
  std::FILE* file = std::fopen(name.c_str(), "w");
  if (!file) throw FileError(name + ": cannot be written");
  std::fprintf(file, "hulls %zu\n", scene.hulls.size());
  for (const RayScene::Hull& hull : scene.hulls) {
    const Vec3& p = hull.X_WB.position;
    const Quat& q = hull.X_WB.rotation;
    std::fprintf(file, "%zu %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", hull.vertices_B.size(),
                 p.x(), p.y(), p.z(), q.x(), q.y(), q.z(), q.w());
    for (const Vec3& v : hull.vertices_B)
      std::fprintf(file, "%.17g %.17g %.17g\n", v.x(), v.y(), v.z());
  }
  std::fprintf(file, "rays %zu\n", scene.rays.size());
  for (std::size_t i = 0; i < scene.rays.size(); ++i) {
    const auto& [from, way] = scene.rays[i];
    std::fprintf(file, "%.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", from.x(), from.y(), from.z(),
                 way.x(), way.y(), way.z(), ours.distances_m[i]);
  }
  if (std::fclose(file) != 0) throw FileError(name + ": cannot be written; is the disk full?");
}

void print(const char* engine, const Casts& casts, const Casts& ours) {
  std::size_t other[2] = {};
  for (std::size_t i = 0; i < casts.distances_m.size(); ++i) {
    const double difference_m = std::abs(casts.distances_m[i] - ours.distances_m[i]);
    for (int k = 0; k < 2; ++k) other[k] += difference_m > kEqual_m[k];
  }
  std::printf("| %s | %.2f | %.2f | %zu | %zu |\n", engine, casts.us, casts.us / ours.us, other[0],
              other[1]);
}

}  // namespace

void compare_rays(int hulls, int rays, const std::string& file) {
  const Scene heap = heap_scene(hulls);
  const World world = settled(heap);
  const RayScene scene = ray_scene(heap, world, rays);
  const OurRays our_rays(world);
  Casts ours;
#ifdef SUNDER_BULLET
  const std::unique_ptr<RayCaster> bullet_rays = make_bullet_rays(scene);
  Casts bullet;
#endif
  for (int round = 0; round < kRounds; ++round) {
    cast_all(our_rays, scene, ours);
#ifdef SUNDER_BULLET
    cast_all(*bullet_rays, scene, bullet);
#endif
  }
  const auto hits = std::ranges::count_if(ours.distances_m, [](double m) { return m >= 0; });
  std::printf(
      "%d rays, %td of which meet something, into %d hulls at rest, one thread; processor "
      "time of a ray, the least of %d rounds\n\n"
      "| engine | µs | ours = 1 | distances that differ by more than 1 mm | largest other "
      "difference mm |\n|---|---|---|---|---|\n",
      rays, hits, hulls, kRounds);
  print("Sunder", ours, ours);
#ifdef SUNDER_BULLET
  print("Bullet", bullet, ours);
#else
  std::printf("| Bullet | skipped: not found | | | |\n");
#endif
  if (!file.empty()) write_scene(scene, ours, file);
}

}  // namespace sunder::bench
