// Table of validation cases at every preset, which marks missed targets and exceeded bounds.
#pragma once

#include "bench/truths/truth.h"

namespace sunder::truths {

/// Main function of the commands that print validation cases:
///   [--only SUBSTRING] [--preset NAME] [--markdown] [--json FILE|-]
int table_main(int argc, char** argv, const Truths& truths);

}  // namespace sunder::truths
