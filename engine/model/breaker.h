// Breaker: the interface between the world, which decides whether a solid breaks, and fracture,
// which decides into which pieces.
//
// An impact breaks a structure in three steps (engine/world/break/break_stage.cpp):
//
//   BreakCommand command = breaker.command(convex, materials, hit, event, seed);
//   BreakEdit edit = breaker.plan(structure, command);   // nothing has changed yet
//   if (edit.changed && /* the energy suffices */) structure.apply(edit);
//
// A command and a structure determine the result, so a command may be stored, written to a file and
// replayed. The energy of the impact selects the pattern; the caller compares it with the energy
// that the crack area `edit.loose.new_area_m2` takes. A plan that is not applied has no effect, and
// any number of plans may be made in parallel. The pieces of an applied plan, `edit.loose.pieces`,
// are compounds: the caller makes a Structure or debris of each.
//
// A steady load breaks a structure in two steps (engine/world/load/load_stage.cpp), whenever the
// load or the bonds have changed:
//
//   StressResult answer =
//       breaker.stress(structure, {materials, loads, gravity_R, spin_R, work, memory});
//   structure.apply(answer.edit);                         // may cut bonds without loose pieces
//   memory = answer.memory;
//
// The caller repeats this in each step until `answer.settled`, since the work of one call is
// bounded. The memory makes repeated calls cheap. A memory is valid for the structure and for each
// of its pieces, and may be dropped at any time: the next answer then costs more, and agrees with
// the former within the solver's tolerance.
//
// An impact load is evaluated in both ways: as a command, and as `LoadCase::impulsive_load`, which
// cuts the bonds that it overloads (engine/world/break/planned_break.cpp).
//
// An edit applies once, to the structure that it was computed for, in the state that this had.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/base/check.h"
#include "engine/model/section.h"
#include "engine/model/structure.h"

namespace sunder {

class Archive;

/// An impact on a structure, in the structure's rest frame R.
struct StructureImpact {
  Vec3 point_R = Vec3::Zero();
  Vec3 direction_R = Vec3::UnitY();  ///< Unit; direction of the impulse on the solid, into it.
  ConvexSlot convex;                 ///< The convex that is struck.
  double energy_J = 0;               ///< Energy that the solid would have to absorb.
  double speed_m_s = 0;              ///< Closing speed of the striker; 0: unknown.
  double striker_kg = 0;             ///< Effective mass of the striker.
  double thickness_m = 0;  ///< Thickness of the solid along `direction_R` behind the point.
  double path_m = 0;       ///< Length of the striker's path in the solid; 0: the thickness.
  double cosine = 1;       ///< Between the path and the normal of the struck face.
  double volume_m3 = 0;    ///< Volume of the solid.
  double reached_m3 = 0;   ///< Volume of the solid's convexes within the impact radius.
  bool held = true;        ///< True if the solid is anchored.
  bool confined = true;    ///< True if the solid extends all around the striker's cross-section.
  bool narrow = true;  ///< True if the striker's cross-section is no wider than a break by pattern.
  /// Corners of the striker's cross-section, in order about the axis `direction_R` through
  /// `point_R`; empty if unknown.
  std::vector<Vec3> section_R = {};
};

/// A prism that a striker narrower than the solid punches out of the solid (perforation) or into it
/// (crater), and the rings of cracks around the prism. Its sides are parallel to the axis y of the
/// pattern's frame.
struct Plug {
  /// Convex cross-section around the origin, in (x, z), counter-clockwise.
  std::vector<Vec2> section_m = {};
  double depth_m = 0;  ///< Length of the prism from the struck face.
  /// True if the depth is the thickness of the solid, so that the striker passes through.
  bool through = true;
  double slice_m = 0;   ///< Distance between cracks across the axis; 0: none.
  bool split = false;   ///< True if the prism breaks into a core and sectors around it.
  int rings = 0;        ///< Number of rings of sectors around the prism.
  double reach_m = 0;   ///< Outer radius of the rings, from the origin.
  double energy_J = 0;  ///< Energy for crushing and shearing.
  double mass_kg = 0;  ///< Mass of the solid within the striker's cross-section, through the depth.
  double solid_m = 0;  ///< Length of the path in the solid.
  double sides_m2 = 0;  ///< Area of the lateral surface of the hole.

