// What each rule buys, as a page and as JSON.
#pragma once

#include <cstdio>
#include <vector>

#include "bench/ablation/trial.h"

namespace sunder::ablation {

/// A truth is better or worse where its error is beyond 1.5 times all that the first `noise` trials
/// came to, and beyond a tenth of its mark.
void print_markdown(const std::vector<Rule>& rules, const std::vector<Trial>& trials,
                    std::size_t noise);
void write_json(const std::vector<Rule>& rules, const std::vector<Trial>& trials, std::FILE* file);

}  // namespace sunder::ablation
