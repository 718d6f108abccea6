// Tables of whole numbers that change little from frame to frame, as few bytes: what a take's
// bodies, debris and dust become.
//
// Read first: TableCoder::write(). Rows are found again in the previous table, numbers are
// predicted to go on as they did, and what is left over is coded bit by bit, by how much the same
// number was off a frame ago and its neighbour is now.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "engine/io/take/bit_coder.h"

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

inline constexpr std::uint32_t kNewRow = 0xffffffff;

/// One end of a stream of tables: writer and reader each keep one, in step.
class TableCoder {
 public:
  /// The first `gliding` columns are predicted to change as they did before, the others to stay.
  TableCoder(std::size_t columns, std::size_t gliding);

  /// Forgets what came before: the next table stands alone.
  void reset();
  const NumberTable& last() const { return last_; }
  /// `before`: for each row its number in the last table, or kNewRow.
  void write(ByteWriter& out, NumberTable table, std::span<const std::uint32_t> before);
  /// Throws InputError if the bytes are not those of a table. The rows' numbers in the last table
  /// come back in `before`.
  NumberTable read(ByteReader& in, const std::string& file, std::vector<std::uint32_t>& before);

 private:
  static constexpr std::size_t kSizes = 8, kBeside = 4;  ///< Kinds of how far off.

  /// What a row is expected to be.
  void predict(std::uint32_t before, std::span<std::int32_t> row) const;
  /// How far off the columns of a row were a frame ago, as lengths in bits; none of a new row.
  std::span<const std::uint8_t> lengths(std::uint32_t before) const;
  std::size_t was_off(std::uint32_t expected, bool off_above) const;
  NumberModel& model(std::size_t column, std::span<const std::uint8_t> then, std::uint8_t beside);
  void remember(NumberTable table, std::span<const std::uint32_t> before,
                std::vector<std::uint8_t> lengths);

  std::size_t gliding_;
  NumberTable last_;
  std::vector<std::int32_t> pace_;     ///< Last change of the gliding columns, row by row.
  std::vector<std::uint8_t> lengths_;  ///< Of what was left over, number by number.
  // What has been learnt since the last reset.
  std::array<BitModel, 4> is_off_;
  NumberModel moved_;
  std::vector<NumberModel> new_, known_;  ///< By column; by column, and how far off others are.
};

}  // namespace sunder
