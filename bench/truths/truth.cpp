#include "bench/truths/truth.h"

#include <algorithm>

namespace sunder::truths {

Truths all_truths() {
  Truths all;
  for (const auto& list :
       {friction_truths, rolling_truths, impact_truths,  meeting_truths,     flight_truths,
        joint_truths,    stack_truths,   balance_truths, planar_truths,      grain_truths,
        silo_truths,     sphere_truths,  energy_truths,  break_truths,       load_truths,
        blow_truths,     steel_truths,   through_truths, perforation_truths, blast_truths}) {
    const Truths truths = list();
    all.insert(all.end(), truths.begin(), truths.end());
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Truth& a, const Truth& b) { return a.row < b.row; });
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
