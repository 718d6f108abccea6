// Compression of integer tables that change little from frame to frame, for recordings.
//
// Begin with TableCoder::write(). Rows are matched with the previous table, numbers are
// extrapolated, and residuals are entropy-coded. The model of a residual depends on the residual of
// the same number in the previous frame and on that of the preceding column.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/io/recording/bit_coder.h"

namespace sunder {

/// Rows of `columns` numbers each.
struct NumberTable {
  std::size_t columns = 0;
  std::vector<std::int32_t> numbers;

  std::size_t rows() const { return columns == 0 ? 0 : numbers.size() / columns; }
  std::span<const std::int32_t> row(std::size_t r) const {
    return std::span(numbers).subspan(r * columns, columns);
  }
};

/// Row without a match in the last table.
inline constexpr std::uint32_t kNewRow = 0xffffffff;

/// Encoder or decoder of a stream of tables; writer and reader each have one, in equal states.
class TableCoder {
 public:
  /// Makes a coder. The first `extrapolated` columns are extrapolated at their last rate of change,
  /// the others are predicted to stay constant.
  TableCoder(std::size_t columns, std::size_t extrapolated);

  /// Forgets the last table: the next one is encoded without reference to it.
  void reset();
  const NumberTable& last() const { return last_; }
  /// Encodes a table. `before`: for each row its index in the last table, or kNewRow.
  void write(ByteWriter& out, NumberTable table, std::span<const std::uint32_t> before);
  /// Decodes a table; throws InputError if the bytes are not a table. Sets `before` to the rows'
  /// indices in the last table.
  NumberTable read(ByteReader& in, const std::string& file, std::vector<std::uint32_t>& before);

 private:
  /// Numbers of classes of residuals: of the previous frame, of the preceding column.
  static constexpr std::size_t kLengthClasses = 8, kNeighbourClasses = 4;

  /// Sets `row` to the prediction for a row.
  void predict(std::uint32_t before, std::span<std::int32_t> row) const;
  /// Returns the lengths in bits of a row's residuals in the last table; empty for a new row.
  std::span<const std::uint8_t> lengths(std::uint32_t before) const;
  std::size_t context_of(std::uint32_t expected, bool above_differs) const;
  NumberModel& model(std::size_t column, std::span<const std::uint8_t> last_lengths,
                     std::uint8_t neighbour_length);
  void store_last(NumberTable table, std::span<const std::uint32_t> before,
                  std::vector<std::uint8_t> lengths);

  std::size_t extrapolated_;
  NumberTable last_;
  std::vector<std::int32_t> last_change_;  ///< Last change of the extrapolated columns, by row.
  std::vector<std::uint8_t> lengths_;      ///< Length in bits of the residual of each number.
  // Adaptive models, trained since the last reset.
  std::array<BitModel, 4> differs_models_;
  NumberModel move_model_;
  /// `new_row_models_` by column; `known_row_models_` by column and classes of residuals.
  std::vector<NumberModel> new_row_models_, known_row_models_;
};

}  // namespace sunder
