#include "mstsl/report/page.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "embedded.hpp"
#include "encode.hpp"
#include "run_json.hpp"

namespace mstsl::report {
namespace {

using Places = std::vector<const TracedPlace*>;

/// The element that holds packed data under an id.
std::string packed_element(const std::string& id, const std::string& json) {
  return fmt::format("<script type=\"text/plain\" id=\"{}\">{}</script>\n", id, deflated(json));
}

std::string run_elements(const std::vector<RunTrace>& runs) {
  Places places;
  std::string elements;
  for (std::size_t i = 0; i < runs.size(); ++i) {
    assert(runs[i].place);
    auto known = std::ranges::find(places, runs[i].place.get());
    const auto place = static_cast<std::size_t>(known - places.begin());
    if (known == places.end()) {
      places.push_back(runs[i].place.get());
      elements += packed_element(fmt::format("place-{}", place), place_json(*runs[i].place));
    }
    elements += packed_element(fmt::format("run-{}", i), run_json(runs[i], place));
  }
  return elements;
}

std::string names_json(const std::vector<RunTrace>& runs) {
  nlohmann::json names = nlohmann::json::array();
  for (const RunTrace& run : runs) names.push_back(run.name);
  return names.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string program() {
  std::string text;
  for (const std::string_view part :
       {embedded::common_js, embedded::summary_js, embedded::paper_js, embedded::map_js, embedded::replay_js})
    text += part;
  return text;
}

/// The page with each {{name}} replaced; what is put in is not looked at again.
std::string filled(std::string_view page,
                   const std::vector<std::pair<std::string_view, std::string>>& texts) {
  std::string out;
  while (!page.empty()) {
    const std::size_t open = page.find("{{"), close = page.find("}}", open);
    out += page.substr(0, open);
    if (open == std::string_view::npos) break;
    const std::string_view name = page.substr(open + 2, close - open - 2);
    const auto text = std::ranges::find(texts, name, &std::pair<std::string_view, std::string>::first);
    assert(close != std::string_view::npos && text != texts.end());
    out += text->second;
    page.remove_prefix(close + 2);
  }
  return out;
}

}  // namespace

std::string html(const Page& page) {
  return filled(embedded::page_html,
                {{"title", escaped(page.title)},
                 {"subtitle", escaped(page.subtitle)},
                 {"plot_style", std::string(embedded::uplot_css)},
                 {"style", std::string(embedded::page_css)},
                 {"summary", page.summary_json.empty() ? "null" : inside_script(page.summary_json)},
                 {"paper", page.paper_json.empty() ? "null" : inside_script(page.paper_json)},
                 {"run_names", inside_script(names_json(page.runs))},
                 {"runs", run_elements(page.runs)},
                 {"plot_library", std::string(embedded::uplot_js)},
                 {"script", program()}});
}

}  // namespace mstsl::report
