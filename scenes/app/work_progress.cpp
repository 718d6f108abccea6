#include "scenes/app/work_progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <utility>

namespace sunder::app {
namespace {

constexpr double kFirstUpdate_s = 0.5;  // elapsed time before which nothing is shown
constexpr double kBetweenLines_s = 2, kBetweenBars_s = 0.1;

}  // namespace

WorkProgress::WorkProgress(std::string title, bool quiet)
    : title_(std::move(title)), quiet_(quiet), terminal_(isatty(2) == 1), next_s_(kFirstUpdate_s) {}

WorkProgress::~WorkProgress() {
  if (drawn_) std::fputs("\r\033[K", stderr);
}

double WorkProgress::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

void WorkProgress::operator()(const char* step, double share) {
  const double now_s = elapsed_s();
  if (quiet_ || now_s < next_s_) return;
  next_s_ = now_s + (terminal_ ? kBetweenBars_s : kBetweenLines_s);
  const double left_s = share > 0 ? now_s * (1 - share) / share : 0;
  if (!terminal_) {
    std::fprintf(stderr, "%s: %s, %.0f%% done, %.0f s left\n", title_.c_str(), step, 100 * share,
                 left_s);
    return;
  }
  constexpr int kWidth = 30;
  const auto done = static_cast<std::size_t>(std::clamp(kWidth * share, 0.0, 1.0 * kWidth));
  std::fprintf(stderr, "\r[%s%s] %s: %s, %.0f s left\033[K", std::string(done, '#').c_str(),
               std::string(kWidth - done, ' ').c_str(), title_.c_str(), step, left_s);
  std::fflush(stderr);
  drawn_ = true;
}

}  // namespace sunder::app
