#include "scenes/app/run.h"

#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <ctime>

#include "engine/base/check.h"
#include "engine/io/unfinished_file.h"

namespace sunder::app {
namespace {

volatile std::sig_atomic_t caught = 0;

constexpr int kStopSignals[] = {SIGINT, SIGTERM, SIGHUP};

/// Signals within this time of the first are the same request: timeout(1), and a shell that passes
/// on Ctrl-C, send each signal to the program and once more to its process group.
constexpr std::int64_t kSameRequestNs = 500'000'000;

std::int64_t monotonic_ns() {  // std::chrono isn't among what a signal handler may call
  timespec now = {};
  ::clock_gettime(CLOCK_MONOTONIC, &now);
  return now.tv_sec * std::int64_t{1'000'000'000} + now.tv_nsec;
}

void clean_up_and_end(int signal) {
  remove_unfinished_files();
  ::signal(signal, SIG_DFL);
  ::raise(signal);  // delivered when this handler returns
}

void catch_stop_signal(int signal) {
  static std::atomic<std::int64_t> first_ns = 0;
  static_assert(decltype(first_ns)::is_always_lock_free);
  const std::int64_t now_ns = monotonic_ns();
  if (caught == 0) {
    first_ns = now_ns;
  } else if (now_ns - first_ns > kSameRequestNs) {
    clean_up_and_end(signal);
  }
  caught = signal;
}

/// Sets the handler of a signal, unless the signal is ignored and `ignored_stays` is true.
void handle(int signal, void (*handler)(int), bool ignored_stays) {
  struct sigaction action = {}, before = {};
  action.sa_handler = handler;
  ::sigaction(signal, nullptr, &before);
  if (before.sa_handler != SIG_IGN || !ignored_stays) ::sigaction(signal, &action, nullptr);
}

/// A source of another source's frames that ends when a stop signal is caught.
class StoppableSource final : public FrameSource {
 public:
  explicit StoppableSource(FrameSource& source) : source_(source) { catch_stop_signals(); }
  FramePtr next() override { return caught == 0 ? source_.next() : nullptr; }

 private:
  FrameSource& source_;
};

}  // namespace

void clean_up_on_signals() {
  for (const int signal : kStopSignals) handle(signal, clean_up_and_end, true);
  handle(SIGPIPE, clean_up_and_end, true);
}

void catch_stop_signals() {
  for (const int signal : kStopSignals)
    handle(signal, catch_stop_signal, signal == SIGHUP);  // nohup ignores it
}

int stop_signal() { return caught; }

void release_stop_signals() {
  caught = 0;
  clean_up_on_signals();
}

int pump_until_stopped(FrameSource& source, std::span<FrameSink* const> sinks) {
  StoppableSource stoppable(source);
  pump(stoppable, sinks);
  return caught == 0 ? 0 : 128 + caught;
}

scenes::SimulationOptions simulation_options(scenes::SimulationOptions options) {
  options.cases_folder = "sunder-cases";
  options.warn = [](const std::string& warning) {
    std::fprintf(stderr, "warning: %s\n", warning.c_str());
  };
  return options;
}

std::unique_ptr<FrameSource> make_simulation(Scene scene, scenes::SimulationOptions options) {
  return scenes::make_simulation(std::move(scene), simulation_options(std::move(options)));
}

int last_frame(const Scene& scene, int wanted, const std::string& option) {
  const int last = static_cast<int>(std::lround(scene.duration_s * 60));
  if (wanted > last) {
    throw InputError(option + ": " + scene.name + " ends with frame " + std::to_string(last));
  }
  return wanted < 0 ? last : wanted;
}

Progress::Progress(std::string title, int last_frame, bool quiet)
    : title_(std::move(title)), last_(last_frame), quiet_(quiet), terminal_(isatty(2) == 1) {}

std::string Progress::line(int frame) const {
  const double elapsed_s =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  const double left_s = frame > 0 ? elapsed_s / frame * (last_ - frame) : 0;
  char text[160];
  std::snprintf(text, sizeof text, "%s: frame %d of %d, %.0f s left", title_.c_str(), frame, last_,
                left_s);
  return text;
}

void Progress::take(const FramePtr& frame) {
  const int index = static_cast<int>(frame->index);
  if (quiet_ || last_ <= 0 || index < next_report_) return;
  if (terminal_) {
    constexpr int kWidth = 30;
    const auto done = static_cast<std::size_t>(std::min(kWidth, kWidth * index / last_));
    std::fprintf(stderr, "\r[%s%s] %s\033[K", std::string(done, '#').c_str(),
                 std::string(kWidth - done, ' ').c_str(), line(index).c_str());
    next_report_ = index + 1;
  } else {
    if (index > 0) std::fprintf(stderr, "%s\n", line(index).c_str());
    next_report_ = index + std::max(1, last_ / 5);
  }
}

void Progress::finish() {
  if (!quiet_ && terminal_) std::fputs("\n", stderr);
}

}  // namespace sunder::app
