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

}  // namespace sunder::solver
