// Small-scale turbulence from oriented particles: what the coarse grid cannot resolve.
//
// After Pfaff et al. 2010 ("Scalable fluid simulation using anisotropic turbulence particles"), as
// the paper adapts it (section 5): every particle carries turbulent energy, fed by the strain of
// the coarse flow, and an orientation, turned by that flow; here the orientation is the axis of a
// small vortex. The vortices of a cell act together, as one with their common axis and energy.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/base/types.h"
#include "solver/base/wide.h"
#include "solver/particles/lattice.h"

namespace sunder::solver {

/// The vortices of all occupied cells of a lattice, gathered anew each step.
class Swirl {
 public:
  explicit Swirl(const Lattice& lattice);

  void clear();
  /// A vortex at a place (in cells from the corner of `cell`'s lattice), turning about an axis.
  void add(std::size_t cell, const Vec3f& at, const Vec3f& axis, float speed_m_s);
  /// Once all are added.
  void finish();
  /// The vortices within a cell's width of places in one cell, side by side.
  class Near {
   public:
    /// The velocity that they add there.
    Vec3f velocity(const Vec3f& at) const;

   private:
    friend Swirl;
    static constexpr std::size_t kMost = 32;
    std::size_t count_ = 0;  ///< A multiple of kLanes; the last may be nowhere.
    alignas(Wide) float at_[3][kMost], spin_[3][kMost];
  };
  void find(std::size_t cell, Near& near) const;

 private:
  struct Vortex {
    std::size_t cell = 0;
    Vec3f at = Vec3f::Zero();    ///< Sum, then mean.
    Vec3f spin = Vec3f::Zero();  ///< Sum, then the axis times the speed at the vortex' rim.
    float energy = 0;            ///< Sum of squared speeds.
    float count = 0;
  };

  Lattice lattice_;
  std::vector<std::int32_t> vortex_of_cell_;  ///< −1: none.
  std::vector<Vortex> vortices_;
};

/// Speed of turbulence, as the square root of its energy per mass, after a step in a flow of that
/// strain, on a grid of that cell: the one-equation model of Yoshizawa and Horiuti (1985) for
/// what a grid does not resolve.
float grow_turbulence(float speed_m_s, const Mat3f& strain_s, float cell_m, float dt_s);

/// How fast a thin rod along `axis` turns in a flow (Jeffery 1922).
Vec3f rod_spin(const Vec3f& axis, const Vec3f& vorticity_s, const Mat3f& strain_s);

}  // namespace sunder::solver
