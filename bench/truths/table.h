// Truths measured at every preset, as a table. A missed mark is flagged, and so is a bound that
// tests hold it to.
#pragma once

#include "bench/truths/truth.h"

namespace sunder::truths {

/// The program that prints them:
///   [--only SUBSTRING] [--preset NAME] [--markdown] [--json FILE|-]
int table_main(int argc, char** argv, const Truths& truths);

}  // namespace sunder::truths
