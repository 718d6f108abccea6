// Inertia as everything that moves or weighs bodies has it.
#pragma once

#include "engine/base/types.h"

namespace sunder {

struct PrincipalMoments {
  Mat3 axes = Mat3::Identity();  ///< Columns.
  Vec3 moments = Vec3::Zero();
};

/// Of an inertia, about its axes; none is less than 1e-4 of the largest, so that no axis can be
/// spun without effort.
PrincipalMoments principal_moments(const Mat3& inertia);

/// The inertia itself, unless a moment of it is less than that.
Mat3 spinnable(const Mat3& inertia);

}  // namespace sunder
