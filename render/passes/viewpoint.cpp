#include "render/passes/viewpoint.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "engine/base/trigonometry.h"

namespace sunder::render {
namespace {

using Mat4 = Eigen::Matrix4d;

constexpr double kGroundPeriod_m = 64;  // period of the ground's texture

void store(float* out, const Vec3& v, double w) {
  for (int i = 0; i < 3; ++i) out[i] = static_cast<float>(v[i]);
  out[3] = static_cast<float>(w);
}

void store(float* out, const Mat4& m) {
  for (int i = 0; i < 16; ++i) out[i] = static_cast<float>(m(i % 4, i / 4));
}

/// Returns the axes of a view along `forward` as rows: right, up and forward.
Mat3 frame_along(const Vec3& forward) {
  const Vec3 ahead = forward.normalized();
  const Vec3 sky = std::abs(ahead.y()) < 0.999 ? Vec3::UnitY() : Vec3::UnitZ();
  const Vec3 right = ahead.cross(sky).normalized();
  Mat3 rows;
  rows << right.transpose(), right.cross(ahead).transpose(), ahead.transpose();
  return rows;
}

/// The visible part of space, and the shadows that reach it. Places are relative to the eye.
class ShadowReach {
 public:
  /// `camera`: rows right, up and forward; `wide`, `tall`: half of the image at distance 1;
  /// `to_light`: direction of the light; `ground`: height of the ground plane.
  ShadowReach(const Mat3& camera, double wide, double tall, const Vec3& to_light, double ground)
      : to_light_(to_light), ground_(ground) {
    const Vec3 right = camera.row(0), up = camera.row(1), forward = camera.row(2);
    sides_ = {(wide * forward - right).normalized(), (wide * forward + right).normalized(),
              (tall * forward - up).normalized(), (tall * forward + up).normalized()};
  }
  /// True unless the sphere and its shadow down to the ground are beyond one side of the image.
  bool is_seen(const Vec3& center, double radius) const {
    constexpr double kLowLight = 0.05;  // height of a light below which all shadows count
    if (to_light_.y() < kLowLight) return true;
    const double along = std::max(0.0, center.y() + radius - ground_) / to_light_.y();
    const Vec3 end = center - along * to_light_;
    return std::ranges::all_of(sides_, [&](const Vec3& inward) {
      return std::max(inward.dot(center), inward.dot(end)) > -radius;
    });
  }

