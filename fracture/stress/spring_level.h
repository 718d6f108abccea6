// One level of the stress solve: nodes with six degrees of freedom, joined by springs that resist
// displacement equally in all directions, and rotation.
//
// Two facts keep a level small. With a node placed at the centre of its springs, forces do not
// rotate it, so its diagonal block of the stiffness matrix is a number and a 3×3 matrix. And
// parallel springs between two rigid bodies equal one spring at their centre, so a coarser level,
// whose nodes are rigid groups, is a level of this kind.
#pragma once

#include <algorithm>
#include <cstdint>
#include <memory>
#include <tuple>
#include <vector>

#include "fracture/stress/simd4.h"

namespace sunder::fracture {

/// A spring between two nodes, or a node and the world.
struct Spring {
  static constexpr std::uint32_t kWorld = 0xffffffff;
  std::uint32_t a = kWorld, b = kWorld;
  Vec3 place = Vec3::Zero();        ///< Point of action.
  double stretch_N_m = 0;           ///< Stiffness to displacement, equal in all directions.
  Mat3 rotation_Nm = Mat3::Zero();  ///< Stiffness to rotation, N·m/rad; symmetric.

  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
};

/// Values per node, and one for the world, which is zero.
template <class Real>
using Nodal = std::vector<Six<Real>>;

/// Changes of the nodes of a level, and the springs of changed nodes after the edit.
struct SpringEdit {
  enum class Change : std::uint8_t {
    kNone,
    kSprings,  ///< All its springs are removed, or are listed in `springs`.
    kNew,      ///< Its springs change, and it stands for another body.
  };
  std::vector<Change> changes;  ///< Per node; the number of nodes may have grown.
  std::vector<Spring> springs;  ///< Each has a changed node at one end.

  bool is_at(std::uint32_t node) const {
    return node != Spring::kWorld && changes[node] != Change::kNone;
  }
  bool is_at(const Spring& spring) const { return is_at(spring.a) || is_at(spring.b); }
};

/// Nodes, springs and their stiffness matrix K; `Real` is float or double.
template <class Real>
class SpringLevel {
 public:
  SpringLevel() = default;
  /// Nodes without a spring stay at rest.
  SpringLevel(std::size_t nodes, std::vector<Spring> springs);
  /// Copies `old` and applies an edit, at a cost that depends on the edit; the rest is shared.
  SpringLevel(const SpringLevel& old, const SpringEdit& edit);

  /// Returns the number of nodes.
  std::size_t size() const { return places_.size(); }
  bool has_springs(std::uint32_t node) const { return inverse_[node].diagonal[3] > 0; }
  /// Calls `use` with each spring once.
  template <class Use>
  void for_each_spring(const Use& use) const {
    for_springs_in(std::vector<std::uint8_t>(runs_.size(), 1), use);
  }
  /// Calls `use` once with each spring at nodes with `is_in`, and with some springs nearby.
  template <class IsIn, class Use>
  void for_springs_near(const IsIn& is_in, const Use& use) const {
    std::vector<std::uint8_t> selected(runs_.size(), 0);
    for (std::uint32_t i = 0; i < size(); ++i) {
      if (is_in(i)) selected[i / kRun] = 1;
    }
    for_springs_in(selected, use);
  }
  /// Returns the centre of a node's springs, the reference point of its displacement and torque.
  const Vec3& place(std::size_t node) const { return places_[node]; }
  /// Returns a vector of zeros of the level's size.
  Nodal<Real> zero() const { return Nodal<Real>(size() + 1); }

  /// Sets y = K x.
  void multiply(const Nodal<Real>& x, Nodal<Real>& y) const;
  /// Sets y = f − K x.
  void residual(const Nodal<Real>& f, const Nodal<Real>& x, Nodal<Real>& y) const;
  /// Sets x to factor · D⁻¹ r, or adds that to x; D has the diagonal blocks of K.
  void relax(Real factor, const Nodal<Real>& r, Nodal<Real>& x, bool add) const;

  static auto fields(auto& self) { return std::tie(self.places_, self.runs_, self.inverse_); }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  /// A spring as apply() uses it. The fourth lane of rotation.diagonal is its stretch stiffness.
  struct Link {
    std::uint32_t a = 0, b = 0;  ///< The world has the greatest index.
    Simd4<Real> arm_a, arm_b;
    Symmetric<Real> rotation;
  };
  /// Springs with an end in one run of nodes; springs between two runs are in both.
  struct Run {
    std::uint32_t begin = 0, end = 0;
    std::vector<Spring> springs;
    std::vector<Link> links;            ///< Per spring.
    std::vector<std::uint32_t> beside;  ///< Runs with an end of these springs, including this one.
  };

  static constexpr std::uint32_t kRun = 1024;  // Nodes per task of a thread.

  /// Calls `use` once with each spring of the given runs: in the first of them that has the spring.
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
  /// Inverse blocks of D for rotation; the fourth lane of diagonal is the inverse for displacement.
  std::vector<Symmetric<Real>> inverse_;
};

}  // namespace sunder::fracture
