// How stiff contacts have to be for what stands in a scene: what presses on what, and the time a
// substep may take.
#pragma once

#include <string>

#include "engine/model/scene.h"

namespace sunder {

/// The body of a scene that asks for the shortest substep, and what lies on it.
struct Stack {
  std::uint32_t bodies = 0;  ///< On top of each other, itself included; 0: nothing can press.
  double load = 0;           ///< What it carries, itself included, in its own weights.
  double size_m = 0;         ///< Least extent of a body on the way up.
  double tilt_1_m = 0;       ///< Sum of height over narrower width squared: N/a of N cubes.
};

/// The body that sinks in most; the one that buckles first.
struct Stacks {
  Stack deepest, weakest;
};
Stacks stacks_in(const Scene& scene);

/// How far a body under such a load sinks in, about: 1.55·load·g·h² (docs/decisions/027).
double expected_sink_m(const Stack& stack, double gravity_m_s2, double h_s);
/// Substeps of `dt_s` so that it sinks no farther than `target_m`; at least 1.
int substeps_for_sink(const Stack& stack, double gravity_m_s2, double dt_s, double target_m);
/// Substeps so that what stands does not buckle: soft contacts let a column of N cubes of size a
/// sink by less than 1.96·a/N² under its own weight, or 0.62·a/N² under a load on top.
int substeps_to_stand(const Stack& stack, double gravity_m_s2, double dt_s);
/// The scene's accuracy with so many; a shorter step where that is more than `most_substeps`.
Accuracy accuracy_to_stand(const Scene& scene, int most_substeps);

/// With a step cut into `all` substeps; a shorter one where that is more than `most_substeps`.
Accuracy cut_in_substeps(Accuracy accuracy, int all, int most_substeps);

/// What a user who made a scene in code should know of a step longer than any a file may ask for;
/// empty if nothing.
std::string long_step_warning(const Scene& scene);
/// Of what is farther from the origin than floats and takes have debris exactly; empty if nothing.
std::string far_warning(const Scene& scene);
/// What a user should know of the body that would sink in by half its size, or more, under the
/// heaviest that can move, wherever both are; empty if there is none.
std::string crush_warning(const Scene& scene, int most_substeps);
/// What a user, who may ask for so many substeps, should know about a scene's accuracy; empty if
/// nothing.
std::string accuracy_warning(const Scene& scene, int most_substeps);

}  // namespace sunder
