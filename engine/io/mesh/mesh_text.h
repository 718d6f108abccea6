// What the readers of meshes share: the source they read, and walking its text by lines and words.
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

/// A file in memory.
struct MeshSource {
  std::string_view bytes;
  std::filesystem::path file;
  MeshLimits limits;

  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(file.string() + ": " + what);
  }
  /// What a file in the same folder, or below, holds; none if there is none, or it is elsewhere: a
  /// mesh from somebody else must not make us read what is not its own.
  std::optional<std::string> beside(const std::string& name) const;
  /// Throws InputError if the mesh has outgrown the limits.
  void check_size(const RawMesh& mesh) const;
};

RawMesh read_obj(const MeshSource& source);
RawMesh read_ply(const MeshSource& source);
RawMesh read_stl(const MeshSource& source);
RawMesh read_off(const MeshSource& source);
RawMesh read_gltf(const MeshSource& source);

/// Appends a polygon of vertices with the group last named.
void add_polygon(RawMesh& mesh, std::span<const std::uint32_t> vertices);
/// Gives every corner the normal and texture coordinate of its vertex; empty: it has none.
void spread_to_corners(RawMesh& mesh, std::span<const Vec3f> normals, std::span<const Vec2f> uvs);

/// Text by lines and words, numbers parsed alike in every locale. A '#' ends a line; a '\' joins it
/// to the next. Lines end as on any system; a byte order mark is passed over.
class MeshText {
 public:
  explicit MeshText(const MeshSource& source);

  /// Moves to the next line, or tells that there is none.
  bool next_line();
  /// Moves to the next line with a word on it, or fails saying that `what` is missing.
  void need_line(const std::string& what);
  /// The line's next word; empty at its end.
  std::string_view word();
  /// All its words from here on, a blank between them.
  std::string words();
  /// The line's next word, which must be a finite number.
  double number() { return to_number(word()); }
  double to_number(std::string_view word) const;
  /// The line's next word, which may say that it is not a number, as exporters write for normals of
  /// faces without area; an infinity is none either.
  double number_or_nan() { return to_number_or_nan(word()); }
  double to_number_or_nan(std::string_view word) const;
  /// The line's next word, which must be an integer.
  std::int64_t integer() { return to_integer(word()); }
  std::int64_t to_integer(std::string_view word) const;
  Vec3 point();
  /// As point(), of numbers that nothing depends on.
  Vec3 point_or_nan();

  std::size_t line() const { return line_; }
  /// What is left of the text, from the line after this one.
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
