// The limits that a run counts when it reaches them, by name. Begin with kLimitTexts, the table
// that JSON, the warning at the end of a run and docs/json.md are made from.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <tuple>

namespace sunder {

/// A limit whose effect on a run is counted. Limits that a scene can set have its key as name.
enum class Limit : std::uint8_t {
  kBodies,
  kDebris,
  kDust,
  kPartsAFrame,
  kBreakRounds,
  kClusterBodies,
  kProbeEvents,
  kImpactBonds,
  kImpactEvaluations,
  kLoadedConvexes,
  kLoadIterations,
  kDenseClusters,
  kImpactSweeps,
  kJointBand,
  kPlanarSteps,
  kSpeeds,
};
inline constexpr std::size_t kLimits = std::size_t{1} + static_cast<std::size_t>(Limit::kSpeeds);

/// Texts that explain a limit to the user.
struct LimitText {
  const char* name;
  const char* counted;  ///< What one count is, and its effect.
  const char* advice;   ///< What the user can do.
  /// True if the limit acts in ordinary runs by design: it is listed by name, but neither summed
  /// nor warned of.
  bool by_design = false;
};

/// Texts of each Limit.
inline constexpr std::array<LimitText, kLimits> kLimitTexts = {{
    {"bodies", "breaks that did not happen, as the pieces would have been too many bodies",
     "raise limits.bodies"},
    {"debris", "frames in which debris was left out", "raise limits.debris"},
    {"dust", "frames in which dust was left out", "raise limits.dust"},
    {"parts_a_frame",
     "impacts that broke nothing, as the frame's budget was spent and they could not wait",
     "raise limits.parts_a_frame"},
    {"break_rounds",
     "impacts that broke nothing, as they were undecided after the last round of breaks in a step",
     "raise limits.break_rounds"},
    {"cluster_bodies", "impacts that may have reached more bodies than their cluster can have",
     "raise limits.cluster_bodies"},
    {"probe_events", "clusters whose later impacts in a step broke nothing",
     "raise limits.probe_events"},
    {"impact_bonds",
     "solids and pieces with too many bonds for stress by impact: impacts break them where struck, "
     "by their pattern, only",
     "raise limits.impact_bonds and limits.impact_evaluations"},
    {"impact_evaluations",
     "impacts that broke nothing, as the stress they cause was not known in time",
     "raise limits.impact_evaluations, for solids of more than 5000 bonds"},
    {"loaded_convexes",
     "pieces of too few convexes for stress by contacts: contacts break them where struck, by "
     "their pattern, only",
     "lower limits.loaded_convexes", true},
    {"load_iterations",
     "stress solves of steady loads that did not converge, so that the solid was taken to bear its "
     "load",
     "make the solid of fewer convexes, or of convexes of similar size"},
    {"dense_clusters",
     "steps in which bodies that overlap very many others passed through some of them",
     "place bodies farther apart"},
    {"impact_sweeps", "steps in which an impact did not reach all bodies that touch each other",
     "lower accuracy.dt_s"},
    {"joint_band", "steps in which chains may have stretched, as too many joints were connected",
     "raise accuracy.substeps, or use fewer links"},
    {"planar_steps",
     "steps in which a body of a planar scene was so fast that it may have passed through others",
     "lower accuracy.dt_s"},
    {"speeds", "steps in which bodies were slowed down to 1e5 m/s or 1e6 rad/s along each axis",
     "give bodies less speed or impulse"},
}};

/// Number of times that each limit was reached.
class LimitsHit {
 public:
  /// Returns the count of a limit.
  std::uint32_t& operator[](Limit limit) { return counts_[static_cast<std::size_t>(limit)]; }
  std::uint32_t operator[](Limit limit) const { return counts_[static_cast<std::size_t>(limit)]; }

  LimitsHit& operator+=(const LimitsHit& other) {
    for (std::size_t i = 0; i < kLimits; ++i) counts_[i] += other.counts_[i];
    return *this;
  }
  /// Returns the sum of all counts without those of limits that act by design.
  std::uint32_t sum() const {
    std::uint32_t sum = 0;
    for_each(
        [&](const LimitText& text, std::uint32_t count) { sum += text.by_design ? 0 : count; });
    return sum;
  }
  /// Calls `visit(text, count)` for each limit that was reached, in the order of Limit.
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (std::size_t i = 0; i < kLimits; ++i)
      if (counts_[i] > 0) visit(kLimitTexts[i], counts_[i]);
  }

  /// Returns the fields, for saved states.
  static auto fields(auto& self) { return std::tie(self.counts_); }

 private:
  std::array<std::uint32_t, kLimits> counts_ = {};
};

}  // namespace sunder
