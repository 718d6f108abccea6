// The bytes of a glTF: its JSON, its buffers, and the numbers its accessors find in them.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include <nlohmann/json.hpp>

#include "engine/io/mesh/mesh_text.h"

namespace sunder {

/// Everything asked of it is checked: an answer is sound, or an InputError is thrown.
class GltfData {
 public:
  explicit GltfData(const MeshSource& source);

  const nlohmann::json& document() const { return document_; }
  /// The member of that name; an empty one if there is none.
  const nlohmann::json& array(const nlohmann::json& parent, const char* name) const;
  const nlohmann::json& object(const nlohmann::json& parent, const char* name) const;
  /// The member of that name as an index below `count`; `fallback` if there is none.
  std::size_t index(const nlohmann::json& parent, const char* name, std::size_t count,
                    std::size_t fallback = kNone) const;
  std::size_t to_index(const nlohmann::json& value, std::size_t count) const;
  /// The member of that name, as many numbers as `fallback` has.
  std::vector<double> numbers(const nlohmann::json& parent, const char* name,
                              std::initializer_list<double> fallback) const;
  /// The member of that name, a number; `fallback` if there is none.
  double number(const nlohmann::json& parent, const char* name, double fallback) const;
  /// What the accessor of an attribute points to, `width` numbers an item; empty if it is absent.
  std::vector<double> floats(const nlohmann::json& attributes, const char* name,
                             std::size_t width) const;
  /// The vertices of a primitive in order, each below `vertex_count`.
  std::vector<std::uint32_t> indices(const nlohmann::json& primitive,
                                     std::size_t vertex_count) const;
  /// The bytes of the buffer view that a thing names.
  std::string view(const nlohmann::json& thing) const;
  /// What a reference holds: data of its own, or a file in the same folder.
  std::string load_uri(const std::string& reference) const;
  [[noreturn]] void fail(const std::string& what) const { source_.fail(what); }

 private:
  static constexpr std::size_t kNone = ~std::size_t{0};

  std::string_view json_chunk();
  void load_buffers();
  /// `count` times `width` numbers of a component type, from a view of a buffer.
  std::vector<double> items(const nlohmann::json& where, std::size_t count, std::size_t width,
                            std::size_t type) const;
  /// What an accessor says.
  std::vector<double> values(std::size_t accessor, std::size_t width) const;

  const MeshSource& source_;
  nlohmann::json document_;
  std::string_view binary_chunk_;
  std::vector<std::string> loaded_;        ///< Buffers that are not the binary chunk.
  std::vector<std::string_view> buffers_;  ///< All of them.
};

}  // namespace sunder
