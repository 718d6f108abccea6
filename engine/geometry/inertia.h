// Principal moments of inertia, bounded from below so that angular accelerations stay bounded.
#pragma once

#include "engine/base/types.h"

namespace sunder {

/// Principal axes and moments of an inertia tensor.
struct PrincipalMoments {
  Mat3 axes = Mat3::Identity();  ///< Unit axes, as columns.
  Vec3 moments = Vec3::Zero();
};

/// Returns the principal moments of an inertia tensor, each raised to at least 1e-4 of the largest.
PrincipalMoments principal_moments(const Mat3& inertia);

/// Returns the tensor with moments bounded as by principal_moments(); bit for bit the given tensor
/// if no moment is raised.
Mat3 bounded_inertia(const Mat3& inertia);

}  // namespace sunder
