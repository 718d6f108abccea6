#include "engine/model/checks/item_check.h"

#include <algorithm>
#include <sstream>
#include <tuple>
#include <utility>

#include "engine/base/check.h"

namespace sunder {
std::string item(const char* list, std::size_t i) {
  return std::string(list) + "[" + std::to_string(i) + "]";
}

std::string number_text(double number) {
  std::ostringstream out;
  out << number;
  return out.str();
}

void ItemCheck::refuse(const std::string& what, const std::string& expected) const {
  throw InputError(prefix_ + what + "; expected " + expected);
}

void ItemCheck::need_number(double number, double low, double high, const std::string& name) const {
  if (number >= low && number <= high) return;
  refuse(name + " is " + number_text(number),
         "a number from " + number_text(low) + " to " + number_text(high));
}

void ItemCheck::need_vector(const Vec3& vector, const Range& range, const std::string& name) const {
  for (const double element : vector)
    if (!(element >= range.low && element <= range.high))
      refuse(name + " has the element " + number_text(element),
             "three numbers from " + number_text(range.low) + " to " + number_text(range.high));
}

void ItemCheck::need_finite(const Vec3& vector, const std::string& name) const {
  if (!vector.allFinite()) refuse(name + " is not finite", "three finite numbers");
}

void ItemCheck::pose(const Pose& X_W, const std::string& name) const {
  need_vector(X_W.position, ranges::kPlace_m, name + ".position");
  need_number(X_W.rotation.norm(), 0.999, 1.001, "the length of " + name + ".rotation");
}

void ItemCheck::material_index(MaterialIndex index, const std::string& name) const {
  if (index.value < materials_.size()) return;
  refuse(
      name + (index.none() ? " has no material" : " has material " + std::to_string(index.value)),
      materials_.empty() ? "a material, of which there are none"
                         : "one of the " + std::to_string(materials_.size()) + " materials");
}

void ItemCheck::material(const Material& material, const std::string& of) const {
  const std::string name = of + ".";
  const std::tuple<double, Range, const char*> numbers[] = {
      {material.density_kg_m3, ranges::kDensity_kg_m3, "density_kg_m3"},
      {material.friction, ranges::kFriction, "friction"},
      {material.restitution, ranges::kFraction, "restitution"},
      {material.rolling, ranges::kRolling, "rolling"},
      {material.youngs_Pa, ranges::kYoungs_Pa, "youngs_Pa"},
      {material.strength_Ns.value_or(0), ranges::kAtLeastZero, "strength_Ns"},
      {material.toughness_J_m2, ranges::kAtLeastZero, "toughness_J_m2"},
      {material.impact_radius_m, ranges::kImpactRadius_m, "impact_radius_m"},
      {material.tensile_Pa, ranges::kAtLeastZero, "tensile_Pa"},
      {material.shear_Pa, ranges::kAtLeastZero, "shear_Pa"},
      {material.compressive_Pa, ranges::kAtLeastZero, "compressive_Pa"},
      {material.yield_Pa, ranges::kAtLeastZero, "yield_Pa"},
      {material.smallest_break_m3.value_or(0), ranges::kAtLeastZero, "smallest_break_m3"},
      {material.smallest_piece_m3, ranges::kAtLeastZero, "smallest_piece_m3"},
      {material.reinforcement_percent, ranges::kReinforcement_percent, "reinforcement_percent"},
      {material.hardening_Pa, ranges::kHardening_Pa, "hardening_Pa"},
      {material.elongation, ranges::kElongation, "elongation"}};
  for (const auto& [number, range, key] : numbers) need_number(number, range, name + key);
  pattern(material.pattern, name + "pattern.");
  for (std::size_t k = 0; k < material.stronger.size(); ++k) {
    const ImpactResponse& stronger = material.stronger[k];
    const std::string member = name + item("stronger", k) + ".";
    need_number(stronger.energy_J, k > 0 ? material.stronger[k - 1].energy_J : 0,
                ranges::kAtLeastZero.high, member + "energy_J");
    need_number(stronger.impact_radius_m, ranges::kImpactRadius_m, member + "impact_radius_m");
    pattern(stronger.pattern, member + "pattern.");
  }
  const DebrisEmission& crumbling = material.crumbling;
  const std::string of_debris = name + "crumbling.";
  need_number(crumbling.particles_per_m2, ranges::kParticles_per_m2,
              of_debris + "particles_per_m2");
  need_number(crumbling.debris_ratio, ranges::kFraction, of_debris + "debris_ratio");
  need_number(crumbling.debris_smallest_m, ranges::kDebrisRadius_m,
              of_debris + "debris_smallest_m");
  need_number(crumbling.debris_largest_m, crumbling.debris_smallest_m, ranges::kDebrisRadius_m.high,
              of_debris + "debris_largest_m");
  need_number(crumbling.dust_kg_m2, ranges::kDust_kg_m2, of_debris + "dust_kg_m2");
  need_number(crumbling.dust_settling_m_s, ranges::kDustSettling_m_s,
              of_debris + "dust_settling_m_s");
}

void ItemCheck::pattern(const PatternSpec& pattern, const std::string& name) const {
  need_number(pattern.cells, ranges::kCells, name + "cells");
  if (pattern.kind == PatternSpec::Kind::kGrid && pattern.cells > ranges::kMostGridCells)
    refuse(name + "cells is " + std::to_string(pattern.cells) + " along each side of a grid",
           "a number from " + number_text(ranges::kCells.low) + " to " +
               number_text(ranges::kMostGridCells));
  need_number(pattern.rings, ranges::kRings, name + "rings");
  need_number(pattern.spokes, ranges::kSpokes, name + "spokes");
  need_number(pattern.colors, ranges::kColors, name + "colors");
  need_number(pattern.falloff, ranges::kFalloff, name + "falloff");
  need_number(pattern.jitter, ranges::kFraction, name + "jitter");
  if (pattern.kind == PatternSpec::Kind::kFile && pattern.file.empty())
    refuse(name + "file is empty", "the name of a file");
  need_vector(pattern.brick_m, ranges::kBrick_m, name + "brick_m");
}

void ItemCheck::convexes(const Compound& compound, const std::string& name) const {
  const std::size_t count = compound.convexes.size();
  if (count == 0) refuse(name + " has no convexes", "at least one");
  if (compound.anchored.size() != count)
    refuse(name + ".anchored has " + std::to_string(compound.anchored.size()) + " elements",
           "one for each convex, " + std::to_string(count));
  for (const ConvexPtr& convex : compound.convexes) {
    if (!convex) refuse(name + " has a null convex", "no null pointers");
    const ConvexPolyhedron& shape = convex->polyhedron;
    if (shape.corners.size() > kMostConvexCorners)
      refuse(name + " has a convex of " + std::to_string(shape.vertices.size()) +
                 " points, whose faces have " + std::to_string(shape.corners.size()) + " corners",
             "at most " + std::to_string(kMostConvexCorners) + " corners, or about " +
                 std::to_string(kMostConvexCorners / 6) +
                 " points; leave points out, or give the surface as a mesh");
    if (!(convex->solid.volume_m3 > 0))
      refuse(name + " has a convex without volume", "a volume above 0");
  }
  for (const Bond& bond : compound.bonds) {
    if (bond.a >= count || bond.b >= count)
      refuse(name + " has a bond with convex " + std::to_string(std::max(bond.a, bond.b)),
             "an index below " + std::to_string(count));
    if (bond.face_a >= compound.convexes[bond.a]->polyhedron.faces.size() ||
        bond.face_b >= compound.convexes[bond.b]->polyhedron.faces.size())
      refuse(name + " has a bond with a face that does not exist",
             "faces of the convexes; make_compound() finds bonds");
  }
  for (const Ghost& ghost : compound.ghosts) {
    if (!ghost.convex) refuse(name + " has a ghost without a convex", "a convex");
    for (const std::uint32_t of : ghost.of) {
      if (of >= count)
        refuse(name + " has a ghost with convex " + std::to_string(of),
               "an index below " + std::to_string(count));
    }
  }
}

void ItemCheck::solid(const Solid& solid, const std::string& name) const {
  convexes(solid.compound, name + ".compound");
  for (const ConvexPtr& convex : solid.compound.convexes) material_index(convex->material, name);
  pose(solid.X_WR, name + ".X_WR");
  need_vector(solid.velocity_W, ranges::kSpeed_m_s, name + ".velocity_W");
  need_vector(solid.angular_velocity_W, ranges::kSpin_rad_s, name + ".angular_velocity_W");
}

void ItemCheck::ball(const Ball& ball, const std::string& name) const {
  need_number(ball.radius_m, ranges::kLength_m, name + ".radius_m");
  material_index(ball.material, name);
  need_vector(ball.center_W, ranges::kPlace_m, name + ".center_W");
  need_vector(ball.velocity_W, ranges::kSpeed_m_s, name + ".velocity_W");
}

void ItemCheck::blast(const Blast& blast, const std::string& name) const {
  need_number(blast.time_s, ranges::kTime_s, name + ".time_s");
  need_vector(blast.center_W, ranges::kPlace_m, name + ".center_W");
  need_number(blast.radius_m, ranges::kBlastRadius_m, name + ".radius_m");
  need_number(blast.impulse_Ns_m2, ranges::kBlastImpulse_Ns_m2, name + ".impulse_Ns_m2");
  if (blast.tnt_kg) need_number(*blast.tnt_kg, ranges::kTnt_kg, name + ".tnt_kg");
}

void ItemCheck::shot(const Shot& shot, const std::string& name) const {
  ball(shot.ball, name + ".ball");
  need_number(shot.time_s, ranges::kTime_s, name + ".time_s");
  need_vector(shot.hangs_from_W.value_or(Vec3::Zero()), ranges::kPlace_m, name + ".hangs_from_W");
  for (const Solid& link : shot.links) solid(link, name + ".links");
}

void ItemCheck::drive(const Drive& drive, const std::string& name) const {
  need_number(drive.time_s, ranges::kTime_s, name + ".time_s");
  need_number(drive.until_s, drive.time_s, ranges::kInfinity, name + ".until_s");
  if (!drive.velocity_W && !drive.angular_velocity_W)
    refuse(name + " has no velocity", "velocity_W, angular_velocity_W or both");
  need_vector(drive.velocity_W.value_or(Vec3::Zero()), ranges::kSpeed_m_s, name + ".velocity_W");
  need_vector(drive.angular_velocity_W.value_or(Vec3::Zero()), ranges::kSpin_rad_s,
              name + ".angular_velocity_W");
  need_number(drive.force_N, ranges::kForce, name + ".force_N");
  need_number(drive.torque_Nm, ranges::kForce, name + ".torque_Nm");
}

void ItemCheck::joint(const Joint& joint, const std::string& name) const {
  if (!joint.a && !joint.b) refuse(name + " has no body", "a, b or both");
  if (joint.a == joint.b) refuse(name + " joins a body to itself", "two different bodies");
  need_vector(joint.at_W, ranges::kPlace_m, name + ".at_W");
  need_vector(joint.to_W, ranges::kPlace_m, name + ".to_W");
  need_finite(joint.axis_W, name + ".axis_W");
  need_number(joint.breaking_N, ranges::kForce, name + ".breaking_N");
  need_number(joint.breaking_Nm, ranges::kForce, name + ".breaking_Nm");
  if (joint.kind == JointKind::kHinge && !(joint.axis_W.norm() > 0))
    refuse(name + ".axis_W is zero", "a vector with a length");
  if (joint.kind == JointKind::kPlastic)
    refuse(name + ".kind is kPlastic, which scenes cannot use", "another kind of joint");
}

}  // namespace sunder
