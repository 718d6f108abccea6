// Sorting of evenly distributed items in linear time.
#pragma once

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace sunder::fracture {

/// Sorts `items` by distributing them to `buckets` buckets and sorting each bucket by `less`: in
/// linear time if `bucket`, which maps an item to a number below `buckets`, is evenly distributed.
/// Items of different buckets are in the order of their buckets.
template <class T, class Bucket, class Less>
void bucket_sort(std::vector<T>& items, std::size_t buckets, const Bucket& bucket,
                 const Less& less) {
  std::vector<std::size_t> ends(buckets + 1, 0);
  for (const T& item : items) ++ends[bucket(item) + 1];
  for (std::size_t b = 0; b < buckets; ++b) ends[b + 1] += ends[b];
  std::vector<T> sorted(items.size());
  for (const T& item : items) sorted[ends[bucket(item)]++] = item;
  for (std::size_t b = 0, begin = 0; b < buckets; begin = ends[b++]) {
    std::sort(sorted.begin() + static_cast<std::ptrdiff_t>(begin),
              sorted.begin() + static_cast<std::ptrdiff_t>(ends[b]), less);
  }
  items = std::move(sorted);
}

}  // namespace sunder::fracture
