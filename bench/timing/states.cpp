#include "bench/timing/states.h"

#include <algorithm>
#include <variant>

#include "bench/timing/timing.h"
#include "engine/base/check.h"

namespace sunder::bench {
namespace {

bool differs(const Figures& scene) {
  const auto found = scene.find("/differs");
  const bool* value = found == scene.end() ? nullptr : std::get_if<bool>(&found->second);
  return value && *value;
}

constexpr const char* kDiffers =
    "its repeats come to different states; `sunder simulate --take` and --verify find the frame";

/// Returns the reason why a run has no stored hash to be compared with; empty if it has one.
std::string reason_not_checked(const Figures& scene) {
  if (scene.contains("/set/0")) return "changed by --set, so not held against a stored state";
  if (scene.contains("/state/hash")) return {};
  return "a stored state is of " + std::to_string(kStateFrames) + " frames, this run has " +
         std::to_string(static_cast<int>(number_at(scene, "/frames")));
}

std::string state_key(const Figures& scene) {
  return "state/" + text_at(scene, "/scene") + "/" + text_at(scene, "/preset") + "/" +
         std::to_string(static_cast<int>(number_at(scene, "/state/frames")));
}

Verdict check_state(const Figures& scene, const StateHashes& book, const std::string& file) {
  Verdict verdict{text_at(scene, "/scene"), "state", Outcome::kFailed, {}};
  verdict.seconds = 1e-3 * number_at(scene, "/frame/mean_ms") * number_at(scene, "/frames") *
                    std::max(1.0, number_at(scene, "/repeats"));
  if (differs(scene)) {
    verdict.text = kDiffers;
  } else if (verdict.text = reason_not_checked(scene); !verdict.text.empty()) {
    verdict.outcome = Outcome::kSkipped;
  } else if (const auto known = book.find(state_key(scene)); known == book.end()) {
    verdict.text = file + " has no " + state_key(scene) + "; --accept stores it";
  } else if (known->second != text_at(scene, "/state/hash")) {
    verdict.text = state_key(scene) + " is " + text_at(scene, "/state/hash") + ", and " +
                   known->second + " in " + file +
                   ": something else is simulated; if that is right, --accept stores it";
  } else {
    verdict.outcome = Outcome::kPassed;
    verdict.text = state_key(scene) + " is " + known->second + ", as stored";
  }
  return verdict;
}

}  // namespace

std::vector<Verdict> compare_states(std::span<const Figures> scenes, const StateHashes& book,
                                    const std::string& file) {
  std::vector<Verdict> verdicts;
  for (const Figures& scene : scenes) verdicts.push_back(check_state(scene, book, file));
  return verdicts;
}

void accept_states(std::span<const Figures> scenes, StateHashes& book) {
  for (const Figures& scene : scenes) {
    const std::string why = differs(scene) ? kDiffers : reason_not_checked(scene);
    if (!why.empty()) throw InputError("--accept: " + text_at(scene, "/scene") + ": " + why);
    book[state_key(scene)] = text_at(scene, "/state/hash");
  }
}

}  // namespace sunder::bench
