// Data of a glTF file: JSON document, buffers and accessors.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/io/mesh/mesh_text.h"

namespace sunder {

/// Checked access: all functions return valid data or throw InputError.
class GltfData {
 public:
  explicit GltfData(const MeshSource& source);

  const nlohmann::json& document() const { return document_; }
  /// Returns the array member `name`; empty if there is none.
  const nlohmann::json& array(const nlohmann::json& parent, const char* name) const;
  /// Returns the object member `name`; empty if there is none.
  const nlohmann::json& object(const nlohmann::json& parent, const char* name) const;
  /// Returns the member `name` as an index below `count`; `fallback` if there is none.
  std::size_t index(const nlohmann::json& parent, const char* name, std::size_t count,
                    std::size_t fallback = kNone) const;
  /// Returns a value as an index below `count`.
  std::size_t to_index(const nlohmann::json& value, std::size_t count) const;
  /// Returns the member `name`, an array as long as `fallback`; `fallback` if there is none.
  std::vector<double> numbers(const nlohmann::json& parent, const char* name,
                              std::initializer_list<double> fallback) const;
  /// Returns the member `name`, a number; `fallback` if there is none.
  double number(const nlohmann::json& parent, const char* name, double fallback) const;
  /// Returns the data of an attribute's accessor, `width` numbers per item; empty if it is absent.
  std::vector<double> floats(const nlohmann::json& attributes, const char* name,
                             std::size_t width) const;
  /// Returns the vertex indices of a primitive in order, each below `vertex_count`.
  std::vector<std::uint32_t> indices(const nlohmann::json& primitive,
                                     std::size_t vertex_count) const;
  /// Returns the bytes of the buffer view that `thing` refers to.
  std::string view(const nlohmann::json& thing) const;
  /// Returns the data of a URI: embedded, or from a file in the same folder.
  std::string load_uri(const std::string& reference) const;
  [[noreturn]] void fail(const std::string& what) const { source_.fail(what); }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  std::string_view json_chunk();
  void load_buffers();
  /// Returns `count` times `width` numbers of a component type from a buffer view.
  std::vector<double> items(const nlohmann::json& where, std::size_t count, std::size_t width,
                            std::size_t type) const;
  /// Returns all numbers of an accessor.
  std::vector<double> values(std::size_t accessor, std::size_t width) const;

  const MeshSource& source_;
  nlohmann::json document_;
  std::string_view binary_chunk_;
  std::vector<std::string> loaded_;        ///< Buffers other than the binary chunk.
  std::vector<std::string_view> buffers_;  ///< All buffers.
};

}  // namespace sunder
