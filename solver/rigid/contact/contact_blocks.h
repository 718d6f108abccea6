// The constraint blocks of a step, behind an interface for any number of lanes.
#pragma once

#include <cstdint>
#include <memory>

#include "solver/rigid/contact/prepare.h"

namespace sunder::solver {

/// Work of the impulses of a step.
struct ContactWork {
  double normal_J = 0;    ///< Work of normal impulses on both bodies.
  double friction_J = 0;  ///< Work of friction on both bodies.
  double drive_J = 0;     ///< Work of kinematic bodies on others.
  double allowed_Ns = 0;  ///< Friction impulse that Coulomb's law allows.
  double excess_Ns = 0;   ///< Friction impulse beyond the allowed one.
};

/// Manifolds in blocks of lanes(). The number of lanes changes no result: the manifolds of a block
/// share no body (or are split), and no lane reads another.
class ContactBlocks {
 public:
  virtual ~ContactBlocks() = default;

  /// Returns blocks of as many lanes, without any manifolds: they hold nothing between solves.
  virtual std::unique_ptr<ContactBlocks> copy() const = 0;
  virtual std::uint32_t lanes() const = 0;
  virtual std::uint32_t size() const = 0;
  /// Removes all blocks; `manifolds` is about the number that will be added.
  virtual void clear(std::size_t manifolds) = 0;
  /// Appends blocks of `count` manifolds from index `first` of the list to solve.
  virtual void add(std::uint32_t first, std::uint32_t count, bool split) = 0;

  // Operations on blocks [begin, end). The blocks of a stage may run in any order and on any
  // thread.
  virtual void prepare(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual void warm_start(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual void sweep_biased(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual void sweep_relaxed(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  /// Must be called once a substep, after the last sweep.
  virtual void sum_impulses(std::uint32_t begin, std::uint32_t end) = 0;
  /// Must be called after sum_impulses(): see sweep.h.
  virtual void scale_impulses(std::uint32_t begin, std::uint32_t end,
                              const float* scale_of_row) = 0;
  virtual void record_spin_change(std::uint32_t begin, std::uint32_t end, const ContactStep& step,
                                  const float* scale_of_row) = 0;
  /// Allocates lever arms that follow the bodies (see sweep.h), or none. Must be called after all
  /// blocks are added.
  virtual void allocate_arms(bool wanted) = 0;
  virtual void update_arms(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual void apply_arm_change(std::uint32_t begin, std::uint32_t end,
                                const ContactStep& step) = 0;
  /// Allocates the state of conjugate gradients. Must be called after all blocks are added.
  virtual void allocate_search() = 0;
  // Conjugate gradients, for blocks that are not split (see sweep.h). `energy` is by manifold.
  virtual void save_impulses(std::uint32_t begin, std::uint32_t end) = 0;
  virtual void find_change_energy(std::uint32_t begin, std::uint32_t end, float* energy) const = 0;
  virtual void step_along_direction(std::uint32_t begin, std::uint32_t end, const ContactStep& step,
                                    float beta) = 0;
  /// Returns false if no contact rebounded.
  virtual bool apply_restitution(std::uint32_t begin, std::uint32_t end,
                                 const ContactStep& step) = 0;
  /// Allocates the state of impacts for a number of manifolds. Must be called after all blocks are
  /// added.
  virtual void allocate_impacts(std::size_t manifolds) = 0;
  // Operations on blocks near an impact, which are not split (see sweep.h).
  virtual void prepare_impact(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual bool find_gaps(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual void extract_contacts(std::uint32_t begin, std::uint32_t end) = 0;
  /// Sweeps `count` manifolds of one colour from index `first` of the list to solve.
  virtual bool propagate(std::uint32_t first, std::uint32_t count, const ContactStep& step,
                         const ImpactSweep& sweep) = 0;
  virtual void apply_propagation(std::uint32_t begin, std::uint32_t end,
                                 const ContactStep& step) = 0;
  virtual void store(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;

  /// Impulse on bodies, over the step, from those that cannot move.
  virtual Vec3 outside_impulse_Ns() const = 0;
  /// Valid after store().
  virtual ContactWork work() const = 0;
};

/// Makes blocks of 1, 4, 8 or 16 lanes: at most `most_lanes`, and as many as the processor has
/// instructions for; 0: the latter.
std::unique_ptr<ContactBlocks> make_contact_blocks(int most_lanes);

}  // namespace sunder::solver
