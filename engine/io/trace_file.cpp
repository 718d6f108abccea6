#include "engine/io/trace_file.h"

#include <set>

#include <nlohmann/json.hpp>

namespace sunder {

std::string format_trace(std::span<const TracedSpan> spans) {
  using Json = nlohmann::ordered_json;
  Json events = Json::array();
  std::set<int> threads;
  for (const TracedSpan& span : spans) {
    threads.insert(span.thread);
    events.push_back({{"name", span.name},
                      {"ph", "X"},
                      {"ts", span.begin_us},
                      {"dur", span.duration_us},
                      {"pid", 1},
                      {"tid", span.thread}});
  }
  for (const int thread : threads) {
    events.push_back({{"name", "thread_name"},
                      {"ph", "M"},
                      {"pid", 1},
                      {"tid", thread},
                      {"args", {{"name", "thread " + std::to_string(thread)}}}});
  }
  return Json{{"displayTimeUnit", "ms"}, {"traceEvents", events}}.dump() + "\n";
}

}  // namespace sunder