  /// Width of the hole over that of the section. What is between the two is crushed.
  double clearance = 1;

  /// Returns the distance from the axis to the farthest corner of the section.
  double section_reach_m() const;
  /// True if a point, in the pattern's frame, is in the prism, or beyond its ends if `through`.
  bool contains(const Vec3& point_P) const;
  /// True if a point is in the hole beside the prism.
  bool crushes(const Vec3& point_P) const;
  /// Returns the approximate number of cells of the prism and its rings.
  int cell_count() const {
    const int slices = slice_m > 0 ? 1 + static_cast<int>(depth_m / slice_m) : 1;
    return slices * (1 + static_cast<int>(section_m.size()) *
                             (rings + (split ? 1 : 0) + (clearance > 1 ? 1 : 0)));
  }
};

/// All inputs of a break besides the structure: equal commands give equal pieces.
struct BreakCommand {
  /// Unique in a run, >= 1; part of the names of the planes that the break creates.
  std::uint64_t event = 1;
  std::uint64_t seed = 0;
  PatternSpec pattern;
  /// Linear map applied to the pattern before its pose; positive determinant.
  Mat3 stretch_P = Mat3::Identity();
  Pose X_RP;            ///< Pose of the pattern; its origin is the point of impact.
  double radius_m = 1;  ///< Radius of the impact sphere; infinity breaks the whole compound.
  Fit fit;              ///< Rule for fitting new convexes to their visual meshes.
  std::optional<Plug> plug = {};  ///< Replaces `pattern` if set.
  /// Unbreakable materials: the pattern does not cut their convexes.
  std::vector<MaterialIndex> unbreakable;
  /// Convexes smaller than this that overlap a convex of `unbreakable` are not cut either.
  double smallest_m3 = 0;
};

/// A face that a break exposed, in the rest frame R.
struct ExposedFace {
  std::uint32_t piece = 0;
  std::uint32_t convex = 0;  ///< Index in the piece's compound; in a BreakEdit possibly a slot.
  std::uint32_t face = 0;
  double area_m2 = 0;
  /// Material that cracked at the face: the convex's own, or, if that is unbreakable, the material
  /// of the convex that was bonded to it.
  MaterialIndex material;
};

/// The pieces of a broken compound. Each is one island; their volumes sum to the compound's.
struct BreakPlan {
  std::vector<Compound> pieces;
  /// Per piece, unless empty: true if the piece was crushed, so that it is debris of any size.
  std::vector<bool> crushed;
  double new_area_m2 = 0;  ///< Crack area; the two sides of a crack count once.
  std::vector<ExposedFace> exposed;
  /// Volume of parts that are too small for pieces and became debris.
  double debris_volume_m3 = 0;
  std::uint32_t untouched = 0;  ///< Number of convexes that are passed on unchanged.
  std::uint32_t welded = 0;     ///< Number of convexes that replaced parts in a cell.
  /// Number of convexes left whole because their parts did not sum to their volume.
  std::uint32_t failed = 0;
  double failed_m3 = 0;   ///< Volume of the convexes counted in `failed`.
  double clip_ms = 0;     ///< Wall time of cutting and welding; not part of the result.
  double islands_ms = 0;  ///< Wall time of grouping and finding islands; not part of the result.

