// Something that was looked at, and what came of it.
#pragma once

#include <span>
#include <string>

namespace sunder::bench {

enum class Outcome { kPassed, kFailed, kSkipped };

struct Verdict {
  std::string scene;
  std::string what;  ///< "state", "stage solve" and so on; once a scene.
  Outcome outcome = Outcome::kPassed;
  std::string text;  ///< Why, in a sentence.
};

/// All of them as JUnit has it: XML, a suite a scene.
std::string junit_xml(std::span<const Verdict> verdicts);

}  // namespace sunder::bench
