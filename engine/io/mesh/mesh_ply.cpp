// PLY (Stanford polygons), text or binary of either byte order. Elements and properties other than
// vertices, faces, normals and texture coordinates are ignored.
#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

#include "engine/io/mesh/mesh_text.h"

namespace sunder {
namespace {

enum class PlyFormat { kText, kLittleEndian, kBigEndian };
enum class PlyType { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat, kDouble };

/// Use of a property; the first eight are indices into a vertex's record.
enum class PlyRole { kX, kY, kZ, kNormalX, kNormalY, kNormalZ, kU, kV, kCorners, kStrips, kOther };

struct PlyProperty {
  PlyType type = PlyType::kFloat;
  PlyType count_type = PlyType::kUint8;
  bool list = false;
  PlyRole role = PlyRole::kOther;
};

struct PlyElement {
  std::string name;
  std::size_t count = 0;
  std::vector<PlyProperty> properties;
};

struct PlyHeader {
  PlyFormat format = PlyFormat::kText;
  std::vector<PlyElement> elements;
};

PlyType to_type(std::string_view name, const MeshText& text) {
  constexpr std::array<std::pair<std::string_view, PlyType>, 16> kTypes = {
      {{"char", PlyType::kInt8},
       {"int8", PlyType::kInt8},
       {"uchar", PlyType::kUint8},
       {"uint8", PlyType::kUint8},
       {"short", PlyType::kInt16},
       {"int16", PlyType::kInt16},
       {"ushort", PlyType::kUint16},
       {"uint16", PlyType::kUint16},
       {"int", PlyType::kInt32},
       {"int32", PlyType::kInt32},
       {"uint", PlyType::kUint32},
       {"uint32", PlyType::kUint32},
       {"float", PlyType::kFloat},
       {"float32", PlyType::kFloat},
       {"double", PlyType::kDouble},
       {"float64", PlyType::kDouble}}};
  for (const auto& [known, type] : kTypes) {
    if (known == name) return type;
  }
  text.fail("unknown type of a property; export the mesh again");
}

PlyRole role_of(std::string_view element, std::string_view name, bool list) {
  constexpr std::array<std::pair<std::string_view, PlyRole>, 14> kRoles = {
      {{"x", PlyRole::kX},
       {"y", PlyRole::kY},
       {"z", PlyRole::kZ},
       {"nx", PlyRole::kNormalX},
       {"ny", PlyRole::kNormalY},
       {"nz", PlyRole::kNormalZ},
       {"u", PlyRole::kU},
       {"s", PlyRole::kU},
       {"texture_u", PlyRole::kU},
       {"texture_s", PlyRole::kU},
       {"v", PlyRole::kV},
       {"t", PlyRole::kV},
       {"texture_v", PlyRole::kV},
       {"texture_t", PlyRole::kV}}};
  if (element == "face" && list && (name == "vertex_indices" || name == "vertex_index")) {
    return PlyRole::kCorners;
  }
  if (element == "tristrips" && list && name == "vertex_indices") return PlyRole::kStrips;
  if (element == "vertex" && !list) {
    for (const auto& [known, role] : kRoles) {
      if (known == name) return role;
    }
  }
  return PlyRole::kOther;
}

PlyFormat to_format(std::string_view name, const MeshText& text) {
  if (name == "ascii") return PlyFormat::kText;
  if (name == "binary_little_endian") return PlyFormat::kLittleEndian;
  if (name == "binary_big_endian") return PlyFormat::kBigEndian;
  text.fail("unknown format; expected ascii, binary_little_endian or binary_big_endian");
}

PlyProperty read_property(MeshText& text, const std::string& element) {
  PlyProperty property;
  std::string_view word = text.word();
  property.list = word == "list";
  if (property.list) {
    property.count_type = to_type(text.word(), text);
    word = text.word();
  }
  property.type = to_type(word, text);
  property.role = role_of(element, text.word(), property.list);
  return property;
}

PlyHeader read_header(MeshText& text) {
  PlyHeader header;
  if (!text.next_line() || text.word() != "ply")
    text.fail("not a PLY file; it must begin with ply");
  for (;;) {
    if (!text.next_line())
      text.fail("the header has no end_header; the file is truncated, export the mesh again");
    const std::string_view keyword = text.word();
    if (keyword == "end_header") return header;
    if (keyword == "format") {
      header.format = to_format(text.word(), text);
    } else if (keyword == "element") {
      const std::string name(text.word());
      const std::int64_t count = text.integer();
      if (count < 0) text.fail("a count is negative; export the mesh again");
      header.elements.push_back({name, static_cast<std::size_t>(count), {}});
    } else if (keyword == "property") {
      if (header.elements.empty())
        text.fail("a property comes before the first element; export the mesh again");
      header.elements.back().properties.push_back(read_property(text, header.elements.back().name));
    }
  }
}

/// Sequence of values from text.
class TextValues {
 public:
  explicit TextValues(MeshText& text) : text_(text) {}
  void begin() { text_.require_line("last vertex or face"); }
  double next(PlyType) { return text_.number_or_nan(); }
  void need(std::size_t, PlyType) {}
  [[noreturn]] void fail(const std::string& what) const { text_.fail(what); }

