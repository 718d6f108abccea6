// Mistakes of a scene file, collected so that all of them are reported at once.
#pragma once

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "engine/base/check.h"

namespace sunder::scenes {

/// Wrong keys of a scene file, at least one. `what()` is the first message.
class InputErrors : public InputError {
 public:
  explicit InputErrors(std::vector<std::string> all)
      : InputError(all.front()), all_(std::move(all)) {}
  const std::vector<std::string>& all() const { return all_; }

 private:
  std::vector<std::string> all_;
};

/// Messages in the order in which they were found, each once, up to a maximum.
class ErrorList {
 public:
  bool empty() const { return messages_.empty(); }

  /// Calls `work`, and adds the messages of the InputError that it throws, if any. Does nothing
  /// once the list is full.
  template <class Work>
  void collect(const Work& work) {
    run(work, true);
  }
  /// As collect(), but adds an error that is no InputErrors only to an empty list: it may follow
  /// from a mistake that is listed, as a name that is unknown because its table is wrong.
  template <class Work>
  void collect_keys(const Work& work) {
    run(work, false);
  }
  /// Throws InputErrors unless the list is empty.
  void throw_any() const {
    if (!messages_.empty()) throw InputErrors(messages_);
  }

 private:
  static constexpr std::size_t kMost = 50;

  template <class Work>
  void run(const Work& work, bool also_others) {
    if (messages_.size() >= kMost) return;
    try {
      work();
    } catch (const InputErrors& errors) {
      for (const std::string& message : errors.all()) add(message);
    } catch (const InputError& error) {
      if (also_others || messages_.empty()) add(error.what());
    }
  }
  void add(const std::string& message) {
    if (messages_.size() < kMost && std::ranges::find(messages_, message) == messages_.end())
      messages_.push_back(message);
  }

  std::vector<std::string> messages_;
};

}  // namespace sunder::scenes
