// Results of a run: a hash of all its states, and statistics (stage timings, counts, energy,
// penetration) as a table and as JSON.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/model/frame.h"
#include "engine/model/scene.h"

namespace sunder {

class Archive;

/// Collects the hash of every frame.
class StateHash final : public FrameSink {
 public:
  void take(const FramePtr& frame) override;
  /// Returns 16 hexadecimal digits: the hash over the first `frames` frames, at most all of them.
  std::string hex(std::size_t frames = SIZE_MAX) const;
  /// Returns the hash of each frame.
  const std::vector<std::uint64_t>& per_frame() const { return per_frame_; }

  /// Returns the fields, for saved states.
  static auto fields(auto& self) { return std::tie(self.per_frame_); }

 private:
  std::vector<std::uint64_t> per_frame_;
};

/// Description of a run, which is copied into the JSON.
struct RunInfo {
  std::string scene;
  std::string preset;
  int threads = 1;
  Accuracy accuracy;
  std::map<std::string, std::string> modelled;  ///< feature -> "on" | "off" | "off: reason"
  SolverOptions solver;                         ///< `lanes` is the number in use.
  std::vector<std::string> warnings = {};
};

/// Returns a warning that breaks left `convexes` whole because their parts did not sum to their
/// volume; `volume_m3` is their volume, `of_m3` that of all solids.
std::string uncut_convexes_warning(std::uint64_t convexes, double volume_m3, double of_m3);

/// Returns a warning that names the limits that were reached, their effects, and what to do; empty
/// if there are none. `hits` is the sum of FrameReport::limits_hit: of a recording, which has no
/// names, it is all that is known.
std::string limits_warning(const LimitsHit& limits, std::uint32_t hits);

/// Returns the processor's model name.
std::string cpu_name();

/// Returns the q-th quantile (0 to 1) by the nearest-rank rule; 0 without values.
double quantile(std::vector<double> values, double q);

/// Collects the reports of all frames. Timings leave out the first frame, which simulates no time.
class Statistics final : public FrameSink {
 public:
  /// Collects frames of the run that `info` describes.
  explicit Statistics(RunInfo info);
  ~Statistics() override;
  void take(const FramePtr& frame) override;

  /// Returns the description of the run.
  const RunInfo& info() const;
  /// Returns a warning if limits were reached; else an empty string.
  std::string limits_warning() const;
  /// Returns the number of convexes that breaks left whole, and their volume in m³.
  std::pair<std::uint64_t, double> failed() const;
  /// Returns the `simulate` and `bench` object (README, "JSON") with a final newline. An empty
  /// `state_hash` is omitted; `per_frame` adds an array with an object per frame.
  std::string json(const std::string& state_hash, bool per_frame) const;
  /// Returns a readable table of stage timings, and the final counts.
  std::string table() const;

  /// Writes or reads the preset and all that was collected, times included.
  friend void archive(Archive& bytes, Statistics& statistics);

 private:
  struct Series;
  std::unique_ptr<Series> series_;
};

}  // namespace sunder
