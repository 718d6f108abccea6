// Small-scale turbulence from oriented particles, below the resolution of the coarse grid.
//
// After Pfaff et al. 2010 ("Scalable fluid simulation using anisotropic turbulence particles"), as
// adapted in section 5 of the paper: every particle carries turbulent energy, produced by the
// strain of the coarse flow, and an orientation, rotated by that flow. Here the orientation is the
// axis of a vortex, and the vortices of a cell are merged into one of their mean axis and energy.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

#include "engine/base/types.h"
#include "solver/base/wide.h"
#include "solver/particles/lattice.h"

namespace sunder::solver {

/// The vortices of all occupied cells of a lattice, rebuilt each step.
class Swirl {
 public:
  explicit Swirl(const Lattice& lattice);

  void clear();
  /// Adds a vortex at a position in cells from the lower corner of the lattice.
  void add(std::size_t cell, const Vec3f& at, const Vec3f& axis, float speed_m_s);
  /// Computes the mean vortex of each cell; to be called when all are added.
  void finish();
  /// The vortices within one cell's width of any point of a cell, in arrays for vector code.
  class Near {
   public:
    /// Returns the velocity, in m/s, that the vortices add at a position in cells.
    Vec3f velocity(const Vec3f& at) const;

   private:
    friend Swirl;
    static constexpr std::size_t kMost = 32;
    std::size_t count_ = 0;  ///< A multiple of kLanes, padded with vortices without effect.
    alignas(Wide) float at_[3][kMost], spin_[3][kMost];
  };
  void find(std::size_t cell, Near& near) const;

  static auto fields(auto& self) {
    return std::tie(self.lattice_, self.vortex_of_cell_, self.vortices_);
  }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;
  const Lattice& lattice() const { return lattice_; }

 private:
  struct Vortex {
    std::size_t cell = 0;
    Vec3f at = Vec3f::Zero();    ///< Sum of positions; after finish() their mean.
    Vec3f spin = Vec3f::Zero();  ///< Sum of speed · axis; then unit axis · vortex speed.
    float energy = 0;            ///< Sum of squared speeds.
    float count = 0;
  };

  Lattice lattice_;
  std::vector<std::int32_t> vortex_of_cell_;  ///< Index into vortices_, or −1.
  std::vector<Vortex> vortices_;
};

/// Returns the turbulent speed (square root of the energy per mass) after a step, by the
/// one-equation subgrid model of Yoshizawa and Horiuti (1985).
float grow_turbulence(float speed_m_s, const Mat3f& strain_s, float cell_m, float dt_s);

/// Returns the angular velocity of a thin rod along `axis` in a flow (Jeffery 1922).
Vec3f rod_spin(const Vec3f& axis, const Vec3f& vorticity_s, const Mat3f& strain_s);

}  // namespace sunder::solver
