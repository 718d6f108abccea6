#include "engine/io/take/take_table.h"

#include <algorithm>
#include <bit>

namespace sunder {
namespace {

constexpr std::uint32_t kMostRows = 1 << 21;

// Unsigned arithmetic wraps, so every difference can be inverted.
std::int32_t difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
std::int32_t sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

/// Maps small numbers of either sign to small unsigned numbers (zigzag coding).
std::uint32_t folded(std::int32_t n) {
  return (static_cast<std::uint32_t>(n) << 1) ^ static_cast<std::uint32_t>(n >> 31);
}
std::int32_t unfolded(std::uint32_t n) {
  return static_cast<std::int32_t>((n >> 1) ^ (0 - (n & 1)));
}

std::uint8_t length_of(std::uint32_t number) {
  return static_cast<std::uint8_t>(std::bit_width(number));
}

}  // namespace

TableCoder::TableCoder(std::size_t columns, std::size_t gliding) : gliding_(gliding) {
  last_.columns = columns;
  reset();
}

void TableCoder::reset() {
  last_.numbers.clear();
  pace_.clear();
  lengths_.clear();
  is_off_ = {};
  moved_ = {};
  new_.assign(last_.columns, {});
  known_.assign(last_.columns * kSizes * kBeside, {});
}

void TableCoder::predict(std::uint32_t before, std::span<std::int32_t> row) const {
  if (before == kNewRow) {
    std::fill(row.begin(), row.end(), 0);
    return;
  }
  std::ranges::copy(last_.row(before), row.begin());
  for (std::size_t c = 0; c < gliding_; ++c) row[c] = sum(row[c], pace_[before * gliding_ + c]);
}

std::span<const std::uint8_t> TableCoder::lengths(std::uint32_t before) const {
  if (before == kNewRow) return {};
  return std::span(lengths_).subspan(before * last_.columns, last_.columns);
}

/// Returns a context from 0 to 3: bit 1 if the expected previous row had a residual in the
/// extrapolated columns, bit 0 if the row above differs from its prediction.
std::size_t TableCoder::was_off(std::uint32_t expected, bool off_above) const {
  bool off = false;
  if (expected < last_.rows()) {
    const auto then = lengths(expected);
    off = std::ranges::any_of(then.first(gliding_), [](std::uint8_t length) { return length > 0; });
  }
  return (off ? 2 : 0) + (off_above ? 1 : 0);
}

NumberModel& TableCoder::model(std::size_t column, std::span<const std::uint8_t> then,
                               std::uint8_t beside) {
  if (then.empty()) return new_[column];
  const std::size_t size = std::min<std::size_t>(then[column], kSizes - 1);
  return known_[(column * kSizes + size) * kBeside + std::min<std::size_t>(beside, kBeside - 1)];
}

void TableCoder::remember(NumberTable table, std::span<const std::uint32_t> before,
                          std::vector<std::uint8_t> lengths) {
  std::vector<std::int32_t> pace(before.size() * gliding_);
  for (std::size_t r = 0; r < before.size(); ++r) {
    if (before[r] == kNewRow) continue;
    for (std::size_t c = 0; c < gliding_; ++c) {
      pace[r * gliding_ + c] = difference(table.row(r)[c], last_.row(before[r])[c]);
    }
  }
  pace_ = std::move(pace);
  lengths_ = std::move(lengths);
  last_ = std::move(table);
}

/// Format: row count; for each row a bit that is 1 if the row differs from its prediction, and if
/// so the position of its previous row and the residual of each column. The expected previous row
/// is the one after that of the row above.
void TableCoder::write(ByteWriter& out, NumberTable table, std::span<const std::uint32_t> before) {
  SUNDER_CHECK(table.columns == last_.columns && before.size() == table.rows());
  const std::size_t columns = table.columns;
  BitWriter bits;
  std::vector<std::uint8_t> lengths(table.numbers.size());
  std::vector<std::int32_t> predicted(columns);
  std::uint32_t expected = 0;
  bool off_above = false;
  for (std::size_t r = 0; r < before.size(); ++r) {
    predict(before[r], predicted);
    const auto row = table.row(r);
    const bool is_off = before[r] != expected || !std::ranges::equal(row, predicted);
    bits.put(is_off_[was_off(expected, off_above)], is_off);
    off_above = is_off;
    if (!is_off) {
      ++expected;
      continue;
    }
    // 0: as expected; 1: new; else the distance from the expected row.
    const bool is_new = before[r] == kNewRow;
    const auto way = static_cast<std::int32_t>(before[r] - expected);
    moved_.put(bits, is_new ? 1 : way == 0 ? 0 : folded(way) + 1);
    if (!is_new) expected = before[r] + 1;
    const auto then = this->lengths(before[r]);
    std::uint8_t beside = 0;
    for (std::size_t c = 0; c < columns; ++c) {
      const std::uint32_t off = folded(difference(row[c], predicted[c]));
      model(c, then, beside).put(bits, off);
      beside = lengths[r * columns + c] = length_of(off);
    }
  }
  out.put(static_cast<std::uint32_t>(before.size()));
  bits.finish(out);
  remember(std::move(table), before, std::move(lengths));
}

NumberTable TableCoder::read(ByteReader& in, const std::string& file,
                             std::vector<std::uint32_t>& before) {
  const std::size_t columns = last_.columns;
  const auto rows = in.take<std::uint32_t>();
  if (rows > kMostRows) throw InputError(file + ": corrupt: more rows than a frame can have");
  BitReader bits(in);
  NumberTable table{columns, std::vector<std::int32_t>(rows * columns)};
  std::vector<std::uint8_t> lengths(table.numbers.size());
  before.assign(rows, kNewRow);
  std::uint32_t expected = 0;
  bool off_above = false;
  for (std::size_t r = 0; r < rows; ++r) {
    const bool is_off = bits.take(is_off_[was_off(expected, off_above)]);
    off_above = is_off;
    const std::uint32_t moved = is_off ? moved_.take(bits) : 0;
    if (moved != 1) {
      const std::int32_t way = moved > 1 ? unfolded(moved - 1) : 0;
      before[r] = expected + static_cast<std::uint32_t>(way);
      if (before[r] >= last_.rows()) throw InputError(file + ": corrupt: a row was nowhere before");
      expected = before[r] + 1;
    }
    const auto row = std::span(table.numbers).subspan(r * columns, columns);
    predict(before[r], row);
    if (!is_off) continue;
    const auto then = this->lengths(before[r]);
    std::uint8_t beside = 0;
    for (std::size_t c = 0; c < columns; ++c) {
      const std::uint32_t off = model(c, then, beside).take(bits);
      row[c] = sum(row[c], unfolded(off));
      beside = lengths[r * columns + c] = length_of(off);
    }
  }
  remember(table, before, std::move(lengths));
  return table;
}

}  // namespace sunder
