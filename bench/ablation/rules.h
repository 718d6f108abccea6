// The rules of the rigid solver, and the numbers of its book at which each is off.
#pragma once

#include <string>
#include <vector>

namespace sunder::ablation {

/// A number of solver/rigid/tuning.h, by name, and what it becomes.
struct Change {
  std::string number;
  double value;
};

struct Rule {
  std::string name;
  std::vector<Change> off;  ///< None: the solver as it is.
};

/// The solver as it is first, then rules that hardly change anything, whose effect is noise.
std::vector<Rule> all_rules();
/// How many of them are of the solver as it is, but for noise.
inline constexpr std::size_t kNoise = 4;

/// "kPush=8,kMargin=0.1;kLayer=0": two of them. Throws std::invalid_argument.
std::vector<Rule> parse_rules(const std::string& text);

/// What the number was. Throws std::invalid_argument for one that is not in the book.
double set_number(const std::string& name, double value);

}  // namespace sunder::ablation
