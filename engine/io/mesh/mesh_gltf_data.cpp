#include "engine/io/mesh/mesh_gltf_data.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <type_traits>

#include "engine/io/bytes.h"

namespace sunder {
namespace {

using nlohmann::json;

constexpr int kMaxJsonDepth = 100;  // nested arrays and objects
constexpr std::size_t kMaxBytes = std::size_t{1} << 32;

/// Returns a value for an error message, shortened; nested values could be of any size.
std::string brief(const json& value) {
  return value.is_primitive() ? value.dump().substr(0, 40) : std::string(value.type_name());
}

std::uint32_t word_at(std::string_view bytes, std::size_t at) {
  std::uint32_t word = 0;
  std::memcpy(&word, bytes.data() + at, sizeof word);
  return word;
}

/// Returns the value of a base-64 digit; 64 if invalid.
std::uint32_t digit(char c) {
  if (c >= 'A' && c <= 'Z') return static_cast<std::uint32_t>(c - 'A');
  if (c >= 'a' && c <= 'z') return static_cast<std::uint32_t>(c - 'a') + 26;
  if (c >= '0' && c <= '9') return static_cast<std::uint32_t>(c - '0') + 52;
  return c == '+' || c == '-' ? 62 : c == '/' || c == '_' ? 63 : 64;
}

std::string decode_base64(std::string_view text) {
  std::string bytes;
  std::uint32_t bits = 0;
  int held = 0;
  for (const char c : text) {
    const std::uint32_t value = digit(c);
    if (value == 64) break;  // padding
    bits = (bits << 6 | value) & 0xffffff;
    held += 6;
    if (held < 8) continue;
    held -= 8;
    bytes.push_back(static_cast<char>(bits >> held & 0xff));
  }
  return bytes;
}

/// True if an extension is needed to read meshes; extensions of appearance are ignored.
bool changes_geometry(const std::string& extension) {
  constexpr std::string_view kAppearancePrefixes[] = {
      "KHR_materials_", "KHR_texture_", "KHR_lights_",   "KHR_xmp",
      "EXT_texture_",   "EXT_lights_",  "MSFT_texture_", "KHR_animation_"};
  return extension != "KHR_mesh_quantization" &&
         std::none_of(std::begin(kAppearancePrefixes), std::end(kAppearancePrefixes),
                      [&](std::string_view start) { return extension.starts_with(start); });
}

/// Resolves the escapes (%20) of a relative reference.
std::string unescaped(const std::string& uri) {
  const auto digit_of = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                  : -1;
  };
  std::string text;
  for (std::size_t i = 0; i < uri.size(); ++i) {
    const int high = uri[i] == '%' && i + 2 < uri.size() ? digit_of(uri[i + 1]) : -1;
    const int low = high >= 0 ? digit_of(uri[i + 2]) : -1;
    text.push_back(low >= 0 ? static_cast<char>(16 * high + low) : uri[i]);
    if (low >= 0) i += 2;
  }
  return text;
}

/// Storage of an accessor's components.
struct Component {
  std::size_t size = 0;
  double (*read)(const char*) = nullptr;
  double scale = 1;  ///< Factor for normalized integers.
};

template <class T>
Component component() {
  const auto read = [](const char* at) {
    T value;
    std::memcpy(&value, at, sizeof value);
    return static_cast<double>(value);
  };
  const double most =
      std::is_integral_v<T> ? static_cast<double>(std::numeric_limits<T>::max()) : 1;
  return {sizeof(T), read, 1 / most};
}

Component component_of(std::size_t type) {
  switch (type) {
    case 5120:
      return component<std::int8_t>();
    case 5121:
      return component<std::uint8_t>();
    case 5122:
      return component<std::int16_t>();
    case 5123:
      return component<std::uint16_t>();
    case 5125:
      return component<std::uint32_t>();
    case 5126:
      return component<float>();
    default:
      return {};
  }
}

}  // namespace

GltfData::GltfData(const MeshSource& source) : source_(source) {
  const auto is_shallow = [&](int depth, json::parse_event_t, const json&) {
    if (depth > kMaxJsonDepth) fail("the JSON is nested too deeply; export the mesh again");
    return true;
  };
  document_ = json::parse(json_chunk(), is_shallow, false);
  if (!document_.is_object())
    fail("not a glTF file: the JSON cannot be parsed; export the mesh again");
  const json::const_iterator buffers = document_.find("buffers");
  if (buffers != document_.end() && buffers->is_object())  // by name, as in version 1
    fail("only version 2 of glTF is supported; export the mesh as glTF 2.0");
  for (const json& extension : array(document_, "extensionsRequired")) {
    if (!extension.is_string() || changes_geometry(extension.get<std::string>())) {
      fail("the file requires the extension " + brief(extension) +
           ", which is not supported; export it without the extension or compression");
    }
  }
  load_buffers();
}

