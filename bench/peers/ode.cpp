// Adapter to ODE: quick step, at most eight contacts per pair, default ERP and CFM.
#include <ode/ode.h>

#include <cmath>

#include "bench/peers/peer.h"

namespace sunder::bench {
namespace {

constexpr int kMostContacts = 8;

/// Arrays that an ODE convex points to; they must live as long as the convex.
struct Convex {
  std::vector<dReal> planes, points;
  std::vector<unsigned> polygons;
};

class Ode final : public Peer {
 public:
  Ode(std::span<const BodyDesc> bodies, const Effort& effort) {
    dInitODE2(0);
    dAllocateODEDataForThread(dAllocateMaskAll);
    world_ = dWorldCreate();
    space_ = dHashSpaceCreate(nullptr);
    contacts_ = dJointGroupCreate(0);
    dWorldSetGravity(world_, 0, -9.81, 0);
    dWorldSetQuickStepNumIterations(world_, effort.passes);
    friction_ = bodies.back().shapes[0].friction;
    for (const BodyDesc& desc : bodies) add(desc);
  }
  ~Ode() override {
    dJointGroupDestroy(contacts_);
    dSpaceDestroy(space_);
    dWorldDestroy(world_);
    dCloseODE();
  }
  void step(double dt_s) override {
    dSpaceCollide(space_, this,
                  [](void* self, dGeomID a, dGeomID b) { static_cast<Ode*>(self)->touch(a, b); });
    dWorldQuickStep(world_, static_cast<dReal>(dt_s));
    dJointGroupEmpty(contacts_);
  }
  BodyState state(std::size_t i) const override {
    BodyState state;
    const dBodyID body = bodies_[i];
    if (!body) return state;
    const auto vec = [](const dReal* v) { return Vec3(double(v[0]), double(v[1]), double(v[2])); };
    const dReal* q = dBodyGetQuaternion(body);
    state.X_WB.position = vec(dBodyGetPosition(body));
    state.X_WB.rotation = Quat(double(q[0]), double(q[1]), double(q[2]), double(q[3]));
    state.velocity_W = vec(dBodyGetLinearVel(body));
    state.angular_velocity_W = vec(dBodyGetAngularVel(body));
    return state;
  }

 private:
  void touch(dGeomID a, dGeomID b) {
    dContact contacts[kMostContacts];
    const int count = dCollide(a, b, kMostContacts, &contacts[0].geom, sizeof(dContact));
    for (int i = 0; i < count; ++i) {
      contacts[i].surface.mode = dContactApprox1;
      contacts[i].surface.mu = static_cast<dReal>(friction_);
      dJointAttach(dJointCreateContact(world_, contacts_, &contacts[i]), dGeomGetBody(a),
                   dGeomGetBody(b));
    }
  }

  void add(const BodyDesc& desc) {
    const ShapeDesc& shape = desc.shapes[0];
    if (shape.kind == ShapeDesc::Kind::kHalfSpace) {
      const Vec3& n = shape.normal_R;
      const Vec3 point = desc.X_WB * (shape.center_R - desc.com_R);
      dCreatePlane(space_, n.x(), n.y(), n.z(), n.dot(point));
      bodies_.push_back(nullptr);
      return;
    }
    convexes_.push_back(std::make_unique<Convex>());
    Convex& convex = *convexes_.back();
    for (const Vec3& vertex : shape.hull->vertices) {
      for (int axis = 0; axis < 3; ++axis) convex.points.push_back((vertex - desc.com_R)[axis]);
    }
    for (std::size_t f = 0; f < shape.hull->faces.size(); ++f) {
      const Plane& plane = shape.hull->faces[f].plane;
      const auto corners = shape.hull->face_corners(f);
      for (int axis = 0; axis < 3; ++axis) convex.planes.push_back(plane.normal[axis]);
      convex.planes.push_back(plane.normal.dot(shape.hull->vertices[corners[0]] - desc.com_R));
      convex.polygons.push_back(static_cast<unsigned>(corners.size()));
      convex.polygons.insert(convex.polygons.end(), corners.begin(), corners.end());
    }
    const dGeomID geom =
        dCreateConvex(space_, convex.planes.data(), static_cast<unsigned>(shape.hull->faces.size()),
                      convex.points.data(), static_cast<unsigned>(shape.hull->vertices.size()),
                      convex.polygons.data());
    const dBodyID body = dBodyCreate(world_);
    dMass mass;
    const Mat3& I = desc.inertia_B;
    dMassSetParameters(&mass, desc.mass_kg, 0, 0, 0, I(0, 0), I(1, 1), I(2, 2), I(0, 1), I(0, 2),
                       I(1, 2));
    dBodySetMass(body, &mass);
    dGeomSetBody(geom, body);
    dBodySetPosition(body, desc.X_WB.position.x(), desc.X_WB.position.y(), desc.X_WB.position.z());
    dBodySetAutoDisableFlag(body, 0);
    bodies_.push_back(body);
  }

  dWorldID world_;
  dSpaceID space_;
  dJointGroupID contacts_;
  double friction_;
  std::vector<std::unique_ptr<Convex>> convexes_;
  std::vector<dBodyID> bodies_;
};

}  // namespace

std::unique_ptr<Peer> make_ode(std::span<const BodyDesc> bodies, const Effort& effort) {
  return std::make_unique<Ode>(bodies, effort);
}

}  // namespace sunder::bench
