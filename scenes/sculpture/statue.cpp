// The statue as a signed distance field. Read first: figure(), the union of all shapes.
#include "scenes/sculpture/statue.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>

#include "engine/base/trigonometry.h"
#include "scenes/sculpture/implicit_surface.h"

namespace sunder::scenes {
namespace {

/// Area in m² of the sides of a fine grid's cells that separate inside from outside.
constexpr double kSideArea_m2 = 6.015;

/// Returns the smooth union of two shapes, with a fillet of about the given radius.
double join(double a, double b, double radius_m) {
  const double near = std::max(radius_m - std::abs(a - b), 0.0) / radius_m;
  return std::min(a, b) - near * near * radius_m / 4;
}

/// Returns the smooth difference of two shapes, with a fillet of about the given radius.
double carve(double a, double b, double radius_m) { return -join(-a, b, radius_m); }

/// Returns 0 up to `from`, 1 from `to` on, and a smooth step between.
double smooth_step(double from, double to, double x) {
  const double t = std::clamp((x - from) / (to - from), 0.0, 1.0);
  return t * t * (3 - 2 * t);
}

double ellipsoid(const Vec3& p, const Vec3& middle, const Vec3& radii_m) {
  const Vec3 unit = (p - middle).cwiseQuotient(radii_m);
  const double k = unit.norm(), slope = unit.cwiseQuotient(radii_m).norm();
  return slope > 0 ? k * (k - 1) / slope : -radii_m.minCoeff();
}

/// Returns the distance to a capsule from a to b whose radius varies linearly.
double limb(const Vec3& p, const Vec3& a, const Vec3& b, double radius_a_m, double radius_b_m) {
  const Vec3 along = b - a;
  const double t = std::clamp((p - a).dot(along) / along.squaredNorm(), 0.0, 1.0);
  return (p - a - t * along).norm() - (radius_a_m + t * (radius_b_m - radius_a_m));
}

double rounded_box(const Vec3& p, const Vec3& middle, const Vec3& half_m, double radius_m) {
  const Vec3 out = (p - middle).cwiseAbs() - half_m + Vec3::Constant(radius_m);
  return out.cwiseMax(0).norm() + std::min(out.maxCoeff(), 0.0) - radius_m;
}

/// Returns the distance to the robe from the ground to the waist: an oval that narrows upward, with
/// folds whose depth decreases upward.
double robe(const Vec3& p) {
  const double y = std::clamp(p.y(), 0.1, 1.4);
  const double hips = smooth_step(0.75, 1.0, y) * (1 - smooth_step(1.05, 1.3, y));
  const double radius =
      0.3 - 0.11 * smooth_step(0.1, 0.7, y) - 0.035 * smooth_step(0.9, 1.3, y) + 0.03 * hips;
  const double angle = arc_tangent(p.z(), p.x());
  const double depth = 0.028 * (1 - smooth_step(0.3, 1.15, y));
  // Folds are inclined and irregular.
  const double lean = 1.3 * sin_cos(2 * angle + 2 * y).sin + 1.2 * y;
  const double folds = sin_cos(15 * angle + lean).sin + 0.5 * sin_cos(7 * angle - 2 * lean).cos;
  const double knee = 0.035 * smooth_step(0.35, 0.6, y) * (1 - smooth_step(0.6, 0.95, y)) *
                      smooth_step(0.4, 1, sin_cos(angle - 1.1).cos);
  const double across = Vec2(p.x(), 1.18 * p.z()).norm() - radius - depth * folds - knee;
  const double over = std::max(p.y() - 1.35, 0.1 - p.y());
  return 0.75 * (std::max(over, across) + Vec2(std::max(over, 0.0), std::max(across, 0.0)).norm() -
                 std::max({over, across, 0.0}));
}

/// Returns the distance to cloth that hangs from the left forearm, in upright folds.
double hanging_cloth(const Vec3& p) {
  constexpr double kFoot[] = {0.62, 0.5, 0.55, 0.46, 0.53, 0.6};  // m, height of each fold's end
  double d = 1;
  for (std::size_t i = 0; i < std::size(kFoot); ++i) {
    const double z = -0.015 + 0.042 * static_cast<double>(i), aside = i % 2 == 0 ? 0.012 : -0.012;
    const Vec3 top(0.295, 1.2, z), foot(0.3 + aside, kFoot[i], 1.15 * z);
    d = join(d, limb(p, top, foot, 0.026, 0.034), 0.008);
  }
  return d;
}

/// Returns the distance to the upper body: curved folds at the chest, upright ones below, a belt.
double torso(const Vec3& p) {
  double d = ellipsoid(p, Vec3(0, 1.3, 0), Vec3(0.155, 0.24, 0.12));
  d = join(d, ellipsoid(p, Vec3(0, 1.47, -0.005), Vec3(0.18, 0.15, 0.125)), 0.08);
  d = join(d, limb(p, Vec3(-0.17, 1.58, 0), Vec3(0.17, 1.575, 0), 0.072, 0.072), 0.08);
  for (const double side : {-1.0, 1.0})
    d = join(d, ellipsoid(p, Vec3(0.075 * side, 1.455, 0.085), Vec3(0.075, 0.08, 0.065)), 0.05);
  const double chest = smooth_step(1.36, 1.42, p.y()) * (1 - smooth_step(1.56, 1.63, p.y())) *
                       (1 - smooth_step(0.08, 0.15, std::abs(p.x())));
  const double waist = smooth_step(1.1, 1.2, p.y()) * (1 - smooth_step(1.34, 1.42, p.y()));
  d -= 0.005 * chest * sin_cos(110 * (p.y() - 3.5 * p.x() * p.x())).sin +
       0.006 * waist * sin_cos(75 * p.x() + 6 * p.y()).sin;
  const double round = Vec2(p.x(), 1.2 * p.z()).norm() - 0.16;
  return join(d, Vec2(round, 0.7 * (p.y() - 1.17)).norm() - 0.017, 0.006);
}

double arms(const Vec3& p) {
  const Vec3 shoulder(-0.215, 1.575, 0), elbow(-0.43, 1.66, 0.08), hand(-0.4, 1.96, 0.16);
  double right = limb(p, shoulder, elbow, 0.068, 0.05);
  right = join(right, limb(p, elbow, hand, 0.05, 0.034), 0.02);
  right = join(right, ellipsoid(p, hand, Vec3(0.042, 0.052, 0.045)), 0.03);
  const Vec3 left_elbow(0.3, 1.27, -0.02), left_hand(0.27, 1.2, 0.26);
  double left = limb(p, Vec3(0.215, 1.575, 0), left_elbow, 0.068, 0.052);
  left = join(left, limb(p, left_elbow, left_hand, 0.052, 0.034), 0.02);
  left = join(left, ellipsoid(p, left_hand, Vec3(0.045, 0.04, 0.055)), 0.03);
  return std::min(right, left);
}

/// Returns the distance to the torch: a shaft through the right hand, a bowl and a flame.
double torch(const Vec3& p) {
  double d = limb(p, Vec3(-0.4, 1.85, 0.165), Vec3(-0.4, 2.1, 0.16), 0.016, 0.026);
  d = join(d, ellipsoid(p, Vec3(-0.4, 2.12, 0.16), Vec3(0.07, 0.03, 0.07)), 0.02);
  const double y = p.y() - 2.13, swirl = 0.018 * sin_cos(22 * y).sin;
  const Vec3 q = p - Vec3(swirl, 0, 0.018 * sin_cos(22 * y).cos - 0.018);
  return join(d, limb(q, Vec3(-0.4, 2.14, 0.16), Vec3(-0.4, 2.26, 0.16), 0.048, 0.012), 0.02);
}

double face(const Vec3& p, double head) {
  const Vec3 q(std::abs(p.x()), p.y(), p.z());
  double d = join(head, limb(p, Vec3(0, 1.885, 0.107), Vec3(0, 1.838, 0.128), 0.009, 0.014), 0.015);
  d = carve(d, ellipsoid(q, Vec3(0.036, 1.882, 0.118), Vec3(0.021, 0.014, 0.02)), 0.015);
  d = join(d, ellipsoid(q, Vec3(0.035, 1.88, 0.09), Vec3(0.016, 0.012, 0.016)), 0.004);
  d = join(d, limb(q, Vec3(0.012, 1.903, 0.108), Vec3(0.055, 1.9, 0.09), 0.007, 0.006), 0.012);
  d = join(d, ellipsoid(p, Vec3(0, 1.806, 0.104), Vec3(0.026, 0.008, 0.014)), 0.008);
  d = join(d, ellipsoid(p, Vec3(0, 1.79, 0.102), Vec3(0.021, 0.008, 0.014)), 0.006);
  return join(d, ellipsoid(p, Vec3(0, 1.76, 0.082), Vec3(0.024, 0.02, 0.024)), 0.03);
}

double head(const Vec3& p) {
  double d = ellipsoid(p, Vec3(0, 1.88, 0.01), Vec3(0.088, 0.115, 0.108));
  d = join(d, ellipsoid(p, Vec3(0, 1.815, 0.035), Vec3(0.068, 0.082, 0.075)), 0.05);
  d = face(p, d);
  d = join(d, limb(p, Vec3(0, 1.6, -0.01), Vec3(0, 1.78, 0), 0.062, 0.055), 0.05);
  // Hair in waves, drawn back from the forehead to a knot.
  const double angle = arc_tangent(p.y() - 1.88, p.x());
  const double wave = 0.004 * sin_cos(16 * angle + 12 * p.z()).sin;
  double hair = ellipsoid(p, Vec3(0, 1.905, -0.012), Vec3(0.104, 0.117, 0.118));
  hair = carve(hair - wave, ellipsoid(p, Vec3(0, 1.835, 0.14), Vec3(0.085, 0.115, 0.09)), 0.02);
  d = std::min(d, 0.8 * hair);
  const Vec3 knot(0, 1.88, -0.14);
  const double curl = 0.006 * sin_cos(60 * (p.y() - 1.88) + 25 * p.x()).sin;
  return join(d, 0.8 * (ellipsoid(p, knot, Vec3(0.06, 0.055, 0.055)) - curl), 0.015);
}

/// Returns the distance to a shape that is within a ball. Far from the ball, returns the distance
/// to the ball instead, which is a lower bound and is cheaper to evaluate.
double within(const Vec3& p, const Vec3& middle, double radius_m, double (*shape)(const Vec3&)) {
  constexpr double kFilletReach_m = 0.1;  // more than the reach of all fillets
  const double outside_m = (p - middle).norm() - radius_m;
  return outside_m > kFilletReach_m ? outside_m : shape(p);
}

double figure(const Vec3& p) {
  double d = rounded_box(p, Vec3(0, 0.06, 0.02), Vec3(0.36, 0.06, 0.36), 0.02);
  d = join(d, within(p, Vec3(0, 0.7, 0), 0.78, robe), 0.03);
  for (const double side : {-1.0, 1.0})
    d = join(d, ellipsoid(p, Vec3(0.1 * side, 0.13, 0.26), Vec3(0.05, 0.045, 0.09)), 0.015);
  d = join(d, within(p, Vec3(0, 1.35, 0), 0.37, torso), 0.06);
  d = join(d, arms(p), 0.025);
  d = join(d, within(p, Vec3(0.3, 0.83, 0.1), 0.46, hanging_cloth), 0.02);
  d = join(d, within(p, Vec3(-0.4, 2.05, 0.16), 0.26, torch), 0.01);
  return join(d, within(p, Vec3(0, 1.83, -0.02), 0.28, head), 0.02);
}

}  // namespace

RawMesh make_statue(std::uint32_t triangles) {
  Box box;
  box.extend(Vec3(-0.55, 0, -0.4));
  box.extend(Vec3(0.45, 2.4, 0.45));
  // Each side makes two triangles, and has the area of a cell's side.
  return triangulate(figure, box, std::sqrt(2 * kSideArea_m2 / triangles));
}

}  // namespace sunder::scenes
