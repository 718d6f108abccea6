// Results of checks, and their JUnit report.
#pragma once

#include <span>
#include <string>

namespace sunder::scenes {

enum class Outcome { kPassed, kFailed, kSkipped };

/// Beginning of Verdict::what of a judged figure, which is in a table as well.
inline const std::string kFigure = "figure ";

/// A check and its result.
struct Verdict {
  std::string scene;  ///< Scene or golden that was checked.
  std::string what;   ///< Check, unique within a scene: "state", "figure frame p99" and so on.
  Outcome outcome = Outcome::kPassed;
  std::string text;    ///< Reason, in a sentence.
  double seconds = 0;  ///< Duration of the check; 0 if unknown.
};

/// Returns JUnit XML with a suite per scene. `command` is the subcommand that made the checks.
std::string junit_xml(const std::string& command, std::span<const Verdict> verdicts);

}  // namespace sunder::scenes
