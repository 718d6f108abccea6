#include "fracture/pattern_breaker.h"

#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "engine/base/archive.h"
#include "engine/base/random.h"
#include "engine/base/roots.h"
#include "engine/base/trigonometry.h"
#include "engine/geometry/clip.h"
#include "engine/geometry/polygon_mesh.h"
#include "fracture/fracture.h"
#include "fracture/pattern/cell_limit.h"
#include "fracture/plug.h"
#include "fracture/rejoin.h"
#include "fracture/stress/separate_islands.h"
#include "fracture/stress/stress_breaks.h"
#include "fracture/stress/stress_memory.h"
#include "fracture/tuning.h"

namespace sunder::fracture {
namespace {

/// Returns the rotation that takes y to `axis`, after a rotation about y.
Quat rotation_onto(const Vec3& axis, double about_y_rad) {
  const Vec3 y = axis.normalized();
  Vec3 x = y.cross(std::abs(y.x()) < 0.7 ? Vec3::UnitX() : Vec3::UnitZ()).normalized();
  const SinCos angle = sin_cos(about_y_rad);
  x = angle.cos * x + angle.sin * y.cross(x);
  Mat3 rotation;
  rotation << x, y, x.cross(y);
  return Quat(rotation).normalized();
}

/// Returns the direction across a pane, and that of the impact for other convexes.
Vec3 axis_across(const Convex& convex, const Vec3& direction_R) {
  double least = std::numeric_limits<double>::infinity();
  Vec3 thin = direction_R;
  for (const ConvexPolyhedron::Face& face : convex.polyhedron.faces) {
    double width = 0;
    for (const Vec3& vertex : convex.polyhedron.vertices) {
      width = std::max(width, -face.plane.distance(vertex));
    }
    if (width < least) {
      least = width;
      thin = face.plane.normal;
    }
  }
  if (least > kMaxPaneThickness * cube_root(convex.solid.volume_m3)) return direction_R;
  return thin.dot(direction_R) < 0 ? Vec3(-thin) : thin;
}

/// Returns the orientation of a pattern: random for Voronoi cells, that of the rest frame for
/// bricks, along the longest side of the convex for wood, across the pane or along the impact for
/// webs.
Quat orientation(PatternSpec::Kind kind, const Convex& convex, const Vec3& direction_R,
                 Random& random) {
  const double about_y_rad = random.uniform(0, 2 * std::numbers::pi);
  int longest = 0;
  convex.box.extent().maxCoeff(&longest);
  switch (kind) {
    case PatternSpec::Kind::kVoronoi:
      return rotation_onto(random.direction(), about_y_rad);
    case PatternSpec::Kind::kWeb:
    case PatternSpec::Kind::kRadial:
      return rotation_onto(axis_across(convex, direction_R), about_y_rad);
    case PatternSpec::Kind::kSlabs: {
      Mat3 rotation;
      rotation << Vec3::Unit(longest), Vec3::Unit((longest + 1) % 3), Vec3::Unit((longest + 2) % 3);
      return Quat(rotation);
    }
    default:
      return Quat::Identity();
  }
}

/// Returns the share of a convex, given in the pattern's frame, that lies in the hole of a plug.
double share_in(const Plug& plug, ConvexPolyhedron part_P) {
  const double volume_m3 = mass_properties(part_P).volume_m3;
  ConvexPolyhedron cut;
  ClipScratch scratch;
  const double tolerance_m = 1e-9 * cube_root(volume_m3);
  const auto keep = [&](const Plane& plane) {
    const PlaneSide side = clip(part_P, plane, PlaneId{}, tolerance_m, cut, scratch);
    if (side == PlaneSide::kCut) std::swap(part_P, cut);
    return side != PlaneSide::kOutside;
  };
  const std::vector<Vec2>& section = plug.section_m;
  for (std::size_t i = 0; i < section.size(); ++i)
    if (!keep(plane_parallel_to_y(plug.clearance * section[i],
                                  plug.clearance * section[(i + 1) % section.size()])))
      return 0;
  if (!plug.through && !keep(Plane::through(Vec3(0, plug.depth_m, 0), Vec3::UnitY()))) return 0;
  return mass_properties(part_P).volume_m3 / volume_m3;
}

/// Separates the convexes that reach into a plug from all others, and from each other.
BreakEdit separate_plug(const Structure& structure, const BreakCommand& command) {
  const Pose X_PR = command.X_RP.inverse();
  const Plug& plug = *command.plug;
  std::vector<ConvexSlot> loose;
  for (const ConvexSlot slot : structure.within(command.X_RP.position, command.radius_m)) {
    const Convex& convex = *structure.convex(slot);
    if (structure.anchored(slot) != 0 ||
        std::ranges::find(command.unbreakable, convex.material) == command.unbreakable.end())
      continue;
    if (share_in(plug, transformed(convex.polyhedron, X_PR)) > kMinShareInPlug)
      loose.push_back(slot);
  }
  if (loose.empty()) return {};
  Compound compound = structure.compound();
  const std::vector<ConvexSlot> slots = structure.slots();
  const auto is_loose = [&](std::uint32_t convex) {
    return std::ranges::binary_search(loose, slots[convex]);
  };
  std::vector<Bond> cut;
  std::erase_if(compound.bonds, [&](const Bond& bond) {
    const bool parts = is_loose(bond.a) || is_loose(bond.b);
    if (parts) cut.push_back(bond);
    return parts;
  });
  return separate_islands(compound, slots, cut, {});
}

/// Marks the pieces that lie between a plug and its hole.
void mark_crushed(const BreakCommand& command, BreakPlan& plan) {
  const Pose X_PR = command.X_RP.inverse();
  for (const Compound& piece : plan.pieces) {
    plan.crushed.push_back(std::ranges::all_of(piece.convexes, [&](const ConvexPtr& convex) {
      return command.plug->crushes(X_PR * convex->solid.centroid);
    }));
  }
}

/// Replaces the pattern by a plug if the striker drives one out of the solid. A pane that is not
/// pierced has no crater: it bends, and cracks by its pattern.
void add_plug(const Convex& convex, const Material& material, const StructureImpact& hit,
              BreakCommand& command) {
  Pose X_RP;
  command.plug = make_plug(material, hit, X_RP);
  const bool is_pane = is_thin(convex) && cracks_run_out(material.pattern);
  if (command.plug && is_pane && !command.plug->through) command.plug.reset();
  if (!command.plug) return;
  command.X_RP = X_RP;
  const double widest_m =
      std::max(command.plug->reach_m, command.plug->clearance * command.plug->section_reach_m());
  command.radius_m = kPlugSphereScale * hypotenuse(widest_m, command.plug->depth_m);
}

class PatternBreaker final : public Breaker {
 public:
  explicit PatternBreaker(std::shared_ptr<FailureLog> log) : log_(std::move(log)) {}

