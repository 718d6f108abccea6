#include "bench/ablation/rules.h"

#include <cstdint>
#include <sstream>
#include <stdexcept>
#include <type_traits>
#include <utility>
#include <variant>

#include "solver/rigid/tuning.h"

namespace sunder::ablation {
namespace {

using namespace solver;

using Number = std::variant<double*, float*, bool*, int*, std::uint8_t*, std::size_t*>;

#define SUNDER_NUMBER(name) \
  { #name, &name }
const std::pair<std::string, Number> kNumbers[] = {
    SUNDER_NUMBER(kStiffness),    SUNDER_NUMBER(kFaceStiffness),
    SUNDER_NUMBER(kDampingRatio), SUNDER_NUMBER(kPush),
    SUNDER_NUMBER(kMostGive),     SUNDER_NUMBER(kLeastCompliance),
    SUNDER_NUMBER(kLeastProp),    SUNDER_NUMBER(kPinched),
    SUNDER_NUMBER(kMostLeft),     SUNDER_NUMBER(kLeastSlope),
    SUNDER_NUMBER(kAccelerates),  SUNDER_NUMBER(kStill),
    SUNDER_NUMBER(kSlowFalls),    SUNDER_NUMBER(kMargin),
    SUNDER_NUMBER(kSliver),       SUNDER_NUMBER(kApart),
    SUNDER_NUMBER(kLeastInner),   SUNDER_NUMBER(kLayer),
    SUNDER_NUMBER(kReuse),        SUNDER_NUMBER(kFar),
    SUNDER_NUMBER(kDeep),         SUNDER_NUMBER(kCrowd),
    SUNDER_NUMBER(kGuards),       SUNDER_NUMBER(kStrikes),
    SUNDER_NUMBER(kKeeps),        SUNDER_NUMBER(kLooksAhead),
    SUNDER_NUMBER(kDrift),        SUNDER_NUMBER(kSlow),
    SUNDER_NUMBER(kRestTime),     SUNDER_NUMBER(kRestSteps),
    SUNDER_NUMBER(kChange),       SUNDER_NUMBER(kComplianceStep),
    SUNDER_NUMBER(kStiffest),     SUNDER_NUMBER(kLargestAngle),
};
#undef SUNDER_NUMBER

constexpr double kNever = 1e9, kAll = 1e30;

}  // namespace

std::vector<Rule> all_rules() {
  return {
      {"as it is", {}},
      {"noise: damping + 1e-5", {{"kDampingRatio", 5.00005}}},
      {"noise: push + 1e-5", {{"kPush", 4.00004}}},
      {"noise: margin + 1e-5", {{"kMargin", 0.0500005}}},
      {"static warm start", {{"kMostLeft", -1}}},
      {"its first guess", {{"kLeastSlope", 2}}},
      {"what is not supported is released", {{"kMostLeft", kAll}}},
      {"stiffening", {{"kMostGive", kAll}}},
      {"its floor for the pinched", {{"kLeastCompliance", 0.01}}},
      {"props stiffen less", {{"kPinched", 0}}},
      {"it comes slowly", {{"kComplianceStep", 0.01}}},
      {"corrections have a speed", {{"kPush", kAll}}},
      {"kept points", {{"kKeeps", 0}}},
      {"lowest layer, and axes are kept", {{"kLayer", 0}}},
      {"reuse of manifolds", {{"kReuse", 0}}},
      {"edges at rest", {{"kSliver", -1}}},
      {"margin", {{"kMargin", 0}}},
      {"looking ahead for impacts", {{"kLooksAhead", 0}}},
      {"crowds: pairs and contacts", {{"kCrowd", kNever}}},
      {"energy guard", {{"kGuards", 0}}},
      {"strikes", {{"kStrikes", 0}}},
      {"arms that follow, strikes, and spins", {{"kStill", 1e6}}},
      {"conjugate gradients", {{"kAccelerates", 0}}},
      {"midpoint steps are cut", {{"kLargestAngle", kAll}}},
      {"damping of pulls grows", {{"kStiffest", kAll}}},
  };
}

std::vector<Rule> parse_rules(const std::string& text) {
  std::vector<Rule> rules;
  std::istringstream all(text);
  for (std::string rule; std::getline(all, rule, ';');) {
    rules.push_back({rule, {}});
    std::istringstream changes(rule);
    for (std::string change; std::getline(changes, change, ',');) {
      const std::size_t is = change.find('=');
      if (is == std::string::npos) throw std::invalid_argument("expected NUMBER=VALUE: " + change);
      rules.back().off.push_back({change.substr(0, is), std::stod(change.substr(is + 1))});
    }
  }
  return rules;
}

double set_number(const std::string& name, double value) {
  for (const auto& [known, number] : kNumbers) {
    if (known != name) continue;
    return std::visit(
        [&](auto* of) {
          using T = std::remove_reference_t<decltype(*of)>;
          return static_cast<double>(std::exchange(*of, static_cast<T>(value)));
        },
        number);
  }
  throw std::invalid_argument("not in the book of numbers: " + name);
}

}  // namespace sunder::ablation
