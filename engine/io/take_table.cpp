#include "engine/io/take_table.h"

#include <algorithm>

namespace sunder {
namespace {

constexpr std::uint32_t kMostRows = 1 << 21;

// Unsigned arithmetic wraps, so every difference has its way back.
std::int32_t difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
std::int32_t sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

/// Small numbers of either sign become small numbers.
std::uint32_t folded(std::int32_t n) {
  return (static_cast<std::uint32_t>(n) << 1) ^ static_cast<std::uint32_t>(n >> 31);
}
std::int32_t unfolded(std::uint32_t n) {
  return static_cast<std::int32_t>((n >> 1) ^ (0 - (n & 1)));
}

/// How many low bytes the largest number needs, then those bytes, plane by plane.
void put_planes(ByteWriter& out, std::span<const std::uint32_t> numbers) {
  std::uint32_t bits = 0;
  for (const std::uint32_t number : numbers) bits |= number;
  std::uint8_t planes = 0;
  for (; planes < 4 && bits >> (8 * planes) != 0; ++planes) {
  }
  out.put(planes);
  const std::size_t at = out.bytes.size();
  out.bytes.resize(at + planes * numbers.size());
  std::byte* to = out.bytes.data() + at;
  for (std::uint8_t p = 0; p < planes; ++p) {
    for (const std::uint32_t number : numbers) *to++ = static_cast<std::byte>(number >> (8 * p));
  }
}

std::vector<std::uint32_t> take_planes(ByteReader& in, std::size_t count, const std::string& file) {
  const auto planes = in.take<std::uint8_t>();
  if (planes > 4) throw InputError(file + ": corrupt: a column of more than four bytes");
  std::vector<std::uint32_t> numbers(count);
  for (std::uint8_t p = 0; p < planes; ++p) {
    const std::span<const std::byte> plane = in.take_bytes(count);
    for (std::size_t i = 0; i < count; ++i) {
      numbers[i] |= std::to_integer<std::uint32_t>(plane[i]) << (8 * p);
    }
  }
  return numbers;
}

}  // namespace

TableCoder::TableCoder(std::size_t columns, std::size_t gliding) : gliding_(gliding) {
  last_.columns = columns;
}

void TableCoder::reset() {
  last_.numbers.clear();
  pace_.clear();
}

void TableCoder::predict(std::uint32_t before, std::span<std::int32_t> row) const {
  if (before == kNewRow) {
    std::fill(row.begin(), row.end(), 0);
    return;
  }
  std::ranges::copy(last_.row(before), row.begin());
  for (std::size_t c = 0; c < gliding_; ++c) row[c] = sum(row[c], pace_[before * gliding_ + c]);
}

void TableCoder::remember(NumberTable table, std::span<const std::uint32_t> before) {
  std::vector<std::int32_t> pace(before.size() * gliding_);
  for (std::size_t r = 0; r < before.size(); ++r) {
    if (before[r] == kNewRow) continue;
    for (std::size_t c = 0; c < gliding_; ++c) {
      pace[r * gliding_ + c] = difference(table.row(r)[c], last_.row(before[r])[c]);
    }
  }
  pace_ = std::move(pace);
  last_ = std::move(table);
}

/// Row count; a bit a row that says whether it is not as predicted; then of those rows where they
/// were before and, column by column, how far off the prediction is. A row is expected to have
/// been behind the one that the row before it was.
void TableCoder::write(ByteWriter& out, NumberTable table, std::span<const std::uint32_t> before) {
  SUNDER_CHECK(table.columns == last_.columns && before.size() == table.rows());
  const std::size_t columns = table.columns;
  std::vector<std::uint8_t> bits((before.size() + 7) / 8);
  std::vector<std::uint32_t> moved;
  std::vector<std::vector<std::uint32_t>> off(columns);
  std::vector<std::int32_t> predicted(columns);
  std::uint32_t expected = 0;
  for (std::size_t r = 0; r < before.size(); ++r) {
    predict(before[r], predicted);
    const auto row = table.row(r);
    if (before[r] == expected && std::ranges::equal(row, predicted)) {
      ++expected;
      continue;
    }
    bits[r / 8] = static_cast<std::uint8_t>(bits[r / 8] | 1u << (r % 8));
    // 0: as expected; 1: new; more: so far from what was expected.
    const bool is_new = before[r] == kNewRow;
    const auto way = static_cast<std::int32_t>(before[r] - expected);
    moved.push_back(is_new ? 1 : way == 0 ? 0 : folded(way) + 1);
    if (!is_new) expected = before[r] + 1;
    for (std::size_t c = 0; c < columns; ++c) {
      off[c].push_back(folded(difference(row[c], predicted[c])));
    }
  }
  out.put(static_cast<std::uint32_t>(before.size()));
  for (const std::uint8_t byte : bits) out.put(byte);
  put_planes(out, moved);
  for (const auto& column : off) put_planes(out, column);
  remember(std::move(table), before);
}

NumberTable TableCoder::read(ByteReader& in, const std::string& file,
                             std::vector<std::uint32_t>& before) {
  const std::size_t columns = last_.columns;
  const auto rows = in.take<std::uint32_t>();
  if (rows > kMostRows) throw InputError(file + ": corrupt: more rows than a frame can have");
  const std::span<const std::byte> bits = in.take_bytes((std::size_t{rows} + 7) / 8);
  const auto is_off = [&](std::size_t r) {
    return (std::to_integer<std::uint32_t>(bits[r / 8]) >> (r % 8) & 1) != 0;
  };
  std::size_t count = 0;
  for (std::size_t r = 0; r < rows; ++r) count += is_off(r) ? 1 : 0;
  const std::vector<std::uint32_t> moved = take_planes(in, count, file);
  std::vector<std::vector<std::uint32_t>> off(columns);
  for (auto& column : off) column = take_planes(in, count, file);

  NumberTable table{columns, std::vector<std::int32_t>(rows * columns)};
  before.assign(rows, kNewRow);
  std::uint32_t expected = 0;
  for (std::size_t r = 0, i = 0; r < rows; ++r) {
    const bool listed = is_off(r);
    const bool is_new = listed && moved[i] == 1;
    if (!is_new) {
      const std::int32_t way = listed && moved[i] > 1 ? unfolded(moved[i] - 1) : 0;
      before[r] = expected + static_cast<std::uint32_t>(way);
      if (before[r] >= last_.rows()) throw InputError(file + ": corrupt: a row was nowhere before");
      expected = before[r] + 1;
    }
    const auto row = std::span(table.numbers).subspan(r * columns, columns);
    predict(before[r], row);
    if (!listed) continue;
    for (std::size_t c = 0; c < columns; ++c) row[c] = sum(row[c], unfolded(off[c][i]));
    ++i;
  }
  remember(table, before);
  return table;
}

}  // namespace sunder
