// The page that shows what golden tests saw.
#pragma once

#include <string>
#include <vector>

#include "scenes/app/golden_file.h"

namespace sunder::app {

/// One self-contained HTML page: baseline, picture and error map of every result, side by side.
std::string golden_page(const std::vector<GoldenResult>& results);

}  // namespace sunder::app
