// Between a body and its row.
#pragma once

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/body/body_row.h"

namespace sunder::solver {

/// Makes the row of a body as it lies and moves now; `root_W` becomes what turns its angular lanes
/// into W.
void take_row(const Bodies& bodies, BodySlot body, BodyRow& row, Mat3f& root_W);
/// What has changed the row's velocity since then also changes the body's, which has not moved.
void give_row(const BodyRow& row, const Mat3f& root_W, BodySlot body, Bodies& bodies);

/// Where those of kinematic bodies go.
struct KinematicRows {
  std::vector<BodySlot>& bodies;  ///< Those on their way.
  ByBody<std::int32_t>& row;      ///< Of each; of others 0. Empty: there are none.
  std::vector<BodyRow>& rows;  ///< Theirs first, from that of the last one on; then room for row 0
                               ///< and all others.
  ByBody<Mat3f>& root_W;
};
/// Finds kinematic bodies on their way, and fills their rows and row 0.
void take_kinematic(const Bodies& bodies, const KinematicRows& to);

}  // namespace sunder::solver
