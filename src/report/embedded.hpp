#pragma once

#include <string_view>

/// The files under assets/ and the plotting library, written into the program by cmake/MstslEmbed.cmake.
namespace mstsl::report::embedded {

extern const std::string_view page_html, page_css;
extern const std::string_view common_js, summary_js, paper_js, map_js, replay_js;
extern const std::string_view uplot_js, uplot_css;

}  // namespace mstsl::report::embedded
