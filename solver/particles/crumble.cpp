#include "solver/particles/crumble.h"

#include <algorithm>
#include <cmath>

#include "solver/particles/tuning.h"

namespace sunder::solver {
namespace {

double area(const ExposedPolygon& face) {
  Vec3 sum = Vec3::Zero();
  for (std::size_t c = 2; c < face.corners_W.size(); ++c) {
    const Vec3& apex = face.corners_W[0];
    sum += (face.corners_W[c - 1] - apex).cross(face.corners_W[c] - apex);
  }
  return 0.5 * sum.norm();
}

/// Returns the number of particles, debris and dust together, that a square metre emits.
double emission_density_m2(const ExposedPolygon& face) {
  return face.crumbling.particles_per_m2 *
         std::min(1.0, kClosedCrackEmission + face.opening_speed_m_s / kFullEmissionSpeed_m_s);
}

/// Returns a uniform random point of the polygon: a triangle of its fan by area, a point of that.
Vec3 point_on(const ExposedPolygon& face, double face_area_m2, Random& random) {
  double left_m2 = random.uniform() * face_area_m2;
  const Vec3& apex = face.corners_W[0];
  std::size_t c = 2;
  for (;; ++c) {
    const Vec3 cross = (face.corners_W[c - 1] - apex).cross(face.corners_W[c] - apex);
    left_m2 -= 0.5 * cross.norm();
    if (left_m2 <= 0 || c + 1 == face.corners_W.size()) break;
  }
  double u = random.uniform(), v = random.uniform();
  if (u + v > 1) {
    u = 1 - u;
    v = 1 - v;
  }
  return apex + u * (face.corners_W[c - 1] - apex) + v * (face.corners_W[c] - apex);
}

/// Returns a random size between two limits by a power law: N(> r) ~ r^-2.
double power_law(double smallest, double largest, Random& random) {
  const double ratio = smallest / largest;
  return smallest / std::sqrt(1 - random.uniform() * (1 - ratio * ratio));
}

/// Returns a random rotation, uniform over all rotations.
Quatf random_rotation(Random& random) {
  for (;;) {
    Eigen::Vector4d q;  // drawn in a fixed order, independent of the compiler
    for (int i = 3; i >= 0; --i) q[i] = random.uniform(-1, 1);
    const double square = q.squaredNorm();
    if (square > 1e-4 && square <= 1) {
      return Quatf(Eigen::Vector4f((q / std::sqrt(square)).cast<float>()));
    }
  }
}

std::uint8_t random_variant(Random& random) {
  return static_cast<std::uint8_t>(random.below(kDebrisVariants));
}

double spall_m_s(const ExposedPolygon& face) {
  return kSpallSpeed_m_s + kSpallPerOpening * face.opening_speed_m_s;
}

DebrisBirth chip_from(const ExposedPolygon& face, double area_m2, Random& random) {
  const DebrisEmission& crumbling = face.crumbling;
  const Vec3 point = point_on(face, area_m2, random);
  const double speed = spall_m_s(face) / (random.uniform() + kSpallSpeedOffset);
  const Vec3 velocity = face.motion(point) + speed * (face.normal_W + random.direction());
  const double radius = power_law(crumbling.debris_smallest_m, crumbling.debris_largest_m, random);
  const Vec3 center = point + radius * face.normal_W;
  const double spin_s = kMaxChipSpin_s * random.uniform();
  const Vec3 spin = spin_s * random.direction();
  return {center.cast<float>(),
          velocity.cast<float>(),
          spin.cast<float>(),
          random_rotation(random),
          static_cast<float>(radius),
          random_variant(random),
          face.material};
}

DustBirth puff_from(const ExposedPolygon& face, double area_m2, Random& random) {
  const DebrisEmission& crumbling = face.crumbling;
  const Vec3 point = point_on(face, area_m2, random);
  const Vec3 velocity =
      kDustVelocity * face.motion(point) + spall_m_s(face) * (face.normal_W + random.direction());
  // The dust mass of a square metre, divided by its number of puffs.
  const double mass_kg =
      crumbling.dust_kg_m2 / (crumbling.particles_per_m2 * (1 - crumbling.debris_ratio));
  const double settling = crumbling.dust_settling_m_s * random.uniform(0.5, 1.5);
  return {point.cast<float>(),
          velocity.cast<float>(),
          random_rotation(random),
          static_cast<float>(mass_kg),
          static_cast<float>(settling),
          static_cast<float>(kMinPuffRadius_m * random.uniform(1, 2)),
          face.material};
}

}  // namespace

CapacityShares capacity_shares(std::span<const ExposedPolygon> faces, const Debris& debris,
                               const Dust& dust) {
  double expected_debris = 0, expected_dust = 0;
  for (const ExposedPolygon& face : faces) {
    const double count = emission_density_m2(face) * area(face);
    expected_debris += count * face.crumbling.debris_ratio;
    expected_dust += count * (1 - face.crumbling.debris_ratio);
  }
  const auto share = [](std::uint32_t capacity, double expected) {
    return expected > capacity ? capacity / expected : 1;
  };
  return {share(debris.room(), expected_debris), share(dust.room(), expected_dust)};
}

void crumble(const ExposedPolygon& face, const CapacityShares& shares, Random& random,
             Debris& debris, Dust& dust) {
  const DebrisEmission& crumbling = face.crumbling;
  if (!(crumbling.particles_per_m2 > 0)) return;
  const double area_m2 = area(face);
  const auto count =
      static_cast<std::uint64_t>(emission_density_m2(face) * area_m2 + random.uniform());
  for (std::uint64_t i = 0; i < count; ++i) {
    if (random.uniform() < crumbling.debris_ratio) {
      if (random.uniform() < shares.debris) {
        debris.add(chip_from(face, area_m2, random));
      } else {
        debris.ignore();
      }
    } else if (random.uniform() < shares.dust) {
      DustBirth puff = puff_from(face, area_m2, random);
      puff.mass_kg /= static_cast<float>(shares.dust);
      dust.add(puff);
    } else {
      dust.ignore();
    }
  }
}

void add_chip(const DebrisPiece& chip, Random& random, Debris& debris) {
  debris.add({chip.center_W.cast<float>(), chip.velocity_W.cast<float>(),
              chip.angular_velocity_W.cast<float>(), random_rotation(random),
              static_cast<float>(chip.radius_m), random_variant(random), chip.material});
}

}  // namespace sunder::solver
