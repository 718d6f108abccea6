// What a run comes to: a hash of all its states, and its figures (stage timings, counts, energy,
// penetration) as a table and as JSON.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "engine/model/frame.h"
#include "engine/model/scene.h"

namespace sunder {

/// Keeps the hash of every frame it takes.
class StateHash final : public FrameSink {
 public:
  void take(const FramePtr& frame) override;
  /// 16 hexadecimal digits, over the first so many frames, or all so far if there are fewer.
  std::string hex(std::size_t frames = SIZE_MAX) const;
  const std::vector<std::uint64_t>& per_frame() const { return per_frame_; }

 private:
  std::vector<std::uint64_t> per_frame_;
};

/// What the figures are of; goes into the JSON as it is.
struct RunInfo {
  std::string scene;
  std::string preset;
  int threads = 1;
  Accuracy accuracy;
  std::map<std::string, std::string> modelled;  ///< feature -> "on" | "off" | "off: why"
  SolverDials solver;                           ///< `lanes` as used.
  std::vector<std::string> warnings = {};
};

/// What to warn of when breaks have left convexes whole because their parts did not add up: how
/// many, and what share of the volume of all solids that is.
std::string left_whole_warning(std::uint64_t convexes, double volume_m3, double of_m3);

/// Warning of limits of the scene that were reached that often; empty for never.
std::string limits_warning(std::uint32_t hits);

/// The processor this runs on, as it calls itself.
std::string cpu_name();

/// The q-th quantile (0..1) by the nearest-rank rule; 0 of nothing.
double quantile(std::vector<double> values, double q);

/// Collects the reports of every frame; timings leave out the first, which is no simulated time.
class Statistics final : public FrameSink {
 public:
  explicit Statistics(RunInfo info);
  ~Statistics() override;
  void take(const FramePtr& frame) override;

  /// What to warn of if a limit of the scene was reached; else empty.
  std::string limits_warning() const;
  /// The `simulate` and `bench` object (README, "JSON"), ending with a newline. An empty
  /// `state_hash` is left out; `per_frame` adds an array with an object a frame.
  std::string json(const std::string& state_hash, bool per_frame) const;
  /// The stage timing table and the final counts, for people.
  std::string table() const;

 private:
  struct Series;
  std::unique_ptr<Series> series_;
};

}  // namespace sunder