  bool broke() const { return pieces.size() > 1; }
};

/// A yielding section between two parts of a structure that become separate bodies.
struct PlasticHinge {
  /// Numbered as in ExposedFace; the section's normal points from a to b.
  std::uint32_t piece_a = 0, piece_b = 0;
  PlasticSection section;
  /// Bonds from a convex of piece a to a convex of piece b, in this order.
  std::vector<Bond> bonds;
};

/// The changes that a break makes to a structure, and the loose pieces.
struct BreakEdit {
  /// Slots whose convexes were cut or belong to loose pieces; ascending.
  std::vector<ConvexSlot> removed;
  /// New convexes; they get the slots from the structure's slot_count() on, in this order.
  std::vector<ConvexPtr> added;
  std::vector<std::uint8_t> added_anchors;
  std::vector<Bond> bonds;  ///< Bonds of new convexes; a and b are slots.
  /// Ghosts of new convexes, with each other and with others; by slots.
  std::vector<Ghost> ghosts;
  /// The loose pieces, and the figures of the whole break. Exposed faces number loose piece p as p
  /// + 1 and the structure as 0; the convex of a face of the structure is a slot.
  BreakPlan loose;
  bool changed = false;  ///< True if pieces came loose; otherwise no member above is set.
  /// Bonds that no longer hold, by slots; they may be cut without loose pieces.
  std::vector<Bond> cut;
  /// Sections between loose pieces, or between them and the structure; not included in `cut`.
  std::vector<PlasticHinge> hinges;

