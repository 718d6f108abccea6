// FLIP, a measure of the perceived difference between two images shown in alternation.
#pragma once

#include <vector>

#include "render/image/image.h"

namespace sunder::render {

/// Returns the LDR-FLIP error of every pixel, in [0, 1], for images of one size viewed from 0.7 m
/// on a 0.7 m wide 4K screen (67 pixels per degree). Andersson, Nilsson, Akenine-Möller, Oskarsson,
/// Åström, Fairchild: "FLIP: A Difference Evaluator for Alternating Images", 2020.
std::vector<float> flip_errors(const Image& reference, const Image& actual);

}  // namespace sunder::render
