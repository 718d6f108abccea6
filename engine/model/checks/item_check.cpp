#include "engine/model/checks/item_check.h"

#include <algorithm>
#include <limits>
#include <sstream>
#include <utility>

#include "engine/base/check.h"

namespace sunder {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

}  // namespace

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

void ItemCheck::need_finite(const Vec3& vector, const std::string& name) const {
  if (!vector.allFinite()) refuse(name + " is not finite", "three finite numbers");
}

void ItemCheck::pose(const Pose& X_W, const std::string& name) const {
  need_finite(X_W.position, name + ".position");
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
  need_number(material.density_kg_m3, 1e-6, 1e9, name + "density_kg_m3");
  need_number(material.friction, 0, kMaxNumber, name + "friction");
  need_number(material.restitution, 0, 1, name + "restitution");
  need_number(material.rolling, 0, kMaxNumber, name + "rolling");
  need_number(material.youngs_Pa, 1, 1e15, name + "youngs_Pa");
  const std::pair<double, const char*> sizes[] = {
      {material.strength_Ns.value_or(0), "strength_Ns"},
      {material.toughness_J_m2, "toughness_J_m2"},
      {material.impact_radius_m, "impact_radius_m"},
      {material.tensile_Pa, "tensile_Pa"},
      {material.shear_Pa, "shear_Pa"},
      {material.compressive_Pa, "compressive_Pa"},
      {material.yield_Pa, "yield_Pa"},
      {material.smallest_break_m3.value_or(0), "smallest_break_m3"},
      {material.smallest_piece_m3, "smallest_piece_m3"}};
  for (const auto& [size, key] : sizes) need_number(size, 0, kInfinity, name + key);
  need_number(material.reinforcement_percent, 0, 100, name + "reinforcement_percent");
  need_number(material.hardening_Pa, 0, kInfinity, name + "hardening_Pa");
  need_number(material.elongation, 0, kInfinity, name + "elongation");
  pattern(material.pattern, name + "pattern.");
  for (std::size_t k = 0; k < material.stronger.size(); ++k) {
    const ImpactResponse& stronger = material.stronger[k];
    const std::string member = name + item("stronger", k) + ".";
    need_number(stronger.energy_J, k > 0 ? material.stronger[k - 1].energy_J : 0, kInfinity,
                member + "energy_J");
    need_number(stronger.impact_radius_m, 0, kInfinity, member + "impact_radius_m");
    pattern(stronger.pattern, member + "pattern.");
  }
  const DebrisEmission& crumbling = material.crumbling;
  need_number(crumbling.particles_per_m2, 0, kMaxNumber, name + "crumbling.particles_per_m2");
  need_number(crumbling.debris_ratio, 0, 1, name + "crumbling.debris_ratio");
  need_number(crumbling.debris_smallest_m, 1e-6, kMaxNumber, name + "crumbling.debris_smallest_m");
  need_number(crumbling.debris_largest_m, crumbling.debris_smallest_m, kMaxNumber,
              name + "crumbling.debris_largest_m");
  need_number(crumbling.dust_kg_m2, 0, kMaxNumber, name + "crumbling.dust_kg_m2");
  need_number(crumbling.dust_settling_m_s, 0, kMaxNumber, name + "crumbling.dust_settling_m_s");
}

void ItemCheck::pattern(const PatternSpec& pattern, const std::string& name) const {
  constexpr int kMaxCells = 100000;
  need_number(pattern.cells, 1, kMaxCells, name + "cells");
  need_number(pattern.rings, 1, kMaxCells, name + "rings");
  need_number(pattern.spokes, 1, kMaxCells, name + "spokes");
  need_number(pattern.colors, 0, kMaxCells, name + "colors");
  need_number(pattern.falloff, 0, kMaxNumber, name + "falloff");
  need_number(pattern.jitter, 0, 1, name + "jitter");
  if (pattern.kind == PatternSpec::Kind::kFile && pattern.file.empty())
    refuse(name + "file is empty", "the name of a file");
  if (pattern.kind != PatternSpec::Kind::kBrick) return;
  for (const double side_m : pattern.brick_m)
    need_number(side_m, 1e-6, kMaxNumber, name + "brick_m");
}