std::string_view GltfData::json_chunk() {
  const std::string_view bytes = source_.bytes;
  if (!bytes.starts_with("glTF")) return bytes;
  if (bytes.size() < 20 || word_at(bytes, 4) != 2)
    fail("only version 2 of GLB is supported; export the mesh as glTF 2.0");
  const std::size_t json_size = word_at(bytes, 12);
  if (word_at(bytes, 16) != 0x4e4f534a || bytes.size() - 20 < json_size) {
    fail("the file is truncated or corrupt; export the mesh again");
  }
  const std::string_view rest = bytes.substr(20 + json_size);
  if (rest.size() >= 8 && word_at(rest, 4) == 0x004e4942) {
    binary_chunk_ = rest.substr(8, word_at(rest, 0));
  }
  return bytes.substr(20, json_size);
}

void GltfData::load_buffers() {
  const json& buffers = array(document_, "buffers");
  loaded_.reserve(buffers.size());
  std::size_t total = 0;
  for (const json& buffer : buffers) {
    if (buffer.is_object() && buffer.contains("uri")) {
      if (!buffer["uri"].is_string())
        fail("a buffer's uri must be a string; export the mesh again");
      loaded_.push_back(load_uri(buffer["uri"].get<std::string>()));
      buffers_.push_back(loaded_.back());
      total += loaded_.back().size();
      if (total > source_.limits.bytes) fail("the buffers are too large; simplify the mesh");
    } else {
      buffers_.push_back(binary_chunk_);
    }
  }
}

std::string GltfData::load_uri(const std::string& reference) const {
  if (reference.starts_with("data:")) {
    const std::size_t comma = reference.find(";base64,");
    if (comma == std::string::npos) fail("a buffer is not in base64; export the mesh again");
    return decode_base64(std::string_view(reference).substr(comma + 8));
  }
  const std::string uri = unescaped(reference);
  if (uri.find('\0') != std::string::npos)
    fail("a buffer's uri must be a string; export the mesh again");
  // Security: a file from elsewhere must not make the program read other files.
  const std::filesystem::path path(uri);
  if (path.is_absolute() || uri.find("..") != std::string::npos || uri.find(':') < uri.size()) {
    fail("buffers must be files in the folder of the mesh; export it as .glb");
  }
  const std::filesystem::path file = source_.file.parent_path() / path;
  std::error_code error;
  if (!std::filesystem::is_regular_file(file, error))
    fail("the buffer " + uri +
         " is missing; put it into the folder of the mesh, or export as .glb");
  if (std::filesystem::file_size(file, error) > source_.limits.bytes) {
    fail("the buffers are too large; simplify the mesh");
  }
  const std::vector<std::byte> bytes = read_file(file, file_kinds::kMesh);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

const json& GltfData::array(const json& parent, const char* name) const {
  static const json kEmpty = json::array();
  if (!parent.is_object() || !parent.contains(name)) return kEmpty;
  if (!parent[name].is_array())
    fail(std::string(name) + " must be an array; export the mesh again");
  return parent[name];
}

const json& GltfData::object(const json& parent, const char* name) const {
  static const json kEmpty = json::object();
  if (!parent.is_object() || !parent.contains(name)) return kEmpty;
  if (!parent[name].is_object())
    fail(std::string(name) + " must be an object; export the mesh again");
  return parent[name];
}

std::size_t GltfData::to_index(const json& value, std::size_t count) const {
  if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= count) {
    fail("the index " + brief(value) + " is not below " + std::to_string(count) +
         "; export the mesh again");
  }
  return value.get<std::size_t>();
}

std::size_t GltfData::index(const json& parent, const char* name, std::size_t count,
                            std::size_t fallback) const {
  if (parent.is_object() && parent.contains(name)) return to_index(parent[name], count);
  if (fallback >= count) fail(std::string(name) + " is missing; export the mesh again");
  return fallback;
}

std::vector<double> GltfData::numbers(const json& parent, const char* name,
                                      std::initializer_list<double> fallback) const {
  if (!parent.is_object() || !parent.contains(name)) return fallback;
  const json& list = array(parent, name);
  if (list.size() != fallback.size()) {
    fail(std::string(name) + " must be " + std::to_string(fallback.size()) + " numbers");
  }
  std::vector<double> numbers;
  for (const json& value : list) {
    if (!value.is_number()) fail(std::string(name) + " must be numbers; export the mesh again");
    numbers.push_back(value.get<double>());
  }
  return numbers;
}

double GltfData::number(const json& parent, const char* name, double fallback) const {
  if (!parent.is_object() || !parent.contains(name)) return fallback;
  if (!parent[name].is_number())
    fail(std::string(name) + " must be a number; export the mesh again");
  return parent[name].get<double>();
}

