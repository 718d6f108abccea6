#include "bench/extremes/extreme.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <utility>

#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::truths {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

bool is_finite(const FrameBody& body) {
  return body.X_WB.position.allFinite() && body.X_WB.rotation.coeffs().allFinite() &&
         body.velocity_W.allFinite() && body.angular_velocity_W.allFinite();
}

std::string collect_warnings(const Scene& scene, const Preset& preset) {
  std::string all;
  for (const std::string& warning : scenes::run_info(scene, preset.name).warnings)
    all += (all.empty() ? "" : "; ") + warning;
  return all;
}

double energy_J(const FrameReport& report) { return report.kinetic_J + report.potential_J; }

}  // namespace

double Run::largest_displacement_m() const {
  double most = 0;
  for (const FrameBody& before : first->bodies) {
    const auto now = std::ranges::lower_bound(last->bodies, before.key, {}, &FrameBody::key);
    if (now == last->bodies.end() || now->key != before.key) return kNever;
    most = std::max(most, (now->X_WB.position - before.X_WB.position).norm());
  }
  return most;
}

double Run::speed_m_s(std::uint64_t key) const {
  for (const FrameBody& body : last->bodies)
    if (body.key == key) return body.velocity_W.norm();
  return kNever;
}

double Run::final_penetration_m() const {
  double deepest = 0;
  for (const float depth : last->report.penetrations_m)
    deepest = std::max(deepest, static_cast<double>(depth));
  return deepest;
}

Run run(Scene scene) {
  const auto simulation = scenes::make_simulation(std::move(scene));
  Run all;
  all.first = all.last = simulation->next();
  const double first_J = energy_J(all.first->report), first_kg = all.first->report.mass_kg;
  while (const FramePtr frame = simulation->next()) {
    all.last = frame;
    const FrameReport& report = frame->report;
    if (!std::all_of(frame->bodies.begin(), frame->bodies.end(), is_finite)) {
      all.energy_gained = all.deepest_m = all.mass_error = all.momentum_error = kNever;
      break;
    }
    const double gain_J = energy_J(report) - first_J;
    all.energy_gained = std::max(all.energy_gained, gain_J > 0 ? gain_J / first_J : 0);
    all.mass_error = std::max(all.mass_error, std::abs(report.mass_kg / first_kg - 1));
    all.momentum_error = std::max(all.momentum_error, report.momentum_residual);
    all.deepest_m = std::max(all.deepest_m, all.final_penetration_m());
  }
  return all;
}

Scene scene_at(const Preset& preset, const std::string& text, double duration_s,
               std::vector<std::string> set) {
  const std::string head =
      "[scene]\ndescription = \"An extreme.\"\nduration_s = " + std::to_string(duration_s) +
      "\n[limits]\n[accuracy]\n[ground]\n";
  return scenes::parse_scene(head + text, "extreme.toml", {preset.name, std::move(set)});
}

double mean_of_seeds(Scene scene, const std::function<double(const Run&)>& figure, int seeds) {
  double sum = 0;
  for (int seed = 1; seed <= seeds; ++seed) {
    scene.seed = static_cast<std::uint64_t>(seed);
    sum += figure(run(scene));
  }
  return sum / seeds;
}

Truth extreme(int row, const char* what, const char* unit, const char* source, double mark,
              const SceneAt& scene, const std::function<double(const Run&)>& figure,
              const Bounds& bounds) {
  return extreme(row, what, unit, source, mark, scene,
                 Measure([=](const Preset& preset) { return figure(run(scene(preset))); }), bounds);
}

Truth extreme(int row, const char* what, const char* unit, const char* source, double mark,
              const SceneAt& scene, Measure measure, const Bounds& bounds) {
  Truth one = truth(row, what, unit, source, mark, std::move(measure), bounds);
  one.told = [scene](const Preset& preset) { return collect_warnings(scene(preset), preset); };
  return one;
}

Truths all_extremes() {
  Truths all;
  for (const auto& list : {mass_extremes, size_extremes, step_extremes, surface_extremes,
                           speed_extremes, place_extremes}) {
    const Truths extremes = list();
    all.insert(all.end(), extremes.begin(), extremes.end());
  }
  return all;
}

}  // namespace sunder::truths
