// Words in the corner of a picture.
#pragma once

#include <string>

#include "engine/model/frame.h"
#include "render/image/image.h"

namespace sunder::render {

/// Frame number, time and counts of `frame`, a line each.
std::string hud_text(const Frame& frame);
/// Writes ASCII text, top left, white with a shadow.
void draw_text(Image& image, const std::string& text);

}  // namespace sunder::render
