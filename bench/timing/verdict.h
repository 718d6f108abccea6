// Something that was looked at, and what came of it.
#pragma once

#include <span>
#include <string>

namespace sunder::bench {

enum class Outcome { kPassed, kFailed, kSkipped };

struct Verdict {
  std::string scene;  ///< Or golden.
  std::string what;   ///< "state", "stage solve", "drawing" and so on; once a scene.
  Outcome outcome = Outcome::kPassed;
  std::string text;    ///< Why, in a sentence.
  double seconds = 0;  ///< That it took to find out; 0: not known.
};

/// All of them as JUnit has it: XML, a suite a scene. `command` is that of the program which
/// looked.
std::string junit_xml(const std::string& command, std::span<const Verdict> verdicts);

}  // namespace sunder::bench
