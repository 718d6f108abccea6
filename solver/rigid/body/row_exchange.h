// Conversion between bodies and their rows.
#pragma once

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/body_row.h"

namespace sunder::solver {

/// Sets the row of a body from its state; `root_W` maps the angular lanes of the row to W.
void load_row(const Bodies& bodies, BodySlot body, BodyRow& row, Mat3f& root_W);
/// Adds the change of the row's velocity since the step began to the velocity of the body.
void store_velocity_of_row(const BodyRow& row, const Mat3f& root_W, BodySlot body, Bodies& bodies);

/// Rows of kinematic bodies, to be filled.
struct KinematicRows {
  std::vector<BodySlot>& bodies;  ///< Moving kinematic bodies.
  ByBody<std::int32_t>& row;      ///< Row index by body; 0 for other bodies. Empty: no such bodies.
  /// Rows of kinematic bodies, the last one first; then row 0 and those of all others.
  std::vector<BodyRow>& rows;
  ByBody<Mat3f>& root_W;
};
/// Finds the moving kinematic bodies, and fills their rows and row 0.
void load_kinematic_rows(const Bodies& bodies, const KinematicRows& to);

}  // namespace sunder::solver
