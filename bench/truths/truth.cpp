#include "bench/truths/truth.h"

#include <algorithm>
#include <string_view>
#include <utility>

namespace sunder::truths {

namespace {

struct KnownSource {
  std::string_view part;  ///< A part of the text of the source.
  SourceKind kind;
};
constexpr KnownSource kKnownSources[] = {
    {"Lube et al.", SourceKind::kMeasured},
    {"Jarrett 1968", SourceKind::kMeasured},
    {"SimBenchmark", SourceKind::kOtherEngine},
    {"Box2D", SourceKind::kOtherEngine},
    // The engine computes perforations by these formulas.
    {"OpenCourant", SourceKind::kOtherEngine},
    {"de la Bastie", SourceKind::kMeasured},
    {"Børvik", SourceKind::kMeasured},
    {"Bennett", SourceKind::kMeasured},
    {"Recht and Ipson 1963, CEA-EDF", SourceKind::kOwn},
    {"CEA-EDF (Berriaud", SourceKind::kOwn},
    {"through the plug", SourceKind::kOwn},
    {"toughness × area", SourceKind::kOwn},
    {"256 sweeps", SourceKind::kOwn},
    {"the same at every", SourceKind::kOwn},
    {"docs/decisions/", SourceKind::kOwn},
};

}  // namespace

SourceKind source_kind(const Truth& truth) {
  const std::string_view source = truth.source;
  for (const KnownSource& known : kKnownSources)
    if (source.find(known.part) != std::string_view::npos) return known.kind;
  return SourceKind::kClosedForm;
}

const char* name_of(SourceKind kind) {
  constexpr const char* kNames[] = {"closed form", "measured", "other engine", "own"};
  return kNames[static_cast<std::size_t>(kind)];
}

Truths all_truths() {
  Truths all;
  for (const auto& list :
       {friction_truths, rolling_truths, impact_truths,  meeting_truths,     flight_truths,
        joint_truths,    stack_truths,   balance_truths, planar_truths,      grain_truths,
        silo_truths,     sphere_truths,  energy_truths,  break_truths,       load_truths,
        blow_truths,     steel_truths,   through_truths, perforation_truths, blast_truths,
        wall_truths,     pane_truths,    drop_truths,    outside_truths}) {
    const Truths truths = list();
    all.insert(all.end(), truths.begin(), truths.end());
  }
  const auto place = [](const Truth& truth) {
    return std::pair(source_kind(truth) == SourceKind::kOwn, truth.row);
  };
  std::ranges::stable_sort(all, {}, place);
  return all;
}

double threshold(double low, double high, int rounds, const std::function<bool(double)>& yes) {
  for (int i = 0; i < rounds; ++i) {
    const double middle = 0.5 * (low + high);
    (yes(middle) ? high : low) = middle;
  }
  return 0.5 * (low + high);
}

}  // namespace sunder::truths