 private:
  std::array<Vec3, 4> sides_;  ///< Inward normals of the sides of the view, through the eye.
  Vec3 to_light_;
  double ground_;
};

/// Returns a box, in the frame of the sun, around the casters within `reach` of the view's target
/// whose shadows are visible.
Box caster_box(std::span<const Caster> casters, const ShadowReach& shadows, const Mat3& sun,
               const Vec3& target, double reach) {
  Box box;
  for (const Caster& caster : casters) {
    const Vec3 center = caster.center.cast<double>();
    if ((center - target).norm() > reach) continue;
    if (!shadows.is_seen(center, double{caster.radius})) continue;
    const Vec3 radius = Vec3::Constant(static_cast<double>(caster.radius));
    const Vec3 at = sun * center;
    box.extend(Vec3(at - radius));
    box.extend(Vec3(at + radius));
  }
  if (box.empty()) {
    box.extend(Vec3(sun * target - Vec3::Ones()));
    box.extend(Vec3(sun * target + Vec3::Ones()));
  }
  return box;
}

/// Returns the least of 1, 1.25, 1.5, 1.75 times a power of two that is at least x.
double rounded_up(double x) {
  int exponent = 0;
  const double fraction = std::frexp(x, &exponent);  // in [0.5, 1)
  return std::ldexp(std::ceil(fraction * 8) / 8, exponent);
}

/// Returns the matrix from eye space to shadow-map coordinates. The map is snapped to a grid in the
/// world, not relative to the eye, so that shadows do not shimmer when the camera moves.
Mat4 shadow_matrix(const Mat3& sun, const Box& box, const Vec3& eye_W, double& side_m) {
  const Vec3 extent = box.extent();
  // A margin of a tenth on the extent, for the snapping below.
  const double side = rounded_up(1.1 * std::max(extent.x(), extent.y()));
  const double depth = rounded_up(1.1 * extent.z());
  side_m = side;
  const Vec3 eye = sun * eye_W;
  const double grid = side / 32;
  const auto snapped = [](double x, double step) { return std::floor(x / step + 0.5) * step; };
  const Vec3 middle(snapped(box.center().x() + eye.x(), grid) - eye.x(),
                    snapped(box.center().y() + eye.y(), grid) - eye.y(),
                    snapped(box.center().z() + eye.z(), depth / 32) - eye.z());
  const Vec3 scale(1 / side, 1 / side, 1 / depth);
  Mat4 matrix = Mat4::Identity();
  matrix.topLeftCorner<3, 3>() = scale.asDiagonal() * sun;
  matrix.topRightCorner<3, 1>() = Vec3::Constant(0.5) - scale.cwiseProduct(middle);
  return matrix;
}

// Exposure and sky colours for the default lights of a View; linear RGB.
constexpr float kExposure = 1.2f;
const Vec3f kZenith(0.20f, 0.30f, 0.47f), kHorizon(0.70f, 0.70f, 0.69f);
const Vec3f kCloud(0.95f, 0.93f, 0.9f), kSunGlow(0.42f, 0.31f, 0.18f);

void store(float* out, const Vec3f& color) {
  for (int i = 0; i < 3; ++i) out[i] = color[i];
}

void light(const View& view, FrameUniforms& u) {
  const Vec3f sun = static_cast<float>(view.sun_strength) * view.sun_color;
  const Vec3f sky = static_cast<float>(view.sky_strength) * view.sky_color;
  const Vec3f more_sun = sun.cwiseQuotient(View().sun_color);
  const Vec3f more_sky = sky.cwiseQuotient(View().sky_color);
  store(u.sun_light, sun);
  store(u.sky_light, sky);
  store(u.zenith, Vec3f(kZenith.cwiseProduct(more_sky)));
  store(u.horizon, Vec3f(kHorizon.cwiseProduct(more_sky)));
  store(u.cloud_light, Vec3f(kCloud.cwiseProduct(more_sky)));
  store(u.sun_glow, Vec3f(kSunGlow.cwiseProduct(more_sun)));
}

}  // namespace

FrameUniforms make_uniforms(const View& view, std::span<const Caster> casters, int width,
                            int height, const Sample& sample) {
  const Vec3 look = view.target_W - view.eye_W;
  const double distance = look.norm() > 0 ? look.norm() : 1.0;
  const Mat3 camera = frame_along(look.norm() > 0 ? look : Vec3(-Vec3::UnitZ()));
  const SinCos half = sin_cos(0.5 * view.fov_rad);
  const double tall = half.sin / half.cos;
  const double wide = tall * width / height;
  const double near_m = std::clamp(0.02 * distance, 0.01, 0.5);

  // Depth is 0 at the near plane and 1 at infinity: depth = 1 - near / distance.
  Mat4 projection = Mat4::Zero();
  projection(0, 0) = 1 / wide;
  projection(1, 1) = 1 / tall;
  const Vec2 jitter = sample.jitter_px.cwiseQuotient(0.5 * Vec2(width, height));
  projection.block<2, 1>(0, 2) = -jitter;
  projection(2, 2) = 1;
  projection(2, 3) = -2 * near_m;
  projection(3, 2) = 1;
  Mat4 rotation = Mat4::Identity();
  rotation.topLeftCorner<3, 3>() = camera;

  const Vec3 to_sun = view.to_sun_W.normalized();
  const auto shadow_matrix_along = [&](const Vec3& forward, double& side_m) {
    const Mat3 light = frame_along(forward);
    const ShadowReach shadows(camera, wide, tall, -forward, view.ground_m - view.eye_W.y());
    return shadow_matrix(light, caster_box(casters, shadows, light, look, 2.5 * distance),
                         view.eye_W, side_m);
  };
  double shadow_m = 0;
  double zenith_m = 0;
  const Mat4 shadow = shadow_matrix_along(-to_sun, shadow_m);
  const Mat4 zenith = shadow_matrix_along(-Vec3::UnitY(), zenith_m);

  FrameUniforms u = {};
  light(view, u);
  store(u.clip_of_eye, Mat4(projection * rotation));
  store(u.shadow_of_eye, shadow);
  store(u.zenith_of_eye, zenith);
  const Vec3 right = wide * camera.row(0).transpose(), up = tall * camera.row(1).transpose();
  store(u.ray_right, right, 0);
  store(u.ray_up, up, 0);
  store(u.ray_forward, camera.row(2).transpose() + jitter.x() * right + jitter.y() * up, 0);
  store(u.to_sun, to_sun, shadow_m / kShadowTexels);
  store(u.ground, view.ground_color.cast<double>(), view.ground_m - view.eye_W.y());
  store(u.ground_offset,
        Vec3(std::fmod(view.eye_W.x(), kGroundPeriod_m), std::fmod(view.eye_W.z(), kGroundPeriod_m),
             0),
        0);
  const Vec3 size(width, height, 1.0 / width);
  store(u.pixel, size, 1.0 / height);
  store(u.lens, Vec3(near_m, height / (2 * tall), double{kExposure} * view.exposure),
        sample.weight);
  return u;
}

}  // namespace sunder::render
