#include "engine/world/actors/hinges.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "engine/base/roots.h"
#include "engine/model/breaker.h"
#include "engine/world/actors/replace.h"
#include "engine/world/actors/world_state.h"
#include "engine/world/tuning.h"

namespace sunder {
namespace {

/// Returns the strain of the outermost fibre of a section: elongation and shear, combined by von
/// Mises, over the gauge length.
double strain_of(const PlasticSection& section, const PlasticFlow& flow) {
  const Mat3& axes = section.strength.axes_R;
  const Vec3 drawn = axes.transpose() * flow.displacement_R;
  const Vec3 turned = (axes.transpose() * flow.turn_R).cwiseProduct(section.reach_m);
  const double along = std::abs(drawn.x()) + hypotenuse(turned.y(), turned.z());
  const double across = hypotenuse(drawn.y(), drawn.z()) + std::abs(turned.x());
  return hypotenuse(along, across / std::numbers::sqrt3) / section.gauge_m;
}

HingeSide side_of(const BreakEdit& edit, const Structure& structure, const PlasticHinge& hinge,
                  bool is_a) {
  const std::uint32_t piece = is_a ? hinge.piece_a : hinge.piece_b;
  HingeSide side;
  for (const Bond& bond : hinge.bonds) {
    const std::uint32_t convex = is_a ? bond.a : bond.b;
    side.convexes.push_back(piece > 0 ? edit.loose.pieces[piece - 1].convexes[convex]
                                      : structure.convex(ConvexSlot(convex)));
    side.faces.push_back(is_a ? bond.face_a : bond.face_b);
  }
  return side;
}

/// Adds the faces of one side of a torn section to the exposed faces.
void note_torn_side(WorldState& world, std::uint32_t key, const HingeSide& side,
                    const std::vector<double>& areas_m2) {
  const Actor& actor = *world.actors.find(key);
  BreakEdit bare;
  for (std::size_t i = 0; i < side.slots.size(); ++i) {
    bare.loose.exposed.push_back(
        {0, side.slots[i], side.faces[i], areas_m2[i], side.convexes[i]->material});
  }
  note_exposed(world, actor.structure, bare, motion_of(actor, world.physics->state(actor.body)),
               std::span(&key, 1));
}

void tear(WorldState& world, const Joints::Live& joint) {
  const Hinge& hinge = *joint.hinge;
  note_torn_side(world, joint.a.key, hinge.a, hinge.areas_m2);
  note_torn_side(world, joint.b.key, hinge.b, hinge.areas_m2);
  const Actor& actor = *world.actors.find(joint.a.key);
  BreakEvent event = make_break_event(world, actor, hinge.a.convexes[0]->material);
  event.child_keys = {joint.a.key, joint.b.key};
  event.point_W = rest_pose(actor, world.physics->state(actor.body).X_WB) * joint.a.anchor_R;
  for (const double area_m2 : hinge.areas_m2) event.new_area_m2 += area_m2;
  event.pieces = 2;
  world.log.breaks.push_back(event);
  world.joints.cut(*world.physics, joint.id);
}

}  // namespace

void add_hinges(WorldState& world, const Actor& parent, const BreakEdit& edit,
                std::span<const Actor> pieces, std::span<const std::uint32_t> piece_keys) {
  const auto actor = [&](std::uint32_t piece) -> const Actor& {
    const auto it = std::ranges::find(pieces, piece_keys[piece], &Actor::key);
    return it != pieces.end() ? *it : parent;
  };
  for (const PlasticHinge& plastic : edit.hinges) {
    Hinge hinge;
    hinge.section = plastic.section;
    hinge.flowed_step = world.clock.step;
    hinge.a = side_of(edit, parent.structure, plastic, true);
    hinge.b = side_of(edit, parent.structure, plastic, false);
    for (const Bond& bond : plastic.bonds) hinge.areas_m2.push_back(bond.area_m2);
    world.joints.add(*world.physics, actor(plastic.piece_a), actor(plastic.piece_b),
                     std::move(hinge));
  }
}

void update_hinges(WorldState& world) {
  for (const PlasticFlow& flowed : world.physics->plastic_flows()) {
    Joints::Live& joint = world.joints.at(flowed.joint);
    Hinge& hinge = *joint.hinge;
    world.log.add_plastic_work(flowed.work_J);
    world.log.report.energy.joints -= flowed.work_J;  // the solve has counted it there
    hinge.flowed_step = world.clock.step;
    hinge.rejoin_failed = false;
    hinge.strain += strain_of(hinge.section, flowed);
    if (hinge.strain > hinge.section.elongation) {
      tear(world, joint);
    } else if (hinge.strain - hinge.solver_strain > kMinStrainUpdate * hinge.section.elongation) {
      world.physics->strengthen(joint.id, hinge.strength());
      hinge.solver_strain = hinge.strain;
    }
  }
}

}  // namespace sunder
