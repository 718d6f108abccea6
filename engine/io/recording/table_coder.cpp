#include "engine/io/recording/table_coder.h"

#include <algorithm>
#include <bit>

namespace sunder {
namespace {

constexpr std::uint32_t kMaxRows = 1 << 21;

// Unsigned arithmetic wraps, so every difference can be inverted.
std::int32_t difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}
std::int32_t sum(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) + static_cast<std::uint32_t>(b));
}

/// Maps small numbers of either sign to small unsigned numbers (zigzag coding).
std::uint32_t zigzag_encode(std::int32_t n) {
  return (static_cast<std::uint32_t>(n) << 1) ^ static_cast<std::uint32_t>(n >> 31);
}
std::int32_t zigzag_decode(std::uint32_t n) {
  return static_cast<std::int32_t>((n >> 1) ^ (0 - (n & 1)));
}

std::uint8_t length_of(std::uint32_t number) {
  return static_cast<std::uint8_t>(std::bit_width(number));
}

}  // namespace

TableCoder::TableCoder(std::size_t columns, std::size_t extrapolated)
    : extrapolated_(extrapolated) {
  last_.columns = columns;
  reset();
}

void TableCoder::reset() {
  last_.numbers.clear();
  last_change_.clear();
  lengths_.clear();
  differs_models_ = {};
  move_model_ = {};
  new_row_models_.assign(last_.columns, {});
  known_row_models_.assign(last_.columns * kLengthClasses * kNeighbourClasses, {});
}

void TableCoder::predict(std::uint32_t before, std::span<std::int32_t> row) const {
  if (before == kNewRow) {
    std::fill(row.begin(), row.end(), 0);
    return;
  }
  std::ranges::copy(last_.row(before), row.begin());
  for (std::size_t c = 0; c < extrapolated_; ++c)
    row[c] = sum(row[c], last_change_[before * extrapolated_ + c]);
}

std::span<const std::uint8_t> TableCoder::lengths(std::uint32_t before) const {
  if (before == kNewRow) return {};
  return std::span(lengths_).subspan(before * last_.columns, last_.columns);
}

/// Returns a context from 0 to 3: bit 1 if the expected previous row had a residual in the
/// extrapolated columns, bit 0 if the row above differs from its prediction.
std::size_t TableCoder::context_of(std::uint32_t expected, bool above_differs) const {
  bool residual = false;
  if (expected < last_.rows()) {
    const auto last_lengths = lengths(expected);
    residual = std::ranges::any_of(last_lengths.first(extrapolated_),
                                   [](std::uint8_t length) { return length > 0; });
  }
  return (residual ? 2 : 0) + (above_differs ? 1 : 0);
}

NumberModel& TableCoder::model(std::size_t column, std::span<const std::uint8_t> last_lengths,
                               std::uint8_t neighbour_length) {
  if (last_lengths.empty()) return new_row_models_[column];
  const std::size_t size = std::min<std::size_t>(last_lengths[column], kLengthClasses - 1);
  return known_row_models_[(column * kLengthClasses + size) * kNeighbourClasses +
                           std::min<std::size_t>(neighbour_length, kNeighbourClasses - 1)];
}

void TableCoder::store_last(NumberTable table, std::span<const std::uint32_t> before,
                            std::vector<std::uint8_t> lengths) {
  std::vector<std::int32_t> last_change(before.size() * extrapolated_);
  for (std::size_t r = 0; r < before.size(); ++r) {
    if (before[r] == kNewRow) continue;
    for (std::size_t c = 0; c < extrapolated_; ++c) {
      last_change[r * extrapolated_ + c] = difference(table.row(r)[c], last_.row(before[r])[c]);
    }
  }
  last_change_ = std::move(last_change);
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
  bool above_differs = false;
  for (std::size_t r = 0; r < before.size(); ++r) {
    predict(before[r], predicted);
    const auto row = table.row(r);
    const bool differs = before[r] != expected || !std::ranges::equal(row, predicted);
    bits.put(differs_models_[context_of(expected, above_differs)], differs);
    above_differs = differs;
    if (!differs) {
      ++expected;
      continue;
    }
    // 0: as expected; 1: new; else the distance from the expected row.
    const bool is_new = before[r] == kNewRow;
    const auto distance = static_cast<std::int32_t>(before[r] - expected);
    move_model_.put(bits, is_new ? 1 : distance == 0 ? 0 : zigzag_encode(distance) + 1);
    if (!is_new) expected = before[r] + 1;
    const auto last_lengths = this->lengths(before[r]);
    std::uint8_t neighbour_length = 0;
    for (std::size_t c = 0; c < columns; ++c) {
      const std::uint32_t residual = zigzag_encode(difference(row[c], predicted[c]));
      model(c, last_lengths, neighbour_length).put(bits, residual);
      neighbour_length = lengths[r * columns + c] = length_of(residual);
    }
  }
  out.put(static_cast<std::uint32_t>(before.size()));
  bits.finish(out);
  store_last(std::move(table), before, std::move(lengths));
}

NumberTable TableCoder::read(ByteReader& in, const std::string& file,
                             std::vector<std::uint32_t>& before) {
  const std::size_t columns = last_.columns;
  const auto rows = in.take<std::uint32_t>();
  if (rows > kMaxRows) throw InputError(file + ": corrupt: more rows than a frame can have");
  BitReader bits(in);
  NumberTable table{columns, std::vector<std::int32_t>(rows * columns)};
  std::vector<std::uint8_t> lengths(table.numbers.size());
  before.assign(rows, kNewRow);
  std::uint32_t expected = 0;
  bool above_differs = false;
  for (std::size_t r = 0; r < rows; ++r) {
    const bool differs = bits.take(differs_models_[context_of(expected, above_differs)]);
    above_differs = differs;
    const std::uint32_t moved = differs ? move_model_.take(bits) : 0;
    if (moved != 1) {
      const std::int32_t distance = moved > 1 ? zigzag_decode(moved - 1) : 0;
      before[r] = expected + static_cast<std::uint32_t>(distance);
      if (before[r] >= last_.rows()) throw InputError(file + ": corrupt: a row was nowhere before");
      expected = before[r] + 1;
    }
    const auto row = std::span(table.numbers).subspan(r * columns, columns);
    predict(before[r], row);
    if (!differs) continue;
    const auto last_lengths = this->lengths(before[r]);
    std::uint8_t neighbour_length = 0;
    for (std::size_t c = 0; c < columns; ++c) {
      const std::uint32_t residual = model(c, last_lengths, neighbour_length).take(bits);
      row[c] = sum(row[c], zigzag_decode(residual));
      neighbour_length = lengths[r * columns + c] = length_of(residual);
    }
  }
  store_last(table, before, std::move(lengths));
  return table;
}

}  // namespace sunder
