// Slots: indices into the arrays over bodies, shapes, pairs and manifolds, each with a type of its
// own; and vectors that only slots of their own type can index.
#pragma once

#include <cstddef>
#include <span>
#include <type_traits>
#include <vector>

#include "engine/base/types.h"

namespace sunder::solver {

using BodySlot = Index<struct BodySlotTag>;
using ShapeSlot = Index<struct ShapeSlotTag>;
using PairSlot = Index<struct PairSlotTag>;
using ManifoldSlot = Index<struct ManifoldSlotTag>;

/// Range of the first `count` slots, in order.
template <class Slot>
class Slots {
 public:
  struct Iterator {
    Slot slot;

    Slot operator*() const { return slot; }
    Iterator& operator++() {
      ++slot.value;
      return *this;
    }
    bool operator==(const Iterator&) const = default;
  };
  explicit Slots(std::size_t count) : end_(count) {}
  Iterator begin() const { return {Slot(0)}; }
  Iterator end() const { return {end_}; }

 private:
  Slot end_;
};

template <class Slot, class T>
class SlotVector : public std::vector<T> {
 public:
  using std::vector<T>::vector;

  T& operator[](Slot slot) { return std::vector<T>::operator[](slot.value); }
  const T& operator[](Slot slot) const { return std::vector<T>::operator[](slot.value); }
  Slots<Slot> slots() const { return Slots<Slot>(this->size()); }
};

template <class Slot, class T>
class SlotSpan : public std::span<T> {
  using Vector = SlotVector<Slot, std::remove_const_t<T>>;

 public:
  SlotSpan() = default;
  SlotSpan(std::conditional_t<std::is_const_v<T>, const Vector, Vector>& all) : std::span<T>(all) {}

  T& operator[](Slot slot) const { return std::span<T>::operator[](slot.value); }
};

template <class T>
using ByBody = SlotVector<BodySlot, T>;
template <class T>
using ByShape = SlotVector<ShapeSlot, T>;
/// View of a SlotVector that neither adds nor removes items.
template <class T>
using SpanByBody = SlotSpan<BodySlot, T>;

}  // namespace sunder::solver
