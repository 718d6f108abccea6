#include "scenes/app/bench_report.h"

#include <algorithm>
#include <iterator>
#include <numeric>

#include "engine/io/page.h"
#include "engine/io/plot.h"

namespace sunder::app {
namespace {

constexpr std::size_t kBins = 12;

double frame_ms(const StageTimes::Stages& stages) {
  return std::accumulate(stages.begin(), stages.end(), 0.0);
}

std::string stages_plot(const TimedScene& scene) {
  std::vector<Curve> curves = {{"frame", {}}};
  for (const char* stage : kStageNames) curves.push_back({stage, {}});
  for (std::size_t i = 0; i < scene.frames.size(); ++i) {
    const double time_s = static_cast<double>(i + 1) / 60;
    curves[0].points.push_back({time_s, frame_ms(scene.frames[i])});
    for (std::size_t stage = 0; stage < kStages; ++stage) {
      curves[stage + 1].points.push_back({time_s, scene.frames[i][stage]});
    }
  }
  return svg_curves({scene.name, {"simulated time, s"}, {"ms a frame"}}, curves);
}

std::string histogram(const TimedScene& scene) {
  double most = 0;
  for (const StageTimes::Stages& stages : scene.frames) most = std::max(most, frame_ms(stages));
  const double width = std::max(most, 1e-9) / kBins;
  std::vector<Bar> bars;
  for (std::size_t i = 0; i < kBins; ++i) {
    bars.push_back({"to " + rounded(width * static_cast<double>(i + 1)), 0});
  }
  for (const StageTimes::Stages& stages : scene.frames) {
    ++bars[std::min(kBins - 1, static_cast<std::size_t>(frame_ms(stages) / width))].value;
  }
  return svg_bars({"", {"ms a frame"}, {"frames"}}, bars);
}

}  // namespace

void StageTimes::take(const FramePtr& frame) {
  if (frame->index > 0)
    std::copy_n(frame->report.stage_ms, kStages, frames_.emplace_back().begin());
}

std::string bench_page(std::span<const TimedScene> scenes) {
  std::string body = "<h1>Frame timing</h1>\n";
  for (const TimedScene& scene : scenes) {
    body += "<section>\n<h2>" + escaped(scene.name) + "</h2>\n" + stages_plot(scene) +
            histogram(scene) + "</section>\n";
  }
  return html_page({"Sunder: frame timing", body});
}

}  // namespace sunder::app
