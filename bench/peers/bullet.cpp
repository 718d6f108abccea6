// Adapter to Bullet with its default settings, except for the collision margin: the default of 4 cm
// would make pieces of 10 cm nearly twice as large. The margin is 1 mm, and hulls shrink by 1 mm,
// so that contact surfaces are those of our hulls.
#include <btBulletDynamicsCommon.h>

#include <algorithm>
#include <cmath>

#include "bench/peers/peer.h"

namespace sunder::bench {
namespace {

constexpr btScalar kMargin = 0.001f;  // m

btVector3 to_bullet(const Vec3& v) {
  return {static_cast<btScalar>(v.x()), static_cast<btScalar>(v.y()), static_cast<btScalar>(v.z())};
}

Vec3 from_bullet(const btVector3& v) { return Vec3f(v.x(), v.y(), v.z()).cast<double>(); }

/// Returns the factor that scales a hull about its centre of mass so that its nearest face moves
/// inwards by the margin; at least 0.5.
double shrink_factor(const ShapeDesc& shape, const Vec3& com_R) {
  double inner_m = 1e30;
  for (const ConvexPolyhedron::Face& face : shape.hull->faces) {
    inner_m = std::min(inner_m, -face.plane.distance(com_R));
  }
  return std::max(0.5, 1 - static_cast<double>(kMargin) / inner_m);
}

class Bullet final : public Peer {
 public:
  Bullet(std::span<const BodyDesc> bodies, const Effort& effort) {
    world_.setGravity({0, -9.81f, 0});
    world_.getSolverInfo().m_numIterations = effort.passes;
    for (const BodyDesc& desc : bodies) add(desc);
  }
  ~Bullet() override {
    for (const auto& body : bodies_) world_.removeRigidBody(body.get());
  }
  void step(double dt_s) override { world_.stepSimulation(static_cast<btScalar>(dt_s), 0); }
  BodyState state(std::size_t i) const override {
    const btTransform& at = bodies_[i]->getWorldTransform();
    const btQuaternion q = at.getRotation();
    BodyState state;
    state.X_WB.position = from_bullet(at.getOrigin());
    state.X_WB.rotation = Quatf(q.w(), q.x(), q.y(), q.z()).cast<double>().normalized();
    state.velocity_W = from_bullet(bodies_[i]->getLinearVelocity());
    state.angular_velocity_W = from_bullet(bodies_[i]->getAngularVelocity());
    return state;
  }

 private:
  void add(const BodyDesc& desc) {
    const ShapeDesc& shape = desc.shapes[0];
    btScalar mass = 0;
    btVector3 inertia(0, 0, 0);
    if (shape.kind == ShapeDesc::Kind::kHalfSpace) {
      const Vec3 point = desc.X_WB * (shape.center_R - desc.com_R);
      shapes_.push_back(std::make_unique<btStaticPlaneShape>(
          to_bullet(shape.normal_R), static_cast<btScalar>(shape.normal_R.dot(point))));
    } else {
      auto hull = std::make_unique<btConvexHullShape>();
      const double scale = shrink_factor(shape, desc.com_R);
      for (const Vec3& vertex : shape.hull->vertices) {
        hull->addPoint(to_bullet(scale * (vertex - desc.com_R)), false);
      }
      hull->recalcLocalAabb();
      hull->setMargin(kMargin);
      mass = static_cast<btScalar>(desc.mass_kg);
      hull->calculateLocalInertia(mass, inertia);
      shapes_.push_back(std::move(hull));
    }
    btRigidBody::btRigidBodyConstructionInfo info(mass, nullptr, shapes_.back().get(), inertia);
    if (mass > 0) info.m_startWorldTransform.setOrigin(to_bullet(desc.X_WB.position));
    info.m_friction = static_cast<btScalar>(std::sqrt(shape.friction));  // Bullet multiplies them
    bodies_.push_back(std::make_unique<btRigidBody>(info));
    bodies_.back()->setActivationState(DISABLE_DEACTIVATION);
    world_.addRigidBody(bodies_.back().get());
  }

  btDefaultCollisionConfiguration configuration_;
  btCollisionDispatcher dispatcher_{&configuration_};
  btDbvtBroadphase broad_phase_;
  btSequentialImpulseConstraintSolver solver_;
  btDiscreteDynamicsWorld world_{&dispatcher_, &broad_phase_, &solver_, &configuration_};
  std::vector<std::unique_ptr<btCollisionShape>> shapes_;
  std::vector<std::unique_ptr<btRigidBody>> bodies_;
};

}  // namespace

std::unique_ptr<Peer> make_bullet(std::span<const BodyDesc> bodies, const Effort& effort) {
  return std::make_unique<Bullet>(bodies, effort);
}

}  // namespace sunder::bench
