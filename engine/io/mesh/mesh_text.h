// Common parts of mesh readers: the source, and a parser of lines and words.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "engine/base/check.h"
#include "engine/io/mesh/mesh_reader.h"

namespace sunder {

/// A mesh file in memory.
struct MeshSource {
  std::string_view bytes;
  std::filesystem::path file;
  MeshLimits limits;

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file.string() + ": " + what);
  }
  /// Returns the content of a file in the same folder or below; nothing if it is missing or
  /// elsewhere. Security: a file from elsewhere must not make the program read other files.
  std::optional<std::string> beside(const std::string& name) const;
  /// Throws InputError if the mesh exceeds the limits.
  void check_size(const RawMesh& mesh) const;
};

RawMesh read_obj(const MeshSource& source);
RawMesh read_ply(const MeshSource& source);
RawMesh read_stl(const MeshSource& source);
RawMesh read_off(const MeshSource& source);
RawMesh read_gltf(const MeshSource& source);

/// Appends a polygon, in the last group.
void add_polygon(RawMesh& mesh, std::span<const std::uint32_t> vertices);
/// Copies normals and texture coordinates of vertices to corners; an empty span sets none.
void spread_to_corners(RawMesh& mesh, std::span<const Vec3f> normals, std::span<const Vec2f> uvs);

/// Parser of lines and words; numbers do not depend on the locale. A '#' ends a line; a '\' joins
/// it to the next. Line ends of all systems are accepted, and a byte order mark is skipped.
class MeshText {
 public:
  explicit MeshText(const MeshSource& source);

  /// Moves to the next line; returns false if there is none.
  bool next_line();
  /// Moves to the next line that has a word; throws InputError that `what` is missing otherwise.
  void require_line(const std::string& what);
  /// Returns the next word of the line; empty at its end.
  std::string_view word();
  /// Returns the remaining words of the line, separated by blanks.
  std::string words();
  /// Reads the next word as a finite number.
  double number() { return to_number(word()); }
  double to_number(std::string_view word) const;
  /// Reads the next word as a number that may be NaN, as exporters write for normals of degenerate
  /// faces; infinity becomes NaN.
  double number_or_nan() { return to_number_or_nan(word()); }
  double to_number_or_nan(std::string_view word) const;
  /// Reads the next word as an integer.
  std::int64_t integer() { return to_integer(word()); }
  std::int64_t to_integer(std::string_view word) const;
  /// Reads three finite numbers.
  Vec3 point();
  /// Reads three numbers that may be NaN.
  Vec3 point_or_nan();

  std::size_t line() const { return line_; }
  /// Returns the text from the next line on.
  std::string_view rest() const;
  [[noreturn]] void fail(const std::string& what) const { fail_at(line_, what); }
  [[noreturn]] void fail_at(std::size_t line, const std::string& what) const;

 private:
  const MeshSource& source_;
  std::string_view text_;
  char line_end_ = '\n';
  std::size_t at_ = 0;
  std::size_t line_ = 0;
};

}  // namespace sunder
