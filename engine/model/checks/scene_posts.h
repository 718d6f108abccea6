// Posts that would buckle under their load. Bodies are rigid, so a simulation never shows buckling:
// the scene is compared with Euler's critical load before it runs.
//
// Source: S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability, 2nd ed., 1961, chapter 2:
// critical loads, successive approximations for variable sections, and self-weight.
#pragma once

#include <string>
#include <vector>

#include "engine/model/scene.h"

namespace sunder {

/// A slender upright solid, its load and its critical load.
///
/// The effective length is K times the height. K is 2 for a post that bears its load alone: clamped
/// foot, free head. K is 1 if the load also rests on other posts: the heads sway together, but do
/// not rotate. K is 0.7 if the load also rests on something that is not a post: the head is held,
/// but rotates.
struct Post {
  std::string name;
  double height_m = 0;  ///< Height above its anchored part.
  double load_kg = 0;   ///< Load on its head.
  /// Load on its head at which it buckles; self-weight is taken into account.
  double critical_kg = 0;
  double length_factor = 0;  ///< K.
};

/// Returns the posts of a scene that stand on the ground or on another body, in the order of its
/// solids.
///
/// A post is a solid at least four times as high as the narrowest width of its box, with an
/// effective length of at least 30 radii of gyration. Supports are found by boxes: a body rests on
/// another if the bottom of its box is at the top of the other's, within 2 % of the smaller width;
/// several supports share its weight as springs of equal stiffness under a rigid body. The critical
/// load is accurate within 1 % for a column with a centred load of its own, also with a variable
/// section; the share of a load within a factor of 2, and K within a factor of 2 where a load is
/// shared. Posts that are parts of a larger solid, and posts that are jointed to a body other than
/// their load, are ignored.
std::vector<Post> find_posts(const Scene& scene);

/// Returns a warning about the post that exceeds its critical load most; empty if there is none.
std::string post_warning(const Scene& scene);

}  // namespace sunder
