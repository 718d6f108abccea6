// Contacts take kinetic energy or leave it, but the few sweeps of a substep may make some. Here the
// bodies that touch each other, group by group, are held to what they had: see docs/decisions/029.
#pragma once

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/step_context.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/contact/kernels/constraint_block.h"

namespace sunder::solver {

class EnergyGuard {
 public:
  using Pair = std::pair<BodySlot, BodySlot>;

  /// Groups the awake bodies of these manifolds, and of these pairs in joints. What hangs in joints
  /// and touches nothing is left alone, and so is what kinematic bodies do work on, by contacts or,
  /// if it is `carried`, by joints; where nothing moves fast, all are.
  void collect(const StepContext& step, std::span<const ManifoldSlot> manifolds,
               std::span<const BodySlot> active, std::span<const Pair> joined,
               std::span<const BodySlot> carried, const Bodies& bodies, const Contacts& contacts);
  /// Whether any group is watched in this step.
  bool watches() const { return watches_; }

  /// Whether it is in free fall, with all that it touches.
  bool falls(BodySlot body) const { return falls_[body] != 0; }
  /// Before the strikes of a substep.
  void weigh_base(BodySlot body, float inverse_mass, const BodyRow& row);
  /// What strikes, and the other impulses of a substep, did to the energy of a body.
  void weigh(BodySlot body, float inverse_mass, const BodyRow& row);
  /// Finds the shares of their impulses that groups may keep so that their energy is not more than
  /// it was before.
  void judge(std::span<const BodySlot> active);
  /// Whether some group has to give some of its impulses back.
  bool objects() const { return objects_; }
  /// Of the impulses on a body; as row_of().
  const float* share_of_row() const { return share_.data(); }

  /// After the last substep: a body turns on with its angular momentum, which adds this to its
  /// energy; or else with its energy. It may ask for what contacts took from itself, and for a spin
  /// of no more energy than its whole motion had or has.
  void ask(BodySlot body, double made_J, float inverse_mass, const BodyRow& row);
  void decide(std::span<const BodySlot> active);
  /// Whether its group can pay that, and what others of it ask, with what its contacts took.
  bool grants(BodySlot body) const;

 private:
  /// Energy of a share s of the impulses: s·first + s²·second.
  struct Work {
    double first = 0, second = 0;
    double struck_J = 0;  ///< By strikes, in the substep.
    double made_J = 0;    ///< Of a group, or of a body by contacts: in the step so far.
    double asked_J = 0;   ///< Infinite: too much.
  };

  void leave_alone_what_is_carried(std::span<const ManifoldSlot> manifolds,
                                   std::span<const BodySlot> by_joints,
                                   std::span<const BodySlot> active, const Bodies& bodies,
                                   const Contacts& contacts);
  void leave_alone_what_swings_free(std::span<const ManifoldSlot> manifolds,
                                    std::span<const BodySlot> active, std::span<const Pair> joined,
                                    const Contacts& contacts);

  bool watches_ = false, objects_ = false;
  ByBody<BodySlot> group_;  ///< Of awake bodies in contact, by its least; none: not watched.
  ByBody<std::uint8_t> falls_;
  ByBody<Work> of_body_, of_group_;
  std::vector<float> share_;
};

}  // namespace sunder::solver
