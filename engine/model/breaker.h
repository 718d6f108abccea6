// The seam between the world, which decides whether a solid breaks, and fracture, which decides
// into what.
//
// By an impact, a structure breaks in three steps (engine/world/break/break_stage.cpp):
//
//   BreakCommand command = breaker.command(convex, materials, hit, event, seed);
//   BreakEdit edit = breaker.plan(structure, command);   // nothing has changed yet
//   if (edit.changed && /* the energy is there */) structure.apply(edit);
//
// The command says all that matters besides the structure, so it may be kept, written to a file and
// carried out again; the energy of the hit chooses the pattern, not whether it breaks. The plan is
// weighed against the work the hit can do: `edit.loose.new_area_m2` is what the crack costs. Plans
// that are dropped leave no trace, and any number are made at once. Of a plan that is carried out,
// `edit.loose.pieces` are compounds of their own: each becomes a Structure, unless it is debris.
//
// By a steady load, it breaks in two (engine/world/load/load_stage.cpp), whenever load or bonds
// have changed:
//
//   StressAnswer answer =
//       breaker.stress(structure, {materials, loads, gravity_R, spin_R, work, memory});
//   structure.apply(answer.edit);                         // bonds may go where nothing comes off
//   memory = answer.memory;
//
// and asks again in the next step until `answer.settled`: the work of one call is bounded. The
// memory is what makes asking again cheap. It belongs with the structure, goes to each of its
// pieces as it is, and may be dropped at any time: the answer then costs more, and is the same
// within the tolerance of the solve.
//
// A blow is asked about in both ways: as a command, and with `load.blow` set, which cuts the bonds
// that the blow overloads (engine/world/break/planned_break.cpp).
//
// An edit is for the structure that it was asked of, as it was then, and is applied once.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "engine/model/section.h"
#include "engine/model/structure.h"

namespace sunder {

/// An impact on a structure, in its rest frame R.
struct Hit {
  Vec3 point_R = Vec3::Zero();
  Vec3 direction_R = Vec3::UnitY();  ///< Unit, the way the impact pushes (into the solid).
  ConvexSlot convex;                 ///< That was hit.
  double energy_J = 0;               ///< That the solid would have to take up.
  double speed_m_s = 0;              ///< Closing speed of the striker; 0: not known.
  double striker_kg = 0;             ///< Effective mass of the striker.
  double thickness_m = 0;            ///< Of the solid along `direction_R` behind the point.
  double volume_m3 = 0;              ///< Of the solid,
  double reached_m3 = 0;             ///< and of its convexes within the impact radius.
  bool held = true;                  ///< The solid is anchored.
  bool confined = true;              ///< The solid goes on around the striker's section.
  bool narrow = true;                ///< That is no wider than a break by pattern.
  /// Corners of the striker's cross-section, in order about `direction_R` through `point_R`; empty
  /// if it is not known.
  std::vector<Vec3> section_R = {};
};

/// A prism that a striker narrower than the solid drives out of it, or into it, with its sides
/// parallel to the axis y of the pattern's frame, and the rings of cracks around it.
struct Plug {
  /// Convex cross-section about the origin, in (x, z) and counter-clockwise.
  std::vector<Vec2> section_m = {};
  double depth_m = 0;   ///< From the struck face to where the pieces end.
  bool through = true;  ///< The depth is the thickness of the solid: the striker goes on.
  double slice_m = 0;   ///< Distance of cracks across the axis; 0: none.
  bool split = false;   ///< The prism comes out as a core and sectors around it.
  int rings = 0;        ///< Rings of sectors around the prism, out to `reach_m` from the origin.
  double reach_m = 0;
  double energy_J = 0;  ///< That crushing and shearing take.
  double mass_kg = 0;   ///< Of the striker's section through the depth.
  double solid_m = 0;   ///< Thickness of the solid.
  double sides_m2 = 0;  ///< Area of the prism's sides.