  BreakCommand command(const Convex& convex, std::span<const Material> materials,
                       const StructureImpact& hit, std::uint64_t event,
                       std::uint64_t seed) const override {
    const Material& material = materials[convex.material.value];
    Random random(seed, 3);
    BreakCommand command;
    command.event = event;
    command.seed = seed;
    command.pattern = material.pattern;
    command.radius_m = material.impact_radius_m;
    command.fit = material.fit;
    command.smallest_m3 = material.min_breakable_volume_m3();
    for (const ImpactResponse& stronger : material.stronger) {
      if (hit.energy_J < stronger.energy_J) break;
      command.pattern = stronger.pattern;
      command.radius_m = stronger.impact_radius_m;
    }
    const double thickness_m = is_thin(convex) ? mean_thickness_m(convex) : 0;
    limit_cells_by_energy(material, hit, command.radius_m, thickness_m, command.pattern);
    for (std::size_t m = 0; m < materials.size(); ++m) {
      if (!materials[m].breakable()) command.unbreakable.emplace_back(m);
    }
    command.X_RP = {hit.point_R,
                    orientation(command.pattern.kind, convex, hit.direction_R, random)};
    add_plug(convex, material, hit, command);
    return command;
  }

  BreakEdit plan(const Structure& structure, const BreakCommand& command) const override {
    if (command.plug && command.plug->section_m.empty()) return {};
    if (command.pattern.kind == PatternSpec::Kind::kNone)
      return command.plug ? separate_plug(structure, command) : BreakEdit{};
    const bool whole = command.radius_m == std::numeric_limits<double>::infinity();
    const PreparedBreak ready = prepare_break(command, whole ? bounds(structure) : Box(), library_);
    BreakEdit edit = break_structure(structure, *ready.pattern, ready.placement, ready.sphere,
                                     command.event, command.fit);
    if (command.plug && command.plug->clearance > 1) mark_crushed(command, edit.loose);
    if (log_ && edit.loose.failed > 0) {
      log_->keep(structure.compound(), command);
    }
    return edit;
  }

  void on_applied(const BreakPlan& plan) const override {
    if (log_) log_->count(plan.failed, plan.failed_m3);
  }
  void archive(Archive& bytes, StressCachePtr& memory) const override {
    auto known = std::static_pointer_cast<const KnownStress>(memory);
    bytes(known);
    memory = std::move(known);
  }
  StressResult stress(const Structure& structure, const LoadCase& load) const override {
    return break_by_stress(structure, load);
  }
  std::vector<float> utilisation(const Structure& structure, const LoadCase& load) const override {
    return utilisation_by_stress(structure, load);
  }
  Rejoined rejoin(const BentPair& bent) const override { return rejoin_bent(bent); }

 private:
  std::shared_ptr<FailureLog> log_;
  mutable PatternLibrary library_;
};

/// Returns the distance from `from` to the farthest corner of a box.
double reach(const Box& box, const Vec3& from) {
  return (box.max - from).cwiseAbs().cwiseMax((box.min - from).cwiseAbs()).norm();
}

}  // namespace

PreparedBreak prepare_break(const BreakCommand& command, const Box& bounds_R,
                            PatternLibrary& library) {
  PreparedBreak ready;
  ready.sphere = {command.X_RP.position, command.radius_m, command.unbreakable,
                  command.smallest_m3};
  const bool whole = ready.sphere.is_infinite();
  const double unit = whole ? reach(bounds_R, ready.sphere.center_R) : ready.sphere.radius_m;
  ready.pattern =
      command.plug
          ? std::make_shared<const Pattern>(plug_pattern(*command.plug, unit, command.seed))
          : library.find(command.pattern, {unit, whole}, command.seed);
  ready.placement = {command.X_RP.rotation.toRotationMatrix() * (unit * command.stretch_P),
                     command.X_RP.position};
  return ready;
}

std::unique_ptr<Breaker> make_pattern_breaker(std::shared_ptr<FailureLog> log) {
  return std::make_unique<PatternBreaker>(std::move(log));
}

}  // namespace sunder::fracture
