// Builds a manifold from contact points, and updates it while its pair barely moves.
#pragma once

#include <span>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/collide/patch.h"

namespace sunder::solver {

/// Relative pose and motion of two bodies; float, so exact only where they are near each other.
struct PairMotion {
  Vec3f offset_W;    ///< Centre of b minus centre of a.
  Vec3f velocity_W;  ///< Velocity of b's centre minus that of a's.
  RelativePose pose;
};
PairMotion pair_motion(const Pair& pair, const Bodies& bodies);

/// Rotations and relative pose of two bodies at a time after the present one.
struct Moment {
  float time_s = 0;
  bool turned = false;  ///< False: the rotations are the present ones.
  Mat3f R_WA, R_WB;
  RelativePose pose;
};
Moment present_moment(const Pair& pair, const Bodies& bodies, const PairMotion& motion);
/// Returns the moment at which both have moved on for `time_s` at their present velocities;
/// unturned if `turning` is false.
Moment moment_at(float time_s, bool turning, const Pair& pair, const Bodies& bodies,
                 const PairMotion& motion);

/// Sets `m` from `points` (in A, at `moment`), and keeps the impulses of points that it had before.
/// If there is one point, as of a pair of edges, up to two old ones within `reach_m` are kept: a
/// piece that rocks on two edges touches each in turn, and would tip onto the edge that it just
/// left.
void build_manifold(const Pair& pair, const Bodies& bodies, const PairMotion& motion,
                    const Vec3f& normal_A, std::span<const PatchPoint> points, const Moment& moment,
                    float reach_m, Manifold& m);
/// True if the pair has barely moved since the points were built.
bool barely_moved(const Manifold& m, const Bodies& bodies, const PairMotion& motion);
/// Updates points, normal and friction drift to the current poses.
void refresh_manifold(const Bodies& bodies, const PairMotion& motion, Manifold& m);

}  // namespace sunder::solver
