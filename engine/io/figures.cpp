#include "engine/io/figures.h"

#include <type_traits>

#include <nlohmann/json.hpp>

#include "engine/base/check.h"

namespace sunder {
namespace {

constexpr int kMaxDepth = 100;

}  // namespace

Figures parse_figures(const std::string& text, const std::string& file) {
  using Json = nlohmann::json;
  const auto is_shallow = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > kMaxDepth)
      throw InputError(file + ": JSON is nested too deeply; it is not a file of this program");
    return true;
  };
  const Json document = Json::parse(text, is_shallow, false);
  if (document.is_discarded()) throw InputError(file + ": not a JSON document");
  const Json flat = document.flatten();  // flatten() is recursive
  Figures figures;
  for (const auto& [place, value] : flat.items()) {
    if (value.is_boolean()) figures[place] = value.get<bool>();
    if (value.is_number_integer()) figures[place] = value.get<std::int64_t>();
    if (value.is_number_float()) figures[place] = value.get<double>();
    if (value.is_string()) figures[place] = value.get<std::string>();
  }
  return figures;
}

std::string format_figures(const Figures& figures) {
  nlohmann::json flat = nlohmann::json::object();
  for (const auto& [place, figure] : figures) {
    std::visit(
        [&, &key = place](const auto& value) {
          if constexpr (!std::is_same_v<decltype(value), const EmptyList&>) flat[key] = value;
        },
        figure);
  }
  nlohmann::json document = flat.unflatten();
  for (const auto& [place, figure] : figures) {
    if (!std::holds_alternative<EmptyList>(figure)) continue;
    document[nlohmann::json::json_pointer(place)] = nlohmann::json::array();
  }
  constexpr auto kReplace = nlohmann::json::error_handler_t::replace;  // replaces invalid UTF-8
  return document.dump(2, ' ', false, kReplace) + "\n";
}

std::string add_figures(const std::string& document, const Figures& figures) {
  using Json = nlohmann::ordered_json;
  Json json = Json::parse(document);
  for (const auto& [place, figure] : figures) {
    Json& at = json[Json::json_pointer(place)];
    std::visit(
        [&](const auto& value) {
          if constexpr (std::is_same_v<decltype(value), const EmptyList&>)
            at = Json::array();
          else
            at = value;
        },
        figure);
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

double number_at(const Figures& figures, const std::string& place) {
  const auto found = figures.find(place);
  if (found == figures.end()) return 0;
  if (const auto* whole = std::get_if<std::int64_t>(&found->second)) {
    return static_cast<double>(*whole);
  }
  const auto* real = std::get_if<double>(&found->second);
  return real ? *real : 0;
}

std::string text_at(const Figures& figures, const std::string& place) {
  const auto found = figures.find(place);
  const auto* text = found == figures.end() ? nullptr : std::get_if<std::string>(&found->second);
  return text ? *text : std::string();
}

}  // namespace sunder