std::string GltfData::view(const json& thing) const {
  const json& views = array(document_, "bufferViews");
  const json& view = views[index(thing, "bufferView", views.size())];
  const std::string_view buffer = buffers_[index(view, "buffer", buffers_.size())];
  const std::size_t start = index(view, "byteOffset", kMaxBytes, 0);
  const std::size_t size = index(view, "byteLength", kMaxBytes);
  if (start + size > buffer.size())
    fail("a buffer view exceeds its buffer; the file is truncated, export the mesh again");
  return std::string(buffer.substr(start, size));
}

std::vector<double> GltfData::items(const json& where, std::size_t count, std::size_t width,
                                    std::size_t type) const {
  const Component component = component_of(type);
  if (component.size == 0) fail("an accessor has an unexpected type; export the mesh again");
  const json& views = array(document_, "bufferViews");
  const json& view = views[index(where, "bufferView", views.size())];
  const std::string_view buffer = buffers_[index(view, "buffer", buffers_.size())];
  const std::size_t view_start = index(view, "byteOffset", kMaxBytes, 0);
  const std::size_t view_size = index(view, "byteLength", kMaxBytes);
  const std::size_t start = index(where, "byteOffset", kMaxBytes, 0);
  const std::size_t stride = index(view, "byteStride", 253, component.size * width);
  if (view_start + view_size > buffer.size() || stride < component.size * width ||
      (count > 0 && start + stride * (count - 1) + component.size * width > view_size)) {
    fail("an accessor exceeds its buffer; the file is truncated or corrupt, export the mesh again");
  }
  std::vector<double> values;
  values.reserve(count * width);
  for (std::size_t i = 0; i < count; ++i) {
    const char* at = buffer.data() + view_start + start + i * stride;
    for (std::size_t k = 0; k < width; ++k, at += component.size) {
      values.push_back(component.read(at));
    }
  }
  return values;
}

std::vector<double> GltfData::values(std::size_t accessor_index, std::size_t width) const {
  const json& accessor = array(document_, "accessors")[accessor_index];
  const char* const types[] = {"SCALAR", "VEC2", "VEC3"};
  if (!accessor.is_object() || !accessor.contains("type") || accessor["type"] != types[width - 1]) {
    fail("an accessor has an unexpected type; export the mesh again");
  }
  const std::size_t type = index(accessor, "componentType", kMaxBytes);
  const std::size_t count = index(accessor, "count", source_.limits.corners + 1);
  const bool zero = !accessor.contains("bufferView");
  if (zero && count > source_.bytes.size())
    fail("an accessor has more elements than the file has bytes; export the mesh again");
  std::vector<double> values =
      zero ? std::vector<double>(count * width) : items(accessor, count, width, type);
  if (accessor.contains("sparse")) {  // some items replaced
    const json& sparse = object(accessor, "sparse");
    const std::size_t changed = index(sparse, "count", count + 1);
    const json& places = object(sparse, "indices");
    const std::vector<double> at =
        items(places, changed, 1, index(places, "componentType", kMaxBytes));
    const std::vector<double> by = items(object(sparse, "values"), changed, width, type);
    for (std::size_t i = 0; i < changed; ++i) {
      if (!(at[i] >= 0 && at[i] < static_cast<double>(count))) {
        fail("a sparse accessor has an index out of range; export the mesh again");
      }
      std::copy_n(
          by.begin() + static_cast<std::ptrdiff_t>(i * width), width,
          values.begin() + static_cast<std::ptrdiff_t>(at[i]) * static_cast<std::ptrdiff_t>(width));
    }
  }
  if (accessor.contains("normalized") && accessor["normalized"] == true) {
    for (double& value : values) value *= component_of(type).scale;
  }
  return values;
}

std::vector<double> GltfData::floats(const json& attributes, const char* name,
                                     std::size_t width) const {
  if (!attributes.contains(name)) return {};
  return values(index(attributes, name, array(document_, "accessors").size()), width);
}

std::vector<std::uint32_t> GltfData::indices(const json& primitive,
                                             std::size_t vertex_count) const {
  std::vector<std::uint32_t> order;
  if (!primitive.contains("indices")) {
    for (std::uint32_t v = 0; v < vertex_count; ++v) order.push_back(v);
    return order;
  }
  const std::size_t accessor = index(primitive, "indices", array(document_, "accessors").size());
  for (const double v : values(accessor, 1)) {
    if (!(v >= 0 && v < static_cast<double>(vertex_count))) {
      fail("a triangle refers to a vertex that does not exist; export the mesh again");
    }
    order.push_back(static_cast<std::uint32_t>(v));
  }
  return order;
}

}  // namespace sunder
