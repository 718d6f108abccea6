// The blocks of a step, whatever their lanes.
#pragma once

#include <cstdint>
#include <memory>

#include "solver/rigid/contact/prepare.h"

namespace sunder::solver {

/// What the impulses of a step did.
struct ContactWork {
  double normal_J = 0;    ///< Work of normal impulses, on both bodies.
  double friction_J = 0;  ///< Work of friction, on both bodies.
  double drive_J = 0;     ///< Work of kinematic bodies, on others.
  double allowed_Ns = 0;  ///< Friction that Coulomb's law allows,
  double excess_Ns = 0;   ///< and friction beyond that.
};

/// Manifolds cut into blocks of so many lanes. How many changes no result: manifolds of one block
/// share no body (or are split), and a lane never sees its neighbours.
class ContactBlocks {
 public:
  virtual ~ContactBlocks() = default;

  virtual std::uint32_t lanes() const = 0;
  virtual std::uint32_t size() const = 0;
  /// Takes all out; about so many manifolds will be added.
  virtual void clear(std::size_t manifolds) = 0;
  /// Appends blocks of the `count` manifolds from `first` of those to solve.
  virtual void add(std::uint32_t first, std::uint32_t count, bool split) = 0;

  // What is done to blocks [begin, end); those of one stage in any order on any thread.
  virtual void prepare(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual void warm_start(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual void sweep_biased(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual void sweep_relaxed(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  /// To be called once a substep, after the last sweep.
  virtual void sum_impulses(std::uint32_t begin, std::uint32_t end) = 0;
  /// To be called after it: see sweep.h.
  virtual void scale_impulses(std::uint32_t begin, std::uint32_t end,
                              const float* share_of_row) = 0;
  virtual void note_spin(std::uint32_t begin, std::uint32_t end, const ContactStep& step,
                         const float* share_of_row) = 0;
  /// Makes room for arms that follow the bodies (see sweep.h), once all blocks are added; or does
  /// without.
  virtual void follow_bodies(bool wanted) = 0;
  virtual void follow(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual void settle(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  /// Makes room for what conjugate gradients remember, once all blocks are added.
  virtual void remember() = 0;
  // Conjugate gradients, of blocks that are not split (see sweep.h). `energy` is by manifold.
  virtual void mark(std::uint32_t begin, std::uint32_t end) = 0;
  virtual void measure(std::uint32_t begin, std::uint32_t end, float* energy) const = 0;
  virtual void go_on(std::uint32_t begin, std::uint32_t end, const ContactStep& step,
                     float beta) = 0;
  /// False if nothing was struck.
  virtual bool strike(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  /// Makes room for what impacts need, once all blocks are added, of so many manifolds.
  virtual void expect_impacts(std::size_t manifolds) = 0;
  // Of blocks near an impact, which are not split (see sweep.h).
  virtual void prepare_impact(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual bool meet(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual void begin_impact(std::uint32_t begin, std::uint32_t end) = 0;
  /// Of `count` manifolds of one colour from `first` of those to solve.
  virtual bool pass_on(std::uint32_t first, std::uint32_t count, const ContactStep& step,
                       const ImpactSweep& sweep) = 0;
  virtual void end_impact(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;
  virtual void store(std::uint32_t begin, std::uint32_t end, const ContactStep& step) = 0;

  /// On bodies, over the step, from what cannot move.
  virtual Vec3 outside_impulse_Ns() const = 0;
  /// After store().
  virtual ContactWork work() const = 0;
};

/// As many lanes as asked for or fewer: 1, 4, 8 or 16, as far as this processor has them. 0: the
/// most it has.
std::unique_ptr<ContactBlocks> make_contact_blocks(int most_lanes);

}  // namespace sunder::solver
