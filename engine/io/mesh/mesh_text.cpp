#include "engine/io/mesh/mesh_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <limits>

#include "engine/io/bytes.h"

namespace sunder {
namespace {

/// Returns text of a file for an error message: shortened and printable.
std::string quoted(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 32)) text += c >= ' ' && c <= '~' ? c : '?';
  return text + (word.size() > 32 ? "...'" : "'");
}

}  // namespace

void MeshSource::check_size(const RawMesh& mesh) const {
  if (mesh.vertices.size() > limits.vertices || mesh.corners.size() > limits.corners) {
    fail("the mesh is larger than " + std::to_string(limits.vertices) + " vertices or " +
         std::to_string(limits.corners) + " corners; simplify the mesh");
  }
}

std::optional<std::string> MeshSource::beside(const std::string& name) const {
  const std::filesystem::path path(name);
  const bool elsewhere = path.is_absolute() || name.find("..") != std::string::npos ||
                         name.find(':') < name.size() || name.find('\0') < name.size();
  const std::filesystem::path found = file.parent_path() / path;
  std::error_code error;
  if (elsewhere || !std::filesystem::is_regular_file(found, error)) return std::nullopt;
  if (std::filesystem::file_size(found, error) > limits.bytes) return std::nullopt;
  const std::vector<std::byte> bytes = read_file(found, file_kinds::kMesh);
  return std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size());
}

void add_polygon(RawMesh& mesh, std::span<const std::uint32_t> vertices) {
  RawMesh::Polygon& polygon = mesh.polygons.emplace_back();
  polygon.first_corner = static_cast<std::uint32_t>(mesh.corners.size());
  polygon.corner_count = static_cast<std::uint32_t>(vertices.size());
  if (!mesh.groups.empty()) polygon.group = static_cast<std::uint32_t>(mesh.groups.size() - 1);
  mesh.corners.insert(mesh.corners.end(), vertices.begin(), vertices.end());
}

void spread_to_corners(RawMesh& mesh, std::span<const Vec3f> normals, std::span<const Vec2f> uvs) {
  for (const std::uint32_t v : mesh.corners) {
    if (!normals.empty()) mesh.corner_normals.push_back(normals[v]);
    if (!uvs.empty()) mesh.corner_uvs.push_back(uvs[v]);
  }
}

MeshText::MeshText(const MeshSource& source) : source_(source), text_(source.bytes) {
  constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
  if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
  if (text_.find('\n') == std::string_view::npos) line_end_ = '\r';
}

bool MeshText::next_line() {
  if (line_ > 0) {
    const std::size_t end = text_.find(line_end_, at_);
    at_ = end == std::string_view::npos ? text_.size() : end + 1;
  }
  ++line_;
  return at_ < text_.size();
}

void MeshText::require_line(const std::string& what) {
  while (next_line()) {
    const std::size_t start = at_;
    if (!word().empty()) {
      at_ = start;
      return;
    }
  }
  fail("the file ends before its " + what + "; it is truncated, copy or export it again");
}

std::string_view MeshText::word() {
  const auto blank = [](char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\0'; };
  for (; at_ < text_.size() && text_[at_] != line_end_; ++at_) {
    if (text_[at_] == '\\') {
      const std::size_t end = line_end_ == '\r' ? at_ + 1 : text_.find_first_not_of('\r', at_ + 1);
      if (end >= text_.size() || text_[end] != line_end_) break;
      ++line_;
      at_ = end;
    } else if (!blank(text_[at_])) {
      break;
    }
  }
  if (at_ == text_.size() || text_[at_] == line_end_ || text_[at_] == '#') return {};
  const std::size_t start = at_;
  while (at_ < text_.size() && text_[at_] != line_end_ && !blank(text_[at_])) ++at_;
  return text_.substr(start, at_ - start);
}

std::string MeshText::words() {
  std::string all;
  for (std::string_view next; !(next = word()).empty();) {
    if (!all.empty()) all += ' ';
    all += next;
  }
  return all;
}

double MeshText::to_number(std::string_view word) const {
  double value = 0;
  const std::string_view digits = word.starts_with('+') ? word.substr(1) : word;
  const auto [end, error] = std::from_chars(digits.data(), digits.data() + digits.size(), value);
  if (error == std::errc::result_out_of_range && end == digits.data() + digits.size()) {
    value = std::strtod(std::string(digits).c_str(), nullptr);
    if (!std::isfinite(value)) fail(quoted(word) + " is too large; export the mesh again");
    return value;  // as good as 0
  }
  if (error != std::errc() || end != digits.data() + digits.size() || !std::isfinite(value)) {
    fail(word.empty() ? "a number is missing; export the mesh again"
                      : quoted(word) + " is not a number; export the mesh again");
  }
  return value;
}

double MeshText::to_number_or_nan(std::string_view word) const {
  const std::string_view digits = word.substr(std::min(word.find_first_not_of("+-"), word.size()));
  const auto says = [&](std::string_view start) { return digits.starts_with(start); };
  if (says("nan") || says("NaN") || says("NAN") || says("inf") || says("Inf") || says("INF") ||
      says("1.#")) {
    return std::numeric_limits<double>::quiet_NaN();
  }
  return to_number(word);
}

std::int64_t MeshText::to_integer(std::string_view word) const {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size()) {
    fail(word.empty() ? "a whole number is missing; export the mesh again"
                      : quoted(word) + " is not a whole number; export the mesh again");
  }
  return value;
}

Vec3 MeshText::point() {
  const double x = number(), y = number();
  return {x, y, number()};
}

Vec3 MeshText::point_or_nan() {
  const double x = number_or_nan(), y = number_or_nan();
  return {x, y, number_or_nan()};
}

std::string_view MeshText::rest() const {
  const std::size_t end = text_.find(line_end_, at_);
  return end == std::string_view::npos ? std::string_view() : text_.substr(end + 1);
}

void MeshText::fail_at(std::size_t line, const std::string& what) const {
  throw InputError(source_.file.string() + ":" + std::to_string(line) + ": " + what);
}

}  // namespace sunder
