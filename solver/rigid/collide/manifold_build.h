// From contact points to a manifold, and carrying a manifold along while its pair barely moves.
#pragma once

#include <span>

#include "solver/rigid/body/bodies.h"
#include "solver/rigid/collide/contacts.h"
#include "solver/rigid/collide/patch.h"

namespace sunder::solver {

/// How two bodies lie and move relative to each other; float, so exact near each other only.
struct PairMotion {
  Vec3f offset_W;    ///< Centre of b from centre of a.
  Vec3f velocity_W;  ///< Of b's centre, seen from a's.
  RelativePose pose;
};
PairMotion pair_motion(const Pair& pair, const Bodies& bodies);

/// Fills `m` from `points` (in A, at `pose` shifted by `shift_W` from now), keeping impulses of
/// points that were there before. Beside a single point, as a pair of edges has, one or two that
/// were there stay while they are within `reach_m`: a piece that rocks on two edges touches each in
/// turn, and would tip onto the one that it just left.
void build_manifold(const Pair& pair, const Bodies& bodies, const PairMotion& motion,
                    const Vec3f& normal_A, std::span<const PatchPoint> points, const Vec3f& shift_W,
                    float reach_m, Manifold& m);
/// Whether the pair has barely moved since the points were made.
bool barely_moved(const Manifold& m, const Bodies& bodies, const PairMotion& motion);
/// Points, normal and drift at today's poses.
void refresh_manifold(const Bodies& bodies, const PairMotion& motion, Manifold& m);

}  // namespace sunder::solver
