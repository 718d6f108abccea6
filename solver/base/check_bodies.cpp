#include "solver/base/check_bodies.h"

#include <algorithm>
#include <string>

#include "engine/base/check.h"

namespace sunder::solver {
namespace {

constexpr double kMaxQuantity = 1e15;  // m, kg or m/s; the square still fits into a float

struct Subject {
  std::string name;
  void require(bool sound, const char* what) const {
    if (!sound) throw InputError(name + " " + what);
  }
};

bool finite(const Vec3& v) { return v.cwiseAbs().maxCoeff() < kMaxQuantity && v.allFinite(); }

void check_shape(const ShapeDesc& shape, const Subject& subject) {
  const auto coefficient = [](double x) { return x >= 0 && x < kMaxQuantity; };
  subject.require(coefficient(shape.friction), "has a friction that is negative or not finite");
  subject.require(coefficient(shape.restitution), "has a restitution that is no number from 0 on");
  subject.require(finite(shape.center_R), "has a centre that is not finite");
  switch (shape.kind) {
    case ShapeDesc::Kind::kSphere:
      subject.require(shape.radius_m > 0 && shape.radius_m < kMaxQuantity,
                      "is a sphere whose radius is not positive");
      break;
    case ShapeDesc::Kind::kHalfSpace:
      subject.require(finite(shape.normal_R) && shape.normal_R.norm() > 0,
                      "is a half-space without a direction");
      break;
    case ShapeDesc::Kind::kHull:
      subject.require(shape.hull != nullptr && shape.hull->vertices.size() >= 4 &&
                          shape.hull->faces.size() >= 4,
                      "is a hull without volume");
      subject.require(std::all_of(shape.hull->vertices.begin(), shape.hull->vertices.end(), finite),
                      "is a hull with a corner that is not finite");
      subject.require((bounds(*shape.hull).extent().array() > 0).all(), "is a hull without size");
      subject.require(!shape.bends || shape.hull->faces.size() == 5,
                      "is a facet, but no prism on a triangle");
      break;
  }
}

void check_body(const BodyDesc& body) {
  const Subject subject{"body " + std::to_string(body.tag)};
  subject.require(finite(body.X_WB.position) && finite(body.com_R), "is at a place not finite");
  const Eigen::Vector4d rotation = body.X_WB.rotation.coeffs();
  subject.require(rotation.allFinite() && rotation.norm() > 0, "has a rotation that is none");
  if (!body.is_static) {
    subject.require(finite(body.velocity_W) && finite(body.angular_velocity_W),
                    "has a velocity that is not finite");
    subject.require(body.mass_kg > 0 && body.mass_kg < kMaxQuantity,
                    "has a mass that is not positive; make it static if it is not to move");
    subject.require(body.inertia_B.allFinite() && body.inertia_B.trace() > 0,
                    "has an inertia that is not positive");
  }
  check_shapes(body.shapes, body.tag);
}

}  // namespace

void check_bodies(std::span<const BodyDesc> bodies) {
  for (const BodyDesc& body : bodies) check_body(body);
}

void check_shapes(std::span<const ShapeDesc> shapes, std::uint32_t body_tag) {
  for (const ShapeDesc& shape : shapes) {
    check_shape(shape,
                {"shape " + std::to_string(shape.tag) + " of body " + std::to_string(body_tag)});
  }
}

}  // namespace sunder::solver
