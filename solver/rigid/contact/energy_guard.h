// Energy guard. Contacts never increase kinetic energy, but the few sweeps of a substep may do so.
// The guard scales the impulses of each group of touching bodies so that the group's energy does
// not rise: docs/decisions/029.
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

  /// Groups the awake bodies of these manifolds and jointed pairs. Excludes bodies that hang in
  /// joints and touch nothing, and groups that kinematic bodies do work on, by contacts or, for
  /// bodies in `driven`, by joints. Excludes all if no body is fast.
  void collect(const StepContext& step, std::span<const ManifoldSlot> manifolds,
               std::span<const BodySlot> active, std::span<const Pair> joined,
               std::span<const BodySlot> driven, const Bodies& bodies, const Contacts& contacts);
  /// True if the guard is active in this step.
  bool is_active() const { return is_active_; }

  /// True if the body is in free fall with all bodies that it touches.
  bool is_in_free_fall(BodySlot body) const { return in_free_fall_[body] != 0; }
  /// Records the energy of a body before the restitution impulses of a substep.
  void record_energy_before(BodySlot body, float inverse_mass, const BodyRow& row);
  /// Records the work of the restitution impulses and of the other impulses of a substep on a body.
  void record_impulse_work(BodySlot body, float inverse_mass, const BodyRow& row);
  /// Finds the factors of their impulses with which the energy of groups is not above that before.
  void find_impulse_scales(std::span<const BodySlot> active);
  /// True if the impulses of some group must be scaled.
  bool needs_scaling() const { return needs_scaling_; }
  /// Scale of the impulses on a body, by row_of().
  const float* scale_of_row() const { return scale_.data(); }

  /// Requests energy for a body, after the last substep: keeping its angular momentum would add
  /// `gained_J`, otherwise it keeps its energy. The request is refused unless `gained_J` is at most
  /// the energy that contacts took from the body, or the rotation would then have at most the
  /// energy of the whole motion, now or when the step began.
  void request_rotation_energy(BodySlot body, double gained_J, float inverse_mass,
                               const BodyRow& row);
  /// Adds up the requests of each group.
  void sum_requests(std::span<const BodySlot> active);
  /// True if the body may keep its angular momentum: the energy that contacts took from its group
  /// covers all requests of the group.
  bool may_keep_angular_momentum(BodySlot body) const;

 private:
  /// Work of a scale s of the impulses: s·first + s²·second.
  struct Work {
    double first = 0, second = 0;
    double restitution_J = 0;  ///< Work of restitution in the substep.
    /// Energy gained in the step so far, of a group, or of a body by contacts.
    double gained_J = 0;
    double requested_J = 0;  ///< Requested energy; infinite: too much.
  };

  void exclude_driven(std::span<const ManifoldSlot> manifolds, std::span<const BodySlot> by_joints,
                      std::span<const BodySlot> active, const Bodies& bodies,
                      const Contacts& contacts);
  void exclude_free_hanging(std::span<const ManifoldSlot> manifolds,
                            std::span<const BodySlot> active, std::span<const Pair> joined,
                            const Contacts& contacts);

  bool is_active_ = false, needs_scaling_ = false;
  /// Group of an awake body in contact, by its lowest body; none: excluded.
  ByBody<BodySlot> group_;
  ByBody<std::uint8_t> in_free_fall_;
  ByBody<Work> of_body_, of_group_;
  std::vector<float> scale_;
};

}  // namespace sunder::solver
