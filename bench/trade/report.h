// What a study found, for people, for spreadsheets and for programs: data in, text out.
#pragma once

#include <string>

#include "bench/trade/merge.h"

namespace sunder::bench {

/// A line a point and scene, a column for each error over its noise; what is not known is empty.
std::string trade_csv(const Trade& trade);
/// The same, with distances and noise, nested.
std::string trade_json(const Trade& trade);
/// The points of a scene: error over cost, the front drawn, presets named.
std::string trade_svg(const SceneTrade& scene);
/// All of it on one page that needs nothing beside it.
std::string trade_html(const Trade& trade);
/// For the terminal.
std::string trade_table(const Trade& trade);

}  // namespace sunder::bench
