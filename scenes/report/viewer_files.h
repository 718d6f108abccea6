// The files of the viewer, embedded by CMake.
#pragma once

namespace sunder::scenes::viewer_files {

extern const char* const page_html;
extern const char* const page_css;
extern const char* const glb_js;
extern const char* const motion_js;
extern const char* const stage_js;
extern const char* const player_js;

}  // namespace sunder::scenes::viewer_files