void ItemCheck::convexes(const Compound& compound, const std::string& name) const {
  const std::size_t count = compound.convexes.size();
  if (count == 0) refuse(name + " has no convexes", "at least one");
  if (compound.anchored.size() != count)
    refuse(name + ".anchored has " + std::to_string(compound.anchored.size()) + " elements",
           "one for each convex, " + std::to_string(count));
  for (const ConvexPtr& convex : compound.convexes) {
    if (!convex) refuse(name + " has a null convex", "no null pointers");
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
  need_finite(solid.velocity_W, name + ".velocity_W");
  need_finite(solid.angular_velocity_W, name + ".angular_velocity_W");
}

void ItemCheck::ball(const Ball& ball, const std::string& name) const {
  need_number(ball.radius_m, 1e-9, kMaxNumber, name + ".radius_m");
  material_index(ball.material, name);
  need_finite(ball.center_W, name + ".center_W");
  need_finite(ball.velocity_W, name + ".velocity_W");
}

void ItemCheck::blast(const Blast& blast, const std::string& name) const {
  need_number(blast.time_s, -kMaxTime_s, kMaxTime_s, name + ".time_s");
  need_finite(blast.center_W, name + ".center_W");
  need_number(blast.radius_m, 1e-9, kMaxNumber, name + ".radius_m");
  need_number(blast.impulse_Ns_m2, 0, 1e15, name + ".impulse_Ns_m2");
  if (blast.tnt_kg) need_number(*blast.tnt_kg, 1e-9, kMaxNumber, name + ".tnt_kg");
}

void ItemCheck::shot(const Shot& shot, const std::string& name) const {
  ball(shot.ball, name + ".ball");
  need_number(shot.time_s, -kMaxTime_s, kMaxTime_s, name + ".time_s");
  need_finite(shot.hangs_from_W.value_or(Vec3::Zero()), name + ".hangs_from_W");
  for (const Solid& link : shot.links) solid(link, name + ".links");
}

void ItemCheck::drive(const Drive& drive, const std::string& name) const {
  need_number(drive.time_s, -kMaxTime_s, kMaxTime_s, name + ".time_s");
  need_number(drive.until_s, drive.time_s, kInfinity, name + ".until_s");
  if (!drive.velocity_W && !drive.angular_velocity_W)
    refuse(name + " has no velocity", "velocity_W, angular_velocity_W or both");
  need_finite(drive.velocity_W.value_or(Vec3::Zero()), name + ".velocity_W");
  need_finite(drive.angular_velocity_W.value_or(Vec3::Zero()), name + ".angular_velocity_W");
  need_number(drive.force_N, 0, kInfinity, name + ".force_N");
  need_number(drive.torque_Nm, 0, kInfinity, name + ".torque_Nm");
}

void ItemCheck::joint(const Joint& joint, const std::string& name) const {
  if (!joint.a && !joint.b) refuse(name + " has no body", "a, b or both");
  if (joint.a == joint.b) refuse(name + " joins a body to itself", "two different bodies");
  need_finite(joint.at_W, name + ".at_W");
  need_finite(joint.to_W, name + ".to_W");
  need_finite(joint.axis_W, name + ".axis_W");
  need_number(joint.breaking_N, 0, kInfinity, name + ".breaking_N");
  need_number(joint.breaking_Nm, 0, kInfinity, name + ".breaking_Nm");
  if (joint.kind == JointKind::kHinge && !(joint.axis_W.norm() > 0))
    refuse(name + ".axis_W is zero", "a vector with a length");
  if (joint.kind == JointKind::kPlastic)
    refuse(name + ".kind is kPlastic, which scenes cannot use", "another kind of joint");
}

}  // namespace sunder