  /// Returns the convex of a face of `loose.exposed`; `structure` is in the state before the edit.
  const Convex& exposed_convex(const Structure& structure, const ExposedFace& face) const {
    if (face.piece > 0) return *loose.pieces[face.piece - 1].convexes[face.convex];
    const std::uint32_t slots = structure.slot_count();
    return face.convex < slots ? *structure.convex(ConvexSlot(face.convex))
                               : *added[face.convex - slots];
  }
};

/// A force, or an impulse where so stated, on a convex of a structure, in the rest frame R.
struct AppliedForce {
  ConvexSlot convex;
  Vec3 force_N = Vec3::Zero();
  Vec3 point_R = Vec3::Zero();
  Vec3 torque_Nm = Vec3::Zero();  ///< Torque in addition to the moment of the force.
};

/// State of the stress solver for a structure, passed back in the next call; immutable and opaque.
class StressCache {
 public:
  virtual ~StressCache() = default;
  /// Returns, for each of some pieces of the structure, what a call about the piece needs of this;
  /// null: all of it.
  virtual std::vector<std::shared_ptr<const StressCache>> divide(
      std::span<const Structure* const> pieces) const {
    return std::vector<std::shared_ptr<const StressCache>>(pieces.size());
  }
};
using StressCachePtr = std::shared_ptr<const StressCache>;
/// Does nothing: only the breaker knows the type (Breaker::archive()).
inline void archive(Archive& /*bytes*/, StressCachePtr& /*memory*/) {}

/// An impact load: impulses that act in no time.
struct ImpulsiveLoad {
  std::span<const AppliedForce> impulses;  ///< In N s in place of N.
  /// Work that the impulses would do on the structure (impact_probe.h); infinite: no striker would
  /// move on with the structure.
  double energy_J = 0;
  Vec3 center_R = Vec3::Zero();  ///< Point of impact.
  double reach_m = 0;            ///< Radius that a break by pattern would have there.
  /// Work units for all calls about this impact together, as in LoadCase::most_work.
  std::uint64_t most_work = 0;
};

/// A steady load on a structure, and an optional impact load.
struct LoadCase {
  std::span<const Material> materials;  ///< By MaterialIndex.
  std::span<const AppliedForce> loads;  ///< Loads besides self-weight.
  Vec3 gravity_R = Vec3::Zero();
  /// Angular velocity in rad/s; used only for structures without anchors.
  Vec3 spin_R = Vec3::Zero();
  /// Approximate work units (bond evaluations) for this call; a few iterations are always made.
  std::uint64_t most_work = 0;
  /// Memory of this structure, or of the structure that it was a piece of; null at first.
  StressCachePtr memory;
  ImpulsiveLoad impulsive_load = {};  ///< Usually empty.
  /// Slots whose convexes are next to a plastic hinge, ascending: bonds between them and their
  /// neighbours do not yield again.
  std::vector<ConvexSlot> hinged = {};
};

/// Effect of an impact load before any bond breaks.
struct ImpulsiveStress {
  double local = 1;  ///< Share of the energy that stays within reach of the point of impact.
  double worst = 0;  ///< Highest stress over its limit.
  Vec3 worst_R = Vec3::Zero();  ///< Position of the highest stress.
};

/// Result of a load on a structure.
struct StressResult {
  BreakEdit edit;  ///< Cuts the bonds that failed; separated parts become loose pieces.
  /// Highest stress over its limit in what remains; <= 1, except for bonds that can only yield.
  double worst = 0;
  /// True if no further call is needed until the load or the structure changes.
  bool settled = false;
  std::uint64_t work = 0;  ///< Work units spent.
  StressCachePtr memory;   ///< Memory for the next call, about the structure or any of its pieces.
  ImpulsiveStress impulsive_stress;  ///< Set if there was an impact load.
  /// True if the work ran out before the stress of the impact load was known. A call with `memory`
  /// continues the solve.
  bool undecided = false;
  /// True if a solve did not converge and no call will continue it: the load breaks no bond beyond
  /// those in `edit`, although its stress is unknown.
  bool gave_up = false;
};

/// A section that has bent; one element per former bond, with its location in both structures.
struct BentSection {
  Vec3 centroid_A = Vec3::Zero(), centroid_B = Vec3::Zero();  ///< Centroid in either rest frame.
  /// Unit normal out of the structure, in either rest frame.
  Vec3 normal_A = Vec3::UnitX(), normal_B = -Vec3::UnitX();
  double reach_m = 0;  ///< Distance from the centroid to the farthest point of the section.
  std::vector<std::uint32_t> slots_a, faces_a, slots_b, faces_b;
  std::vector<double> areas_m2;
};

/// Two structures that were joined by sections which have bent.
struct BentPair {
  const Structure& a;
  const Structure& b;
  Pose X_AB;  ///< Pose of b's rest frame in a's.
  std::vector<BentSection> sections;
  std::uint64_t event = 1;  ///< As BreakCommand::event.
};

/// Result of merging two structures.
struct Rejoined {
  /// Edit of a that adds all convexes of b; nothing changes if the structures cannot be merged.
  BreakEdit edit;
  /// For each slot of b, the slot of its unchanged convex in a; none() if the slot has no convex or
  /// its convex was cut or extended.
  std::vector<ConvexSlot> slot_of_b;
};

/// Interface of fracture. All functions are const and may be called from any thread, for any
/// structure. Implemented by fracture/pattern_breaker.
class Breaker {
 public:
  virtual ~Breaker() = default;
  /// Returns the command for an impact. `convex` is the one struck, `materials` are by
  /// MaterialIndex, `event` is unique in a run and at least 1, and `seed` determines all random
  /// choices.
  virtual BreakCommand command(const Convex& convex, std::span<const Material> materials,
                               const StructureImpact& hit, std::uint64_t event,
                               std::uint64_t seed) const = 0;
  /// Computes the break of a command, at a cost that depends on the convexes in its reach; the
  /// structure stays unchanged. A pattern that misses all convexes changes nothing.
  virtual BreakEdit plan(const Structure& structure, const BreakCommand& command) const = 0;
  /// Called for every plan() that is applied.
  virtual void on_applied(const BreakPlan& /*plan*/) const {}
  /// Returns the bonds of a non-empty structure that a steady load breaks, by the stress in
  /// equilibrium with the load; spends about `load.most_work`.
  virtual StressResult stress(const Structure& structure, const LoadCase& load) const = 0;
  /// Writes or reads a memory that stress() has returned; may be null.
  virtual void archive(Archive& /*bytes*/, StressCachePtr& /*memory*/) const {
    throw InputError("the state of this breaker cannot be saved");
  }
  /// Returns for each slot the highest stress over its limit among the bonds of its convex;
  /// negative if it has none. For debug views; does not affect the simulation.
  virtual std::vector<float> utilisation(const Structure& /*structure*/,
                                         const LoadCase& /*load*/) const {
    return {};
  }
  /// Merges two structures that have bent against each other: both end in the plane midway between
  /// them, and b's convexes are transformed into a's rest frame. Mass is conserved.
  virtual Rejoined rejoin(const BentPair& /*bent*/) const { return {}; }
};

}  // namespace sunder
