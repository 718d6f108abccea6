#include "scenes/timing/states.h"

#include <algorithm>
#include <variant>

#include "engine/base/check.h"
#include "scenes/timing/timing.h"

namespace sunder::scenes {
namespace {

bool differs(const Figures& scene) {
  const auto found = scene.find("/differs");
  const bool* value = found == scene.end() ? nullptr : std::get_if<bool>(&found->second);
  return value && *value;
}

constexpr const char* kDiffers =
    "the states of its repeats differ; find the first frame by `sunder simulate --take FILE` and "
    "`--verify FILE`";

/// Returns the reason why a run has no stored hash to be compared with; empty if it has one.
std::string reason_not_checked(const Figures& scene) {
  if (scene.contains("/set/0"))
    return "not compared with a stored state, because --set changes the scene";
  if (scene.contains("/state/hash")) return {};
  return "not compared with a stored state, which is that after " + std::to_string(kStateFrames) +
         " frames; this run has " + std::to_string(static_cast<int>(number_at(scene, "/frames")));
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
    verdict.text = file + " has no " + state_key(scene) + "; store it by --accept";
  } else if (known->second != text_at(scene, "/state/hash")) {
    verdict.text = state_key(scene) + " is " + text_at(scene, "/state/hash") +
                   "; the stored state is " + known->second + " in " + file +
                   ": the simulated motion has changed; if that is intended, store it by --accept";
  } else {
    verdict.outcome = Outcome::kPassed;
    verdict.text = state_key(scene) + " is " + known->second + ", equal to the stored state";
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

}  // namespace sunder::scenes
