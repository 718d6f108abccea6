#include "engine/io/figures.h"

#include <type_traits>

#include <nlohmann/json.hpp>

#include "engine/base/check.h"

namespace sunder {
namespace {

constexpr int kDeepest = 100;

}  // namespace

Figures parse_figures(const std::string& text, const std::string& file) {
  using Json = nlohmann::json;
  const auto is_shallow = [&](int depth, Json::parse_event_t, const Json&) {
    if (depth > kDeepest) throw InputError(file + ": lists in lists, deeper than any of ours");
    return true;
  };
  const Json document = Json::parse(text, is_shallow, false);
  if (document.is_discarded()) throw InputError(file + ": not a JSON document");
  const Json flat = document.flatten();  // calls itself for what is nested
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
  return document.dump(2) + "\n";
}

}  // namespace sunder
