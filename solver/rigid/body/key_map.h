// A map from 64-bit keys to slots, by open addressing. Nothing iterates over it, so its order has
// no effect on results.
#pragma once

#include <cstdint>
#include <tuple>
#include <vector>

namespace sunder::solver {

class KeyMap {
 public:
  static constexpr std::uint32_t kAbsent = 0xffffffff;

  /// Returns the slot of a key, or kAbsent.
  std::uint32_t find(std::uint64_t key) const;
  bool contains(std::uint64_t key) const { return find(key) != kAbsent; }
  /// Inserts a key that the map does not have.
  void insert(std::uint64_t key, std::uint32_t slot);
  void erase(std::uint64_t key);  ///< Erases a key that the map has.
  void expect(std::size_t more);  ///< Reserves memory for `more` keys.

  static auto fields(auto& self) { return std::tie(self.entries_, self.count_); }
  /// Returns the number of keys.
  std::size_t size() const { return count_; }
  /// Returns the name of a field that is wrong, for saved states; null if none is.
  const char* wrong_field() const;

 private:
  struct Entry {
    std::uint64_t key = kEmpty;
    std::uint32_t slot = kAbsent;
  };
  std::size_t home(std::uint64_t key) const;
  void grow(std::size_t size);

  static constexpr std::uint64_t kEmpty = ~std::uint64_t{0};
  std::vector<Entry> entries_;
  std::size_t count_ = 0;
};

}  // namespace sunder::solver
