// Reports of a study as CSV, JSON, SVG, HTML and text.
#pragma once

#include <string>

#include "scenes/trade/merge.h"

namespace sunder::scenes {

/// Returns a line per point and scene, with a column for the error of each figure.
std::string trade_csv(const Trade& trade);
/// Returns all results as JSON, with differences and spreads.
std::string trade_json(const Trade& trade);
/// Returns a plot of the points of a scene, error over cost, with the front and labelled presets.
std::string trade_svg(const SceneTrade& scene);
/// Returns a self-contained HTML page with all results.
std::string trade_html(const Trade& trade);
/// Returns a table for the terminal.
std::string trade_table(const Trade& trade);

}  // namespace sunder::scenes