  /// Distance from the axis to the farthest corner of the section.
  double section_reach_m() const;
  /// True for points, in the pattern's frame, in the prism, or beyond its ends if it goes through.
  bool contains(const Vec3& point_P) const;
  /// Number of cells of the prism and its rings, about.
  int cell_count() const {
    const int slices = slice_m > 0 ? 1 + static_cast<int>(depth_m / slice_m) : 1;
    return slices * (1 + static_cast<int>(section_m.size()) * (rings + (split ? 1 : 0)));
  }
};

/// Everything a break depends on besides the compound: the same command gives the same pieces.
struct BreakCommand {
  std::uint64_t event = 1;  ///< Unique in a run, >= 1; names the planes the break makes.
  std::uint64_t seed = 0;
  PatternSpec pattern;
  Mat3 stretch_P = Mat3::Identity();  ///< Deforms the pattern first; of positive determinant.
  Pose X_RP;                          ///< Pose of the pattern; its origin is the impact.
  double radius_m = 1;                ///< Of the impact sphere; infinity breaks the whole compound.
  Fit fit;                            ///< How new convexes are fitted to their visual meshes.
  std::optional<Plug> plug = {};      ///< Takes the place of `pattern` if there is one.
  /// Materials that do not break: the pattern leaves their convexes whole.
  std::vector<MaterialIndex> spared;
  double smallest_m3 = 0;  ///< What is smaller, and overlaps such a convex, is left whole as well.
};

/// A face that a break laid bare, in the rest frame R.
struct ExposedFace {
  std::uint32_t piece = 0;
  std::uint32_t convex = 0;  ///< Index in that piece's compound; in a BreakEdit maybe a slot.
  std::uint32_t face = 0;
  double area_m2 = 0;
  /// That cracked there: the convex's own; where a break spared that, what it was bonded to.
  MaterialIndex material;
};

/// What a compound becomes. Pieces are islands (connected); volumes sum to the parent's.
struct BreakPlan {
  std::vector<Compound> pieces;
  double new_area_m2 = 0;  ///< Crack surface, both sides counted once.
  std::vector<ExposedFace> exposed;
  double debris_volume_m3 = 0;  ///< Under the volume floor: mass that became debris.
  std::uint32_t untouched = 0;  ///< Convexes handed on as they were.
  std::uint32_t welded = 0;     ///< Cells that became one convex.
  std::uint32_t failed = 0;     ///< Convexes left whole because their parts did not add up,
  double failed_m3 = 0;         ///< and their volume.
  double clip_ms = 0;           ///< Wall time of cutting and welding,
  double islands_ms = 0;        ///< and of grouping and finding islands; no part of the result.

  bool broke() const { return pieces.size() > 1; }
};

/// Two parts of what an edit leaves that go on as bodies of their own, held together by a section
/// that flows.
struct PlasticHinge {
  std::uint32_t piece_a = 0, piece_b = 0;  ///< As exposed faces name them; its normal leads to b.
  PlasticSection section;
  std::vector<Bond> bonds;  ///< Of a convex of piece a and one of piece b, in this order.
};

/// What a break does to a structure, and what comes off it.
struct BreakEdit {
  std::vector<ConvexSlot> removed;  ///< Whose convexes were cut or came off; ascending.
  /// Convexes that take new slots, in this order from the structure's slot_count() on.
  std::vector<ConvexPtr> added;
  std::vector<std::uint8_t> added_anchors;
  std::vector<Bond> bonds;    ///< Contacts of added convexes: a and b are slots.
  std::vector<Ghost> ghosts;  ///< Of added convexes, and of them with others, by slots.
  /// The pieces that came off, and the figures of the whole break. Exposed faces name piece p as
  /// p + 1; 0 is the structure, and their convex a slot of it.
  BreakPlan loose;
  bool changed = false;   ///< Something came off; otherwise nothing above is set.
  std::vector<Bond> cut;  ///< Contacts that hold no longer, by slots; also where nothing came off.
  /// Between what came off, and it and what is left; their bonds are not in `cut`.
  std::vector<PlasticHinge> hinges;

