// Shared by the commands that simulate: the simulation, limits of frames, stop signals, progress.
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

/// Returns options for a simulation of the program: warnings go to stderr, and case files of failed
/// breaks to sunder-cases/, whatever `options` has for them.
scenes::SimulationOptions simulation_options(scenes::SimulationOptions options = {});
/// Makes the simulation of a scene, with simulation_options().
std::unique_ptr<FrameSource> make_simulation(Scene scene, scenes::SimulationOptions options = {});
/// Returns the index of the last frame: `wanted`, or the last of the scene if that is negative.
/// Throws InputError that begins with `option` if the scene ends before.
int last_frame(const Scene& scene, int wanted, const std::string& option = "");

/// A source of the frames 0 to `last` of another source.
class FramesUntil final : public FrameSource {
 public:
  FramesUntil(FrameSource& source, int last) : source_(source), left_(last + 1) {}
  FramePtr next() override { return left_-- > 0 ? source_.next() : nullptr; }

 private:
  FrameSource& source_;
  int left_;
};

/// A sink that passes the frames from index `first` on to another sink.
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

/// From now on SIGINT, SIGTERM, SIGHUP and SIGPIPE remove all files that are not complete
/// (engine/io/unfinished_file.h) before they end the program. Those that are ignored stay so.
void clean_up_on_signals();
/// Catches SIGINT, SIGTERM and SIGHUP from now on, for stop_signal(). Another one that comes more
/// than half a second after the first ends the program at once, and removes files that are not
/// complete. SIGHUP stays ignored if it is.
void catch_stop_signals();
/// Returns the last signal that was caught; 0 if none was.
int stop_signal();
/// Has the signals end the program again, as after clean_up_on_signals(), and resets stop_signal()
/// to 0.
void release_stop_signals();

/// Pumps frames as pump() does, but ends after the current frame when a stop signal is caught, and
/// finishes the sinks as if the source had ended there. Catches the signals. Returns the exit code:
/// 0, or 128 plus the signal.
int pump_until_stopped(FrameSource& source, std::span<FrameSink* const> sinks);

/// Shows the progress of a run on stderr: a bar on a terminal, otherwise a line every fifth of it.
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
