// A scene on its way through the program: built, limited to some frames, watched.
#pragma once

#include <chrono>
#include <memory>
#include <span>
#include <string>

#include "engine/io/statistics.h"
#include "engine/model/frame.h"
#include "scenes/app/commands.h"
#include "scenes/make_simulation.h"

namespace sunder::app {

/// A scene's simulation as the program has it: warnings go to stderr, breaks that went wrong to
/// sunder-cases/. `inspect`: for a view mode that looks inside.
std::unique_ptr<FrameSource> make_simulation(Scene scene, bool inspect = false);
/// Index of the last frame: `wanted`, or, if that is negative, where the scene ends. Throws
/// InputError if it ends before `wanted`; `asked` is how that was said.
int last_frame(const Scene& scene, int wanted, const std::string& asked = "");

/// The frames 0 to `last` of another source.
class FramesUntil final : public FrameSource {
 public:
  FramesUntil(FrameSource& source, int last) : source_(source), left_(last + 1) {}
  FramePtr next() override { return left_-- > 0 ? source_.next() : nullptr; }

 private:
  FrameSource& source_;
  int left_;
};

/// Hands on the frames from `first` on.
class FramesFrom final : public FrameSink {
 public:
  FramesFrom(FrameSink& sink, std::uint64_t first) : sink_(sink), first_(first) {}
  void take(const FramePtr& frame) override {
    if (frame->index >= first_) sink_.take(frame);
  }
  void finish() override { sink_.finish(); }

 private:
  FrameSink& sink_;
  std::uint64_t first_;
};

/// Makes an interrupt (Ctrl-C), a termination or a terminal that goes be kept in stop_signal(); a
/// second one ends the program at once.
void catch_stop_signals();
/// The signal that was caught; 0: none.
int stop_signal();
/// Makes signals end this process as usual again, and forgets what was caught.
void release_stop_signals();

/// As pump(); but an interrupt (Ctrl-C), a termination or a terminal that goes ends it after the
/// frame under way, and what the sinks have is finished as if the source had ended there. A second
/// one ends the program at once. The exit code: 0, or 128 and the signal.
int pump_until_stopped(FrameSource& source, std::span<FrameSink* const> sinks);

/// Says on stderr how far the run is and how long it will take: a bar on a terminal, otherwise a
/// line now and then.
class Progress final : public FrameSink {
 public:
  Progress(std::string title, int last_frame, bool quiet);
  void take(const FramePtr& frame) override;
  void finish() override;

 private:
  std::string line(int frame) const;

  std::string title_;
  int last_;
  bool quiet_;
  bool terminal_;
  int next_report_ = 0;
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace sunder::app
