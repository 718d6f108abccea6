// Counting and timing of the parts of stages. Internal to the modules that do the work.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string_view>
#include <tuple>
#include <utility>
#include <vector>

#include "engine/base/archive.h"
#include "engine/base/loop_count.h"
#include "engine/base/trace.h"
#include "engine/model/work.h"

namespace sunder {

/// List of work items: each part of a stage once, in order of its first appearance.
/// Times are not part of a saved state.
inline void archive(Archive& bytes, std::vector<WorkItem>& items) {
  if (bytes.reads()) items.clear();
}

class WorkLog {
 public:
  void add(const WorkItem& item) {
    const auto same = [&](const WorkItem& known) {
      return known.stage == item.stage && std::string_view(known.name) == item.name;
    };
    const auto found = std::ranges::find_if(items_, same);
    if (found == items_.end()) return items_.push_back(item);
    found->count += item.count;
    found->ms += item.ms;
    found->loops += item.loops;
  }
  const std::vector<WorkItem>& items() const { return items_; }
  /// Returns the items and clears the log.
  std::vector<WorkItem> take() { return std::exchange(items_, {}); }

  static auto fields(auto& self) { return std::tie(self.items_); }

 private:
  std::vector<WorkItem> items_;
};

/// Measures a part of a stage from construction to destruction.
class WorkSpan {
 public:
  WorkSpan(WorkLog& log, Stage stage, const char* name)
      : span_(name), log_(log), item_{stage, name, 0, 0, {}} {}
  ~WorkSpan() {
    item_.ms = watch_.ms();
    item_.loops = LoopCount::times() - loops_before_;
    log_.add(item_);
  }
  WorkSpan(const WorkSpan&) = delete;
  WorkSpan& operator=(const WorkSpan&) = delete;
  void count(std::uint64_t more) { item_.count += more; }

 private:
  TraceSpan span_;
  Stopwatch watch_;
  LoopTimes loops_before_ = LoopCount::times();
  WorkLog& log_;
  WorkItem item_;
};

}  // namespace sunder
