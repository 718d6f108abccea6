// Posts that would buckle under their load. Bodies are rigid, so a simulation never shows it: the
// scene is compared with Euler's critical load before it runs.
//
// Source: S. P. Timoshenko and J. M. Gere, Theory of Elastic Stability, 2nd ed., 1961, chapter 2:
// critical loads, successive approximations for sections that vary, and own weight.
#pragma once

#include <string>
#include <vector>

#include "engine/model/scene.h"

namespace sunder {

/// A slender upright solid, its load and its critical load.
///
/// The effective length is K times the height. K is 2 for a post that bears its load alone: its
/// foot is clamped, its head is free. K is 1 where the load rests on other posts as well: the heads
/// sway together, but do not turn. K is 0.7 where the load rests on something that is no post as
/// well: the head is held, but turns.
struct Post {
  std::string name;
  double height_m = 0;       ///< Above what the world holds of it.
  double load_kg = 0;        ///< On its head.
  double weight_kg = 0;      ///< Its own, above what the world holds.
  double critical_kg = 0;    ///< Load on its head that buckles it, own weight included.
  double length_factor = 0;  ///< K.
};

/// The posts of a scene that stand on the ground or on another body, in the order of its solids.
///
/// A post is a solid at least four times as high as its box is wide at its narrowest, with an
/// effective length of at least 30 radii of gyration. What stands on it is found by boxes: a body
/// rests on another where its box begins at the top of the other's, within 2 % of the smaller one's
/// width; several supports share its weight as a rigid body on equal springs. The critical load is
/// exact within 1 % for a column whose load is centred and alone, also where its section varies;
/// the share of a load is right within a factor of 2, and K within a factor of 2 where a load is
/// shared. Posts that are parts of a larger solid, or that joints hold to something other than
/// their load, are not looked at.
std::vector<Post> posts_in(const Scene& scene);

/// The message about the post that is farthest beyond its critical load; empty if no post is.
std::string post_warning(const Scene& scene);

}  // namespace sunder