  /// The convex of a face of `loose.exposed`; of `structure` as it was before the edit.
  const Convex& exposed_convex(const Structure& structure, const ExposedFace& face) const {
    if (face.piece > 0) return *loose.pieces[face.piece - 1].convexes[face.convex];
    const std::uint32_t slots = structure.slot_count();
    return face.convex < slots ? *structure.convex(ConvexSlot(face.convex))
                               : *added[face.convex - slots];
  }
};

/// A force on a convex of a structure, in its rest frame R.
struct Load {
  ConvexSlot convex;
  Vec3 force_N = Vec3::Zero();
  Vec3 point_R = Vec3::Zero();
  Vec3 torque_Nm = Vec3::Zero();  ///< Besides that of the force.
};

/// What a breaker knows of a structure under load and wants back when it is asked again; only it
/// knows what is inside. Never changed once made.
class StressMemory {
 public:
  virtual ~StressMemory() = default;
};
using StressMemoryPtr = std::shared_ptr<const StressMemory>;

/// What hits a structure within no time.
struct Blow {
  std::span<const Load> impulses;  ///< N·s in place of N.
  double energy_J = 0;             ///< The work that they would do on it: see break_probe.h;
                                   ///< infinite: nothing strikes that would move on with it.
  Vec3 center_R = Vec3::Zero();    ///< Where it lands,
  double reach_m = 0;              ///< and what a break by pattern would reach from there.
  std::uint64_t most_work = 0;     ///< As LoadCase::most_work, of all answers to it together.
};

/// The steady load on a structure, and what hits it besides.
struct LoadCase {
  std::span<const Material> materials;  ///< By MaterialIndex.
  std::span<const Load> loads;          ///< Besides its own weight.
  Vec3 gravity_R = Vec3::Zero();
  Vec3 spin_R = Vec3::Zero();  ///< Angular velocity, rad/s; of what nothing anchors.
  /// To spend on the answer, in visits of bonds, about: a few iterations are made in any case.
  std::uint64_t most_work = 0;
  StressMemoryPtr memory;  ///< Of this structure, or of what it was a piece of; null at first.
  Blow blow = {};          ///< None, as a rule.
  /// Whose convexes are beside a hinge already, ascending: what holds them does not flow again.
  std::vector<ConvexSlot> hinged = {};
};

/// What a blow amounts to, before anything gives way.
struct BlowStress {
  double local = 1;             ///< Share of its energy that stays within reach of where it lands.
  double worst = 0;             ///< Highest stress, in parts of the limit,
  Vec3 worst_R = Vec3::Zero();  ///< and where.
};

/// What becomes of a structure under a load.
struct StressAnswer {
  BreakEdit edit;  ///< Bonds that were too weak are cut; what they held comes off.
  /// Highest stress in what is left, in parts of the limit; <= 1, but where what yields can let
  /// nothing come loose.
  double worst = 0;
  bool settled = false;    ///< Nothing is left to do until the load, or the compound, changes.
  std::uint64_t work = 0;  ///< Spent.
  StressMemoryPtr memory;  ///< For the next time, of any of the pieces.
  BlowStress blow;         ///< If there was one.
  /// The work was spent before the stress of the blow was known. Asked again with `memory`, the
  /// solve goes on from there.
  bool undecided = false;
};

/// A section that has bent: per bond that it had, where it is in two structures.
struct BentSection {
  Vec3 centroid_A = Vec3::Zero(), centroid_B = Vec3::Zero();  ///< In either rest frame,
  Vec3 normal_A = Vec3::UnitX(), normal_B = -Vec3::UnitX();   ///< unit, out of either.
  double reach_m = 0;  ///< From the centroid to what is farthest in it.
  std::vector<std::uint32_t> slots_a, faces_a, slots_b, faces_b;
  std::vector<double> areas_m2;
};

/// Two structures that sections held together while they bent.
struct BentPair {
  const Structure& a;
  const Structure& b;
  Pose X_AB;  ///< Of b's rest frame in a's.
  std::vector<BentSection> sections;
  std::uint64_t event = 1;  ///< As of a BreakCommand.
};

/// Both as one.
struct Rejoined {
  BreakEdit edit;  ///< Of a, which takes in all of b; nothing changes if they stay two.
  /// Per slot of b, where its convex is now in a; none() if it has none, or ends otherwise.
  std::vector<ConvexSlot> slot_of_b;
};

/// Decides what breaks. Pure and const: any thread may ask about any structure.
class Breaker {
 public:
  virtual ~Breaker() = default;
  /// The command that an impact amounts to; `convex` is the one hit, `materials` by MaterialIndex.
  /// `event` is unique in a run and at least 1, and `seed` all that is random.
  virtual BreakCommand command(const Convex& convex, std::span<const Material> materials,
                               const Hit& hit, std::uint64_t event, std::uint64_t seed) const = 0;
  /// Carries a command out, at a cost that depends on what it reaches; the structure stays as it
  /// is. A pattern that misses changes nothing.
  virtual BreakEdit plan(const Structure& structure, const BreakCommand& command) const = 0;
  /// Told of every break that is carried out, as plan() had it.
  virtual void note_carried_out(const BreakPlan& /*plan*/) const {}
  /// Which bonds of a structure, that is not empty, a steady load breaks, judged by the stress that
  /// balances it; spends about `load.most_work`.
  virtual StressAnswer stress(const Structure& structure, const LoadCase& load) const = 0;
  /// Per slot of a structure, how much a steady load makes of what the worst bond of its convex
  /// bears; negative where there is none. Nothing comes of it: it is for who looks inside.
  virtual std::vector<float> utilisation(const Structure& /*structure*/,
                                         const LoadCase& /*load*/) const {
    return {};
  }
  /// Makes one structure of two that have bent against each other: both end midway between them,
  /// and b's convexes are moved into a's rest frame. Mass is kept.
  virtual Rejoined rejoin(const BentPair& /*bent*/) const { return {}; }
};

}  // namespace sunder
