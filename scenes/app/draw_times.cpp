#include "scenes/app/draw_times.h"

#include <numeric>
#include <string>
#include <utility>

#include "engine/base/cpu_time.h"
#include "engine/base/trace.h"
#include "engine/io/statistics.h"

namespace sunder::app {
namespace {

constexpr int kWidth = 640, kHeight = 360;

void put(const std::string& at, const std::vector<double>& ms, Figures& figures) {
  for (const auto& [figure, q] :
       {std::pair{"p50_ms", 0.5}, {"p95_ms", 0.95}, {"p99_ms", 0.99}, {"max_ms", 1.0}})
    figures[at + figure] = quantile(ms, q);
  figures[at + "mean_ms"] =
      std::accumulate(ms.begin(), ms.end(), 0.0) / static_cast<double>(ms.size());
}

}  // namespace

DrawTimes::DrawTimes(int every)
    : renderer_({.width = kWidth, .height = kHeight}), every_(static_cast<std::uint64_t>(every)) {}

void DrawTimes::take(const FramePtr& frame) {
  if (frame->index % every_ != 0) return;
  const Stopwatch watch;
  const double before_ms = sunder::cpu_ms();
  renderer_.draw(*frame);
  if (frame->index > 0)
    pictures_.push_back({frame->index, watch.ms(), sunder::cpu_ms() - before_ms});
}

Figures DrawTimes::figures() const {
  if (pictures_.empty()) return {};
  Figures figures = {{"/draw/every", static_cast<std::int64_t>(every_)},
                     {"/draw/pictures", static_cast<std::int64_t>(pictures_.size())},
                     {"/draw/width", std::int64_t{kWidth}},
                     {"/draw/height", std::int64_t{kHeight}},
                     {"/draw/renderer", renderer_.description()}};
  std::vector<double> ms, cpu_ms;
  for (const Picture& picture : pictures_) {
    ms.push_back(picture.ms);
    cpu_ms.push_back(picture.cpu_ms);
    const std::string at = "/per_frame/" + std::to_string(picture.frame - 1);
    figures[at + "/draw_ms"] = picture.ms;
    figures[at + "/draw_cpu_ms"] = picture.cpu_ms;
  }
  put("/draw/", ms, figures);
  put("/draw/cpu_", cpu_ms, figures);
  return figures;
}

}  // namespace sunder::app