 private:
  MeshText& text_;
};

/// Sequence of values from bytes of one byte order.
class BinaryValues {
 public:
  BinaryValues(const MeshSource& source, std::string_view bytes, bool swap)
      : source_(source), bytes_(bytes), swap_(swap) {}
  void begin() {}
  double next(PlyType type) {
    switch (type) {
      case PlyType::kInt8:
        return take<std::int8_t>();
      case PlyType::kUint8:
        return take<std::uint8_t>();
      case PlyType::kInt16:
        return take<std::int16_t>();
      case PlyType::kUint16:
        return take<std::uint16_t>();
      case PlyType::kInt32:
        return take<std::int32_t>();
      case PlyType::kUint32:
        return take<std::uint32_t>();
      case PlyType::kFloat:
        return static_cast<double>(take<float>());
      case PlyType::kDouble:
        return take<double>();
    }
    return 0;
  }
  void need(std::size_t count, PlyType type) const {
    constexpr std::array<std::size_t, 8> kSizes = {1, 1, 2, 2, 4, 4, 4, 8};
    if (bytes_.size() / kSizes[static_cast<std::size_t>(type)] < count) cut_short();
  }
  [[noreturn]] void fail(const std::string& what) const { source_.fail(what); }

 private:
  template <class T>
  T take() {
    if (bytes_.size() < sizeof(T)) cut_short();
    std::array<char, sizeof(T)> value;
    std::copy_n(bytes_.begin(), sizeof(T), value.begin());
    if (swap_) std::reverse(value.begin(), value.end());
    bytes_.remove_prefix(sizeof(T));
    return std::bit_cast<T>(value);
  }
  [[noreturn]] void cut_short() const {
    source_.fail(
        "the file ends before its last vertex or face; it is truncated or corrupt, export the mesh "
        "again");
  }

  const MeshSource& source_;
  std::string_view bytes_;
  bool swap_;
};

template <class Values>
class PlyBody {
 public:
  PlyBody(const MeshSource& source, Values values) : source_(source), values_(std::move(values)) {}

  RawMesh read(const PlyHeader& header) {
    for (const PlyElement& element : header.elements) {
      if (element.properties.empty()) continue;
      for (std::size_t i = 0; i < element.count; ++i) item(element);
    }
    if (mesh_.polygons.empty()) return std::move(mesh_);
    const std::size_t n = mesh_.vertices.size();
    for (const std::uint32_t v : mesh_.corners) {
      if (v >= n) {
        source_.fail("a face has a corner at vertex " + std::to_string(v) + " of " +
                     std::to_string(n) + ", counted from 0; export the mesh again");
      }
    }
    spread_to_corners(mesh_, normals_, uvs_);
    return std::move(mesh_);
  }

 private:
  void item(const PlyElement& element) {
    std::array<double, 9> record{};
    values_.begin();
    for (const PlyProperty& property : element.properties) {
      if (property.list) {
        list(property);
      } else {
        const auto place = static_cast<std::size_t>(property.role);
        record[std::min<std::size_t>(place, 8)] = values_.next(property.type);
      }
    }
    if (element.name != "vertex") return;
    mesh_.vertices.emplace_back(record[0], record[1], record[2]);
    normals_.push_back(Vec3(record[3], record[4], record[5]).cast<float>());
    uvs_.push_back(Vec2(record[6], record[7]).cast<float>());
  }

  void list(const PlyProperty& property) {
    const double count = values_.next(property.count_type);
    if (!(count >= 0 && count <= 0x7fffffff && count == std::floor(count))) {
      values_.fail("the length of a list is not a whole number; export the mesh again");
    }
    const auto n = static_cast<std::size_t>(count);
    values_.need(n, property.type);
    polygon_.clear();
    const bool strips = property.role == PlyRole::kStrips;
    for (std::size_t i = 0; i < n; ++i) {
      const double v = values_.next(property.type);
      if (property.role != PlyRole::kCorners && !strips) continue;
      if (strips && v == -1) {
        add_strip();
        continue;
      }
      if (!(v >= 0 && v <= 0x7fffffff)) {
        values_.fail("a face refers to a vertex that does not exist; export the mesh again");
      }
      polygon_.push_back(static_cast<std::uint32_t>(v));
    }
    if (property.role == PlyRole::kCorners) add_polygon(mesh_, polygon_);
    if (strips) add_strip();
  }

  /// Adds a triangle for every three consecutive vertices, in consistent orientation.
  void add_strip() {
    for (std::size_t i = 2; i < polygon_.size(); ++i) {
      const std::size_t odd = i % 2;
      add_polygon(mesh_, std::array{polygon_[i - 2], polygon_[i - 1 + odd], polygon_[i - odd]});
    }
    polygon_.clear();
  }

  const MeshSource& source_;
  Values values_;
  RawMesh mesh_;
  std::vector<Vec3f> normals_;
  std::vector<Vec2f> uvs_;
  std::vector<std::uint32_t> polygon_;
};

}  // namespace

RawMesh read_ply(const MeshSource& source) {
  MeshText text(source);
  const PlyHeader header = read_header(text);
  if (header.format == PlyFormat::kText) {
    return PlyBody<TextValues>(source, TextValues(text)).read(header);
  }
  const bool swap = header.format == PlyFormat::kBigEndian;
  return PlyBody<BinaryValues>(source, BinaryValues(source, text.rest(), swap)).read(header);
}

}  // namespace sunder
