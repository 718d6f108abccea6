// A pointer to an object of an interface that has the value of the object: its copy owns a copy.
#pragma once

#include <memory>
#include <utility>

namespace sunder {

class Archive;

/// Owns an object, or none. T has a function `std::unique_ptr<T> copy() const`.
template <class T>
class CopiedPtr {
 public:
  CopiedPtr() = default;
  CopiedPtr(std::unique_ptr<T> owned) : owned_(std::move(owned)) {}
  CopiedPtr(const CopiedPtr& other) : owned_(other.owned_ ? other.owned_->copy() : nullptr) {}
  CopiedPtr(CopiedPtr&&) noexcept = default;
  CopiedPtr& operator=(CopiedPtr other) noexcept {
    owned_ = std::move(other.owned_);
    return *this;
  }
  ~CopiedPtr() = default;

  explicit operator bool() const { return owned_ != nullptr; }
  T& operator*() const { return *owned_; }
  T* operator->() const { return owned_.get(); }

  /// Writes or reads the state of the object, if there is one, by its archive().
  friend void archive(Archive& bytes, CopiedPtr& pointer) {
    if (pointer) pointer->archive(bytes);
  }

 private:
  std::unique_ptr<T> owned_;
};

}  // namespace sunder
