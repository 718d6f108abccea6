// Estimates of the substeps that the stacks of a scene need, and warnings about its accuracy.
#pragma once

#include <string>

#include "engine/model/scene.h"

namespace sunder {

/// A stack of bodies, characterised by its lowest body.
struct Stack {
  /// Number of bodies on top of each other, the lowest included; 0: no stack.
  std::uint32_t bodies = 0;
  double load = 0;    ///< Mass carried by the lowest body, itself included, over its own mass.
  double size_m = 0;  ///< Least extent of a body in the stack.
  double slenderness_1_m =
      0;  ///< Sum of height over squared narrower width; N/a for N cubes of size a.
};

/// The stack whose lowest body sinks most, and the one that buckles first.
struct Stacks {
  Stack deepest, weakest;
};
/// Returns these stacks of a scene.
Stacks find_stacks(const Scene& scene);

/// Returns the approximate penetration of the lowest body: 1.55·load·g·h² (docs/decisions/027).
double expected_penetration_m(const Stack& stack, double gravity_m_s2, double h_s);
/// Returns the substeps of `dt_s` that limit the penetration to `target_m`; at least 1.
int substeps_for_penetration(const Stack& stack, double gravity_m_s2, double dt_s, double target_m);
/// Returns the substeps at which the stack does not buckle. With soft contacts a column of N cubes
/// of size a stands if it sinks by less than 1.96·a/N² under its self-weight, or 0.62·a/N² under a
/// load on top.
int substeps_against_buckling(const Stack& stack, double gravity_m_s2, double dt_s);
/// Returns the scene's accuracy with the substeps at which all stacks stand; the step is divided if
/// these are more than `max_substeps`.
Accuracy accuracy_against_buckling(const Scene& scene, int max_substeps);

/// Returns `accuracy` with its step divided into `all` substeps in total; the step is divided if
/// these are more than `max_substeps`.
Accuracy divide_step(Accuracy accuracy, int all, int max_substeps);

/// Returns a warning about a step longer than scene files allow; empty if there is none.
std::string long_step_warning(const Scene& scene);
/// Returns a warning about bodies too far from the origin for the precision of debris and
/// recordings; empty if there are none.
std::string far_warning(const Scene& scene);
/// Returns a warning about the body that would sink by half its size or more under the heaviest
/// movable body, wherever both are; empty if there is none.
std::string crush_warning(const Scene& scene, int max_substeps);
/// Returns a warning about the scene's accuracy, with a remedy of at most `max_substeps` substeps
/// per step; empty if there is none.
std::string accuracy_warning(const Scene& scene, int max_substeps);

}  // namespace sunder
