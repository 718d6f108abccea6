// One level of the stress solve: nodes with six degrees of freedom, joined by springs that resist
// displacement alike in all directions, and rotation.
//
// Two facts keep a level small. Where the springs of a node have their centre, a push does not turn
// it: with its place there, the node's own block of the stiffness matrix is a number and a 3×3
// matrix. And springs side by side between two rigid things are exactly one spring at their centre:
// so a coarser level, whose nodes are groups that move as one, is a level of the same kind.
#pragma once

#include <cstdint>
#include <vector>

#include "fracture/quad.h"

namespace sunder::fracture {

/// A spring between two nodes, or a node and the world.
struct Spring {
  static constexpr std::uint32_t kWorld = 0xffffffff;
  std::uint32_t a = kWorld, b = kWorld;
  Vec3 place = Vec3::Zero();  ///< Where it acts.
  double stretch_N_m = 0;     ///< The same in all directions.
  Mat3 turn = Mat3::Zero();   ///< N·m/rad, symmetric.
};

/// Per node, and one more for the world, which is zero.
template <class Real>
using Nodal = std::vector<Six<Real>>;

/// `Real` is float or double.
template <class Real>
class SpringLevel {
 public:
  /// Every node has a spring.
  SpringLevel(std::size_t nodes, std::vector<Spring> springs);

  std::size_t size() const { return places_.size(); }
  const std::vector<Spring>& springs() const { return springs_; }
  /// The centre of a node's springs: its displacement and torque are about there.
  const Vec3& place(std::size_t node) const { return places_[node]; }
  Nodal<Real> zero() const { return Nodal<Real>(size() + 1); }

  /// y = K x
  void multiply(const Nodal<Real>& x, Nodal<Real>& y) const;
  /// y = f − K x
  void residual(const Nodal<Real>& f, const Nodal<Real>& x, Nodal<Real>& y) const;
  /// x = or += factor · D⁻¹ r, D the nodes' own blocks of K.
  void relax(Real factor, const Nodal<Real>& r, Nodal<Real>& x, bool add) const;

  /// Groups of about `size` neighbouring nodes as the nodes of a coarser level, for the two below.
  SpringLevel coarsen(std::size_t size);
  /// Forces on nodes as forces on groups.
  void restrict_to(const Nodal<Real>& forces, Nodal<Real>& sums) const;
  /// Adds `factor` times the groups' rigid motions to the nodes.
  void prolong(Real factor, const Nodal<Real>& motions, Nodal<Real>& x) const;

 private:
  /// A spring made ready to be multiplied. Its stretch is the fourth lane of turn.diagonal.
  struct Link {
    std::uint32_t a = 0, b = 0;  ///< The world is the number after the last node.
    Quad<Real> arm_a, arm_b;
    Symmetric<Real> turn;
  };
  /// Links that reach into one run of nodes; those between two runs are in both.
  struct Run {
    std::uint32_t begin = 0, end = 0;
    std::vector<Link> links;
  };

  void place_nodes();
  void make_runs();
  void invert_blocks();
  template <class Start>
  void apply(const Nodal<Real>& x, Nodal<Real>& y, Real sign, const Start& start) const;

  std::vector<Vec3> places_;
  std::vector<Spring> springs_;
  std::vector<Run> runs_;
  std::vector<Symmetric<Real>>
      inverse_;                       ///< Of D's turns; the fourth lane of diagonal is of its push.
  std::vector<Quad<Real>> arms_;      ///< Per node: from the place of its group.
  std::vector<std::uint32_t> group_;  ///< Per node: its node on the next coarser level.
};

}  // namespace sunder::fracture
