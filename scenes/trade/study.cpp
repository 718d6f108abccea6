#include "scenes/trade/study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <set>

#include "engine/base/check.h"
#include "engine/base/cpu_time.h"
#include "engine/base/random.h"
#include "engine/io/bytes.h"
#include "scenes/load.h"
#include "scenes/make_simulation.h"

namespace sunder::scenes {
namespace {

int last_frame_of(const Scene& scene, const StudyRun& run) {
  const int end = static_cast<int>(std::lround(scene.duration_s * 60));
  return run.frames < 0 ? end : std::min(run.frames, end);
}

/// Returns which value of a frame is not finite; empty if all are finite.
std::string find_non_finite(const Frame& frame) {
  for (const FrameBody& body : frame.bodies) {
    if (body.X_WB.position.allFinite() && body.X_WB.rotation.coeffs().allFinite() &&
        body.velocity_W.allFinite() && body.angular_velocity_W.allFinite()) {
      continue;
    }
    return "body " + std::to_string(body.key) + " is not finite in frame " +
           std::to_string(frame.index);
  }
  return {};
}

std::string find_non_finite(const Facts& facts) {
  for (const auto& [name, values] : facts.samples) {
    for (const double value : values) {
      if (!std::isfinite(value)) return name + " is not finite";
    }
  }
  return {};
}

double wall_ms() {
  return std::chrono::duration<double, std::milli>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

/// Passes frames from the source to the facts; only the making of frames is timed.
void pump_timed(FrameSource& source, int last, FactsSink& facts, Ran& ran) {
  for (int i = 0; i <= last; ++i) {
    const double cpu = cpu_ms(), wall = wall_ms();
    const FramePtr frame = source.next();
    if (!frame) return;
    if (i > 0) {  // frame 0 is the initial state
      ran.time.cpu_ms += cpu_ms() - cpu;
      ran.time.wall_ms += wall_ms() - wall;
      ++ran.time.frames;
    }
    ran.result.failed = find_non_finite(*frame);
    if (!ran.result.failed.empty()) return;
    facts.take(frame);
  }
}

/// Returns the times of all events of the script, ascending.
std::vector<double> event_times_s(const Scene& scene) {
  std::vector<double> times_s;
  for (const Shot& shot : scene.shots) times_s.push_back(shot.time_s);
  for (const Blast& blast : scene.blasts) times_s.push_back(blast.time_s);
  for (const Removal& removal : scene.removals) times_s.push_back(removal.time_s);
  for (const Drive& drive : scene.drives) {
    times_s.push_back(drive.time_s);
    times_s.push_back(drive.until_s);
  }
  for (const Move& move : scene.moves) times_s.push_back(move.release_s);
  std::ranges::sort(times_s);
  return times_s;
}

/// A world that runs by its script, in frames of which some are longer.
class ShiftedSimulation final : public FrameSource {
 public:
  ShiftedSimulation(Scene scene, int seed)
      : events_s_(event_times_s(scene)),
        random_(static_cast<std::uint64_t>(seed), kPhaseStream),
        world_(make_world(std::move(scene))) {}

  FramePtr next() override {
    if (started_) world_.step(next_time_s());
    started_ = true;
    return world_.frame();
  }

 private:
  static constexpr double kFrame_s = 1.0 / 60;
  static constexpr double kTimeTolerance_s = 1e-9;  // of an event at the end of a frame
  static constexpr std::uint64_t kPhaseStream = 1;

  double next_time_s() {
    bool shifts = world_.time_s() == 0;
    for (; next_event_ < events_s_.size() &&
           events_s_[next_event_] <= world_.time_s() + kTimeTolerance_s;
         ++next_event_)
      shifts = true;
    return shifts ? kFrame_s * (1 + random_.uniform()) : kFrame_s;
  }

  std::vector<double> events_s_;
  Random random_;
  World world_;
  bool started_ = false;
  std::size_t next_event_ = 0;
};

}  // namespace

std::unique_ptr<FrameSource> make_shifted_simulation(Scene scene, int seed) {
  return std::make_unique<ShiftedSimulation>(std::move(scene), seed);
}

std::string StudyRun::name() const { return scene + "/" + point.name + "-" + std::to_string(seed); }

int StudyRun::scene_seed() const {
  const char* const limits[] = {kLimit, kLimit2h, kLimit4h};
  const auto limit = std::ranges::find(limits, point.name) - std::begin(limits);
  return limit == std::ssize(limits) ? seed : seed + kMaxSeeds * static_cast<int>(limit + 1);
}

std::vector<StudyRun> study_runs(const Study& study) {
  std::vector<StudyRun> runs;
  std::set<std::string> names;
  for (const std::string& scene : study.scenes) {
    StudyRun run;
    run.scene_file = scene_file(scene);
    run.scene = run.scene_file.stem().string();
    if (!names.insert(run.scene).second) {
      throw InputError(scene + ": duplicate scene name " + run.scene +
                       "; rename the file, because results are stored by name");
    }
    char hash[17];
    std::snprintf(
        hash, sizeof hash, "%016llx",
        static_cast<unsigned long long>(hash_bytes(read_file(run.scene_file, file_kinds::kScene))));
    run.scene_hash = hash;
    run.frames = study.frames;
    for (run.seed = 1; run.seed <= study.seeds; ++run.seed) {
      for (const StudyPoint& point : study.points) {
        run.point = point;
        run.set = study.set;
        run.set.insert(run.set.end(), point.set.begin(), point.set.end());
        run.set.push_back("scene.seed=" + std::to_string(run.scene_seed()));
        runs.push_back(run);
      }
    }
  }
  return runs;
}

Shard parse_shard(const std::string& text) {
  Shard shard;
  char rest = 0;
  if (std::sscanf(text.c_str(), "%d/%d%c", &shard.index, &shard.count, &rest) != 2 ||
      shard.index < 1 || shard.index > shard.count) {
    throw InputError("--shard " + text + ": expected I/N, the I-th of N shares, 1 <= I <= N");
  }
  return shard;
}

std::vector<StudyRun> share_of(const std::vector<StudyRun>& runs, const Shard& shard) {
  std::vector<StudyRun> share;
  const auto count = static_cast<std::size_t>(shard.count);
  for (auto i = static_cast<std::size_t>(shard.index - 1); i < runs.size(); i += count) {
    share.push_back(runs[i]);
  }
  return share;
}

Scene load_scene(const StudyRun& run) {
  return load_scene(run.scene_file.string(), {run.point.preset, run.set});
}

double work_of(const Scene& scene, const StudyRun& run) {
  const double steps = last_frame_of(scene, run) / 60.0 / scene.accuracy.dt_s;
  return steps * (1 + scene.accuracy.substeps * scene.solver.sweeps) *
         static_cast<double>(1 + scene.solids.size() + scene.balls.size());
}

Ran measure(const std::function<std::unique_ptr<FrameSource>()>& begin, int last) {
  Ran ran;
  std::string& failed = ran.result.failed;
  try {
    const auto source = begin();
    FactsSink facts;
    pump_timed(*source, last, facts, ran);
    if (failed.empty()) {
      facts.finish();
      ran.result.facts = facts.facts();
      failed = find_non_finite(ran.result.facts);
    }
  } catch (const std::exception& error) {
    failed = error.what();
  }
  if (!failed.empty()) ran.result.facts = {};
  const int frames = std::max(1, ran.time.frames);
  ran.time.cpu_ms /= frames;
  ran.time.wall_ms /= frames;
  return ran;
}

Ran carry_out(const StudyRun& run) {
  Scene scene = load_scene(run);
  const int last = last_frame_of(scene, run);
  return measure([&] { return make_shifted_simulation(std::move(scene), run.scene_seed()); }, last);
}

}  // namespace sunder::scenes
