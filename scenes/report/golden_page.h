// The style sheet and script of the page of golden_report(), embedded as strings (sunder_embed).
#pragma once

namespace sunder::scenes::golden_page {

extern const char* const golden_report_css;
extern const char* const golden_report_js;

}  // namespace sunder::scenes::golden_page
