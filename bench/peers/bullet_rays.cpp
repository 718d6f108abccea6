// Ray casts of Bullet. Hulls have no collision margin, so that their surfaces are those of ours.
// The default cast is used, which may end 1 cm before a surface (the root of its tolerance, 0.0001
// m²); the other one, by GJK, was slower and differed more.
#include <btBulletCollisionCommon.h>

#include "bench/peers/rays.h"

namespace sunder::bench {
namespace {

btVector3 vector_of(const Vec3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

class BulletRays final : public RayCaster {
 public:
  explicit BulletRays(const RayScene& scene) {
    for (const RayScene::Hull& hull : scene.hulls) {
      auto shape = std::make_unique<btConvexHullShape>();
      for (const Vec3& vertex : hull.vertices_B) shape->addPoint(vector_of(vertex), false);
      shape->setMargin(0);
      shape->recalcLocalAabb();
      const Eigen::Quaternion<btScalar> q = hull.X_WB.rotation.cast<btScalar>();
      add(std::move(shape),
          btTransform(btQuaternion(q.x(), q.y(), q.z(), q.w()), vector_of(hull.X_WB.position)));
    }
    add(std::make_unique<btStaticPlaneShape>(btVector3(0, 1, 0), btScalar(0)),
        btTransform::getIdentity());
    // The broad phase moves objects at rest to a tree of their own within a few steps.
    for (int step = 0; step < 10; ++step) world_.performDiscreteCollisionDetection();
  }
  ~BulletRays() override {
    for (const auto& object : objects_) world_.removeCollisionObject(object.get());
  }
  std::optional<double> cast(const Ray& ray) const override {
    const btVector3 from = vector_of(ray.from_W), to = vector_of(ray.from_W + ray.way_W);
    btCollisionWorld::ClosestRayResultCallback found(from, to);
    world_.rayTest(from, to, found);
    if (!found.hasHit()) return std::nullopt;
    return static_cast<double>(found.m_closestHitFraction) * ray.way_W.norm();
  }

 private:
  void add(std::unique_ptr<btCollisionShape> shape, const btTransform& at) {
    shapes_.push_back(std::move(shape));
    objects_.push_back(std::make_unique<btCollisionObject>());
    objects_.back()->setCollisionShape(shapes_.back().get());
    objects_.back()->setWorldTransform(at);
    world_.addCollisionObject(objects_.back().get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btCollisionWorld world_{&dispatcher_, &broad_phase_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btCollisionObject>> objects_;
};

}  // namespace

std::unique_ptr<RayCaster> make_bullet_rays(const RayScene& scene) {
  return std::make_unique<BulletRays>(scene);
}

}  // namespace sunder::bench
