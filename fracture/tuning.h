// Every tuned number of fracture, by the rule that uses it. Constants of mathematics, of rounding,
// of published formulas, of memory and of the limits of input are defined where they are used.
// tests/check_tuning.py checks that tuned numbers are here and commented.
#pragma once

#include <cstddef>
#include <cstdint>

namespace sunder::fracture {

// Patterns of an impact (decision 049).

/// Fraction of an impact's energy that goes into cracks; the rest stays kinetic or becomes heat. A
/// choice, not a measurement: crushers reach a hundredth and less.
inline constexpr double kCrackShare = 0.1;
/// Maximum least width of a pane, as a fraction of the cube root of its volume. Webs are placed
/// across panes, and along the impact in other convexes.
inline constexpr double kMaxPaneThickness = 0.3;

/// Number of sites in the shell around the ball of sites of a Voronoi pattern.
inline constexpr int kShellSites = 32;
/// Radius of the shell of sites around the ball of sites, in radii of the ball.
inline constexpr double kShellRadius = 1.5;
/// Largest random shift of a site of the shell, in radii of the ball.
inline constexpr double kShellJitter = 0.15;

/// Range of the random shift of a spoke of a web at jitter 1, as a fraction of the angle between
/// two spokes.
inline constexpr double kWebSpokeJitter = 0.6;
/// Range of the random shift of a crossing along its spoke at jitter 1, as a fraction of the
/// distance of rings.
inline constexpr double kWebRingJitter = 0.8;
inline constexpr double kMaxWebRadius = 1.1;  ///< Maximum radius of a crossing, in impact radii.

/// Maximum depth of a splinter that is split across its height, as a multiple of the height: slabs
/// are preferred to rods.
inline constexpr double kSlabPreference = 1.5;
/// Largest random tilt of the normal of a splinter's plane along the grain at jitter 1, as a slope.
inline constexpr double kSlabTiltAlong = 0.1;
/// Largest random tilt of the normal of a splinter's plane across the grain at jitter 1, as a
/// slope.
inline constexpr double kSlabTiltAcross = 0.5;

// Plugs and craters (decision 047).

/// Speed of cracks, as a fraction of that of shear waves (in glass 1,500 m/s).
inline constexpr double kCrackSpeed = 0.45;
/// Maximum volume of a plug, as a fraction of the solid's: with a larger one all of it breaks.
inline constexpr double kMaxPlugShare = 0.3;
/// Maximum area of a crater, as a fraction of the cross-section of a narrow solid, V^(2/3).
inline constexpr double kMaxCraterShare = kMaxPlugShare;
/// Maximum depth of a crater in a solid that ends beside it, as a fraction of the crater's width.
inline constexpr double kMaxShallowCraterDepth = 0.25;
/// Maximum fraction of the impact's energy that perforation takes; the rest is distributed.
inline constexpr double kMaxPerforationShare = 0.999;
/// Width of the hole, as a multiple of the striker's. At 1.04 a ball scrapes along the hole.
inline constexpr double kHoleClearance = 1.12;
/// Minimum fraction of a convex in a plug from which the convex is separated.
inline constexpr double kMinShareInPlug = 0.05;
/// Radius of the impact sphere of a plug, as a multiple of the distance of its farthest corner.
inline constexpr double kPlugSphereScale = 1.1;

/// Energy of an impact from which the far face spalls, as a multiple of the energy of the plug.
/// With a ring of spall at any energy, pieces wedge under a slow ball.
inline constexpr double kMinSpallEnergy = 9;
/// Outer width of the ring of spall, as a multiple of the width of the plug.
inline constexpr double kSpallRingWidth = 1.5;
/// Minimum reach of the cracks around a plug for rings, as a multiple of the plug's radius.
inline constexpr double kMinCrackReach = 1.1;
inline constexpr int kMaxPlugRings = 8;  ///< Maximum number of rings of a web around a plug.
/// Largest random shift of a corner of a ring, as a fraction of the distance of two rings; less
/// than 0.5.
inline constexpr double kPlugRingJitter = 0.45;
/// Width of the core of a split plug, in its widths.
inline constexpr double kPlugCoreScale = 0.55;
/// Thickness of a slice of a plug, as a fraction of the plug's width.
inline constexpr double kPlugSliceThickness = 0.7;
/// Largest random shift of a plane between slices, as a fraction of the distance of two planes.
inline constexpr double kPlugSliceJitter = 0.2;

// Cuts of convexes.

/// Minimum volume of a part, as a fraction of that of its convex and of the cube of the pattern's
/// unit. A smaller part stays with a neighbour: the cut that would separate it is not made.
inline constexpr double kMinPartVolume = 1e-6;
/// Minimum depth of a cut that fits a polyhedron to its mesh, as a fraction of the mesh's size; a
/// thinner slice is not worth a face.
inline constexpr double kMinFitCutDepth = 1e-3;

// Stress system and its solver (decision 012).

/// Minimum length of a bond's spring on each side, as a fraction of the bond's width.
inline constexpr double kMinSpringLength = 0.05;
/// Distance within which bonds of one plane form one section, in edges of the largest cell around.
inline constexpr double kSectionWindow = 2;

inline constexpr std::size_t kNodesPerGroup = 8;  ///< Nodes per node of the next coarser level.
/// Minimum strength of a spring that joins a node to a group, as a fraction of that of the node's
/// strongest spring.
inline constexpr double kWeakSpring = 0.25;
/// Factor of the corrections by coarser levels, as rigid groups are too stiff.
inline constexpr float kOvercorrection = 1.4f;
/// Maximum cost of the direct solve of a level, in iterations on that level.
inline constexpr std::uint64_t kMaxDirectIterations = 50;
/// Maximum number of nodes of a level that is solved directly; it limits the time to order them.
inline constexpr std::size_t kMaxDirectNodes = 1000;

/// Maximum residual and error of a solve for a steady load, as fractions of the load and of the
/// displacement.
inline constexpr double kStressTolerance = 1e-3;
/// Maximum residual and error of a solve for an impact load, as fractions of the load and of the
/// displacement.
inline constexpr double kImpactStressTolerance = 1e-2;
/// Maximum number of iterations of a solve; a solve that needs more breaks nothing.
inline constexpr int kMaxStressIterations = 2000;
/// Minimum number of iterations of a solve, whatever making the system cost; otherwise a structure
/// that breaks in every frame would never be solved.
inline constexpr std::uint64_t kMinStressIterations = 2;
/// Cost of an answer besides its solves, in iterations: for copying the compound and its state and
/// visiting bonds and islands.
inline constexpr std::uint64_t kOverheadIterations = 2;
/// Number of springs that the cost of an answer has besides those of the compound.
inline constexpr std::uint64_t kOverheadSprings = 50;
/// Minimum fraction of an old system's convexes that a new state must share to edit the system
/// instead of making it anew.
inline constexpr double kMinKnownShare = 0.5;

// Breaks by stress (decision 012). A utilisation is stress over strength.

inline constexpr int kMaxStressRounds = 64;  ///< Maximum rounds of solving and cutting per answer.
/// Fraction of the worst bond's utilisation from which bonds are cut with it: many are equal by
/// symmetry, and differ by rounding.
inline constexpr double kSimilarStress = 0.97;
/// Minimum utilisation by a bound for which the exact stress is computed: the stress at a bond's
/// corners exceeds that of its section by a limited factor.
inline constexpr double kMinExactUtilisation = 0.6;
/// Minimum area of a bond that bears load, as a fraction of the squared width of its smaller
/// convex. A smaller bond is left by rounding of two cuts, and the stress of a part held by it
/// alone has no numerical solution.
inline constexpr double kNegligibleBond = 1e-4;
/// Estimated utilisation above which an overlap is replaced by bonds, whose stress is accurate: one
/// half, as the estimate is within a factor of two.
inline constexpr double kOpeningUtilisation = 0.5;
/// Maximum vector area of the embedded surface of a part that passes through another convex, as a
/// fraction of the surface's area: shear bears its tension, and pressure its bending.
inline constexpr double kMaxThroughRatio = 0.1;

// Plastic sections (decision 039).

/// Minimum utilisation of a fibre for which its section is examined: fibres yield before the
/// section does, except that a section under biaxial bending or shear bears slightly more than
/// computed.
inline constexpr double kMinFibreUtilisation = 0.9;
/// Minimum utilisation of a section that may have to flow with overloaded ones.
inline constexpr double kMinSectionUtilisation = 0.5;
/// Fraction of the greatest utilisation from which sections of a member are alike.
inline constexpr double kSimilarSectionShare = 0.97;
/// Minimum cosine between the normals of sections that are alike.
inline constexpr double kSimilarSectionCosine = 0.99;
/// Minimum cosine between a bond and a section that covers it: the bond needs no section of its
/// own.
inline constexpr double kCoveredBondCosine = 0.5;
inline constexpr std::size_t kMaxSectionBonds = 4096;  ///< Maximum number of bonds of a section.
/// Minimum length of the sum of the bonds' vector areas for one plane, as a fraction of the sum of
/// their areas.
inline constexpr double kMinSectionPlanarity = 0.999;
/// Minimum length of the sum of a prism's unit side edges, as a fraction of their number.
inline constexpr double kMinPrismParallelism = 0.999;

// Decomposition of meshes (decision 010). The slack of a piece is the volume of its hull less its
// own.

/// Number of nodes by default, as a multiple of the least number by the limit of polygons: pieces
/// have unequal numbers of polygons.
inline constexpr double kNodesPerFullPiece = 1.5;
/// Largest volume of all hulls, over that of the mesh, at which hulls are tight.
inline constexpr double kTightHulls = 1.15;
/// Maximum number of nodes to which the number is doubled by default.
inline constexpr std::uint32_t kMostChosenNodes = 192;
/// Slack of hulls with twice the nodes, over that before, above which they are hardly tighter.
inline constexpr double kLeastTighter = 0.9;
inline constexpr std::size_t kSamplesPerNode = 96;     ///< Surface samples per node.
inline constexpr std::size_t kMinNodeSamples = 1024;   ///< Minimum number of samples of a mesh.
inline constexpr std::size_t kMaxNodeSamples = 16384;  ///< Maximum number of samples of a mesh.
/// Number of moves of nodes to the means of their samples.
inline constexpr int kLloydRounds = 12;
/// Number of vertices of the hull by which a shell's distance from convex is measured.
inline constexpr std::size_t kConcavityVertices = 32;
/// Minimum slack of a shell that is not convex, as a fraction of its volume.
inline constexpr double kMinConcavity = 1e-3;

/// Number of leaves to which the tree of cuts is grown, per leaf that is allowed.
inline constexpr double kTreeOvergrowth = 1.5;
/// Number of pieces that are cut before the loosest are selected again.
inline constexpr std::size_t kPiecesCutAtOnce = 8;
/// Slack of a piece up to which it is not cut, as a fraction of the mean volume of hulls.
inline constexpr double kTightSlack = 1e-4;
/// Minimum volume of an island that a cut separates, as a fraction of the piece's.
inline constexpr double kMinIslandVolume = 1e-6;
/// Shifts of a plane that are tried one after the other to avoid slivers, as fractions of the
/// piece's size.
inline constexpr double kCutShifts[] = {0.0, 1e-3, -1e-3, 5e-3, -5e-3};
/// Fraction of the slack that the best cut removes, below which the search looks one cut further.
inline constexpr double kLittleCutGain = 0.25;
/// Slack above which the search looks one cut further, as a fraction of the piece's volume.
inline constexpr double kLooseSlack = 0.1;
inline constexpr std::size_t kFurtherCuts = 6;  ///< Cuts compared by the search one cut further.

/// Slices per direction in the first search of a cut.
inline constexpr std::size_t kCutSlices = 9;
inline constexpr std::size_t kRefiningSlices = 8;  ///< Slices near the best cut in a refinement.
inline constexpr int kTiltRounds = 3;              ///< Number of refinements, each half as wide.
inline constexpr double kFirstTilt = 0.25;         ///< Tilt of the first refinement, as a slope.
/// Weight of the larger hull in the cost of a cut, which selects the more even of two tight cuts.
inline constexpr double kCutEvenness = 2e-3;
/// Weight of the larger hull in the cost of a cut that has sides of about equal size.
inline constexpr double kMiddleCutEvenness = 0.2;
/// Number of contours of a mesh from twice of which only every second is sliced, then every third,
/// and so on: the outlines hardly change.
inline constexpr std::size_t kSlicedContours = 4096;
/// Minimum volume that a vertex adds to the hull of an outline, as a fraction of the hull's volume.
inline constexpr double kMinOutlineGain = 3e-4;

}  // namespace sunder::fracture
