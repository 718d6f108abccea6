#include "scenes/timing/verdict.h"

#include <algorithm>
#include <map>
#include <vector>

#include "engine/base/printed.h"
#include "scenes/report/page.h"

namespace sunder::scenes {
namespace {

std::string quoted(const std::string& text) { return "\"" + escaped(text) + "\""; }

/// Returns the attribute `time`; empty if the duration is unknown.
std::string time_attribute(double seconds) {
  return seconds > 0 ? printed(" time=\"%.3f\"", seconds) : "";
}

std::string test_case(const std::string& command, const Verdict& verdict) {
  const std::string head =
      "    <testcase classname=" + quoted("sunder." + command + "." + verdict.scene) +
      " name=" + quoted(verdict.what) + time_attribute(verdict.seconds);
  switch (verdict.outcome) {
    case Outcome::kFailed:
      return head + "><failure message=" + quoted(verdict.text) + "/></testcase>\n";
    case Outcome::kSkipped:
      return head + "><skipped message=" + quoted(verdict.text) + "/></testcase>\n";
    case Outcome::kPassed:
      break;
  }
  return head + "><system-out>" + escaped(verdict.text) + "</system-out></testcase>\n";
}

std::string counts(std::span<const Verdict> verdicts) {
  const auto count = [&](Outcome outcome) {
    return quoted(std::to_string(std::ranges::count(verdicts, outcome, &Verdict::outcome)));
  };
  double seconds = 0;
  for (const Verdict& verdict : verdicts) seconds += verdict.seconds;
  return " tests=" + quoted(std::to_string(verdicts.size())) +
         " failures=" + count(Outcome::kFailed) + " skipped=" + count(Outcome::kSkipped) +
         time_attribute(seconds);
}

}  // namespace

std::string junit_xml(const std::string& command, std::span<const Verdict> verdicts) {
  std::map<std::string, std::vector<Verdict>> suites;
  for (const Verdict& verdict : verdicts) suites[verdict.scene].push_back(verdict);
  std::string xml = "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<testsuites name=" +
                    quoted("sunder " + command) + counts(verdicts) + ">\n";
  for (const auto& [scene, suite] : suites) {
    xml += "  <testsuite name=" + quoted(scene) + counts(suite) + ">\n";
    for (const Verdict& verdict : suite) xml += test_case(command, verdict);
    xml += "  </testsuite>\n";
  }
  return xml + "</testsuites>\n";
}

}  // namespace sunder::scenes
