// The page that golden_report() fills in, compiled in as a string (sunder_embed).
#pragma once

namespace sunder::render::golden_page {

extern const char* const golden_report_html;

}  // namespace sunder::render::golden_page
