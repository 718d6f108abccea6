// Text in the corner of an image.
#pragma once

#include <string>

#include "engine/model/frame.h"
#include "render/image/image.h"

namespace sunder::render {

/// Returns the frame number and time, and the counts of `frame`, in two lines.
std::string hud_text(const Frame& frame);
/// Draws ASCII text at the top left, white with a shadow.
void draw_text(Image& image, const std::string& text);

}  // namespace sunder::render
