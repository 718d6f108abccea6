// One level of the stress solve: nodes with six degrees of freedom, joined by springs that resist
// displacement alike in all directions, and rotation.
//
// Two facts keep a level small. Where the springs of a node have their centre, a force does not
// rotate it: with its place there, the node's own block of the stiffness matrix is a number and a
// 3×3 matrix. And springs side by side between two rigid things are exactly one spring at their
// centre: so a coarser level, whose nodes are groups that move as one, is a level of the same kind.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <vector>

#include "fracture/stress/simd4.h"

namespace sunder::fracture {

/// A spring between two nodes, or a node and the world.
struct Spring {
  static constexpr std::uint32_t kWorld = 0xffffffff;
  std::uint32_t a = kWorld, b = kWorld;
  Vec3 place = Vec3::Zero();        ///< Where it acts.
  double stretch_N_m = 0;           ///< The same in all directions.
  Mat3 rotation_Nm = Mat3::Zero();  ///< Stiffness to rotation, N·m/rad; symmetric.
};

/// Per node, and one more for the world, which is zero.
template <class Real>
using Nodal = std::vector<Six<Real>>;

/// What an edit does to the nodes of a level, and the springs that nodes have then that it does
/// anything to.
struct SpringEdit {
  enum class Change : std::uint8_t {
    kNone,
    kSprings,  ///< All its springs go, or are among `springs`.
    kNew,      ///< And it stands for something else than before.
  };
  std::vector<Change> changes;  ///< Per node; there may be more than before.
  std::vector<Spring> springs;  ///< Each has an end that changes.

  bool is_at(std::uint32_t node) const {
    return node != Spring::kWorld && changes[node] != Change::kNone;
  }
  bool is_at(const Spring& spring) const { return is_at(spring.a) || is_at(spring.b); }
};

/// Nodes and springs, and their stiffness matrix K; `Real` is float or double.
template <class Real>
class SpringLevel {
 public:
  /// Nodes without a spring are at rest.
  SpringLevel(std::size_t nodes, std::vector<Spring> springs);
  /// Another level after an edit, at a cost that depends on what that changes: the rest is shared.
  SpringLevel(const SpringLevel& old, const SpringEdit& edit);

  /// Nodes.
  std::size_t size() const { return places_.size(); }
  bool has_springs(std::uint32_t node) const { return inverse_[node].diagonal[3] > 0; }
  /// Calls `use` with each spring once.
  template <class Use>
  void for_each_spring(const Use& use) const {
    for_springs_in(std::vector<std::uint8_t>(runs_.size(), 1), use);
  }
  /// Calls `use` once with each spring at the nodes that `is_in`, and with others near them.
  template <class IsIn, class Use>
  void for_springs_near(const IsIn& is_in, const Use& use) const {
    std::vector<std::uint8_t> looked_at(runs_.size(), 0);
    for (std::uint32_t i = 0; i < size(); ++i) {
      if (is_in(i)) looked_at[i / kRun] = 1;
    }
    for_springs_in(looked_at, use);
  }
  /// The centre of a node's springs: its displacement and torque are about there.
  const Vec3& place(std::size_t node) const { return places_[node]; }
  /// Of the level's size.
  Nodal<Real> zero() const { return Nodal<Real>(size() + 1); }

  /// y = K x
  void multiply(const Nodal<Real>& x, Nodal<Real>& y) const;
  /// y = f − K x
  void residual(const Nodal<Real>& f, const Nodal<Real>& x, Nodal<Real>& y) const;
  /// x = or += factor · D⁻¹ r, D the nodes' own blocks of K.
  void relax(Real factor, const Nodal<Real>& r, Nodal<Real>& x, bool add) const;

 private:
  /// A spring made ready to be multiplied. Its stretch is the fourth lane of rotation.diagonal.
  struct Link {
    std::uint32_t a = 0, b = 0;  ///< The world is the greatest number.
    Simd4<Real> arm_a, arm_b;
    Symmetric<Real> rotation;
  };
  /// Springs that reach into one run of nodes; those between two runs are in both.
  struct Run {
    std::uint32_t begin = 0, end = 0;
    std::vector<Spring> springs;
    std::vector<Link> links;            ///< Of the springs.
    std::vector<std::uint32_t> beside;  ///< The runs that they reach into, this one too; ascending.
  };

  static constexpr std::uint32_t kRun = 1024;  // nodes a thread takes at a time

  /// Calls `use` with each spring of some runs once: in the first of them that it is in.
  template <class Use>
  void for_springs_in(const std::vector<std::uint8_t>& runs, const Use& use) const {
    for (std::size_t r = 0; r < runs_.size(); ++r) {
      if (!runs[r]) continue;
      for (const Spring& spring : runs_[r]->springs) {
        const std::uint32_t first = std::min(spring.a, spring.b) / kRun;
        if (first == r || !runs[first]) use(spring);
      }
    }
  }
  void put(const Spring& spring, std::vector<std::shared_ptr<Run>>& runs) const;
  void finish(std::vector<std::shared_ptr<Run>> runs, const SpringEdit* edit);
  void place_nodes(const Run& run, const SpringEdit* edit);
  void invert_blocks(const Run& run, const SpringEdit* edit);
  Link link_of(const Spring& spring) const;
  template <class Start>
  void apply(const Nodal<Real>& x, Nodal<Real>& y, Real sign, const Start& start) const;

  std::vector<Vec3> places_;
  std::vector<std::shared_ptr<const Run>> runs_;
  /// Of D's blocks for rotations; the fourth lane of diagonal is of that for displacements.
  std::vector<Symmetric<Real>> inverse_;
};

}  // namespace sunder::fracture
