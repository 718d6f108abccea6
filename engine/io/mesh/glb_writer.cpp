// Begin with write_glb(). Each kind of data has one buffer view; primitives are ranges of these.
#include "engine/io/mesh/glb_writer.h"

#include <algorithm>
#include <array>
#include <map>

#include <nlohmann/json.hpp>

#include "engine/io/bytes.h"
#include "engine/io/mesh/gltf_material_writer.h"

namespace sunder {
namespace {

using nlohmann::json;

// Constants of the format.
constexpr std::uint32_t kMagic = 0x46546c67, kJson = 0x4e4f534a, kBinary = 0x004e4942;
constexpr int kFloat = 5126, kUnsigned = 5125, kArrayBuffer = 34962, kElementBuffer = 34963;

/// Buffer views, in this order.
enum View { kPositions, kNormals, kUvs, kIndices, kViews };
constexpr std::array<std::size_t, kViews> kItemBytes = {12, 12, 8, 4};

/// Triangles of one material, from all shells of a part.
struct Primitive {
  std::vector<Vec3f> positions, normals;
  std::vector<Vec2f> uvs;
  std::vector<std::uint32_t> indices;
};

/// Returns a size rounded up to the alignment of 4 bytes.
std::size_t aligned(std::size_t bytes) { return (bytes + 3) / 4 * 4; }

class GlbWriter {
 public:
  explicit GlbWriter(const Model& model) {
    document_ = {{"asset", {{"version", "2.0"}, {"generator", "sunder"}}}, {"scene", 0}};
    for (const Model::Material& material : model.materials) add_material(material);
    json nodes = json::array();
    for (const Model::Part& part : model.parts) {
      if (add_part(part)) nodes.push_back(nodes.size());
    }
    document_["scenes"] = {{{"nodes", nodes}}};
    add_views();
    materials_.add_images(document_, kViews);
  }

  ByteWriter file() const {
    std::string text = document_.dump();
    text.append((4 - text.size() % 4) % 4, ' ');
    std::size_t binary_size = 0;
    for (const ByteWriter& view : views_) binary_size += view.bytes.size();
    for (const EncodedImage& picture : materials_.pictures())
      binary_size += aligned(picture->size());
    ByteWriter out;
    for (const std::size_t value :
         {std::size_t{kMagic}, std::size_t{2}, 28 + text.size() + binary_size, text.size(),
          std::size_t{kJson}}) {
      out.put(static_cast<std::uint32_t>(value));
    }
    for (const char c : text) out.put(c);
    out.put(static_cast<std::uint32_t>(binary_size));
    out.put(kBinary);
    for (const ByteWriter& view : views_) {
      out.bytes.insert(out.bytes.end(), view.bytes.begin(), view.bytes.end());
    }
    for (const EncodedImage& picture : materials_.pictures()) {
      out.bytes.insert(out.bytes.end(), picture->begin(), picture->end());
      out.bytes.resize(out.bytes.size() + aligned(picture->size()) - picture->size());
    }
    return out;
  }

 private:
  void add_material(const Model::Material& material) {
    document_["materials"].push_back(materials_.describe(material));
    v_from_bottom_.push_back(material.look.v_from_bottom);
  }

  /// Adds a part; returns false if it has no triangles.
  bool add_part(const Model::Part& part) {
    std::map<std::uint32_t, Primitive> primitives;
    for (const Model::Shell& shell : part.shells) {
      const ShellTriangles triangles = triangles_of(shell);
      for (const auto& [material, indices] : triangles.faces) {
        add_triangles(shell, triangles, indices, v_from_bottom_[material], part,
                      primitives[material]);
      }
    }
    json list = json::array();
    for (const auto& [material, primitive] : primitives) {
      if (!primitive.indices.empty()) list.push_back(write(primitive, material));
    }
    if (list.empty()) return false;
    const Vec3 at = part.center + part.offset;
    document_["nodes"].push_back({{"name", part.name},
                                  {"mesh", document_["meshes"].size()},
                                  {"translation", {at.x(), at.y(), at.z()}}});
    document_["meshes"].push_back({{"name", part.name}, {"primitives", std::move(list)}});
    return true;
  }

  /// Adds triangles, except those whose corners are equal in single precision.
  static void add_triangles(const Model::Shell& shell, const ShellTriangles& triangles,
                            const std::vector<std::uint32_t>& indices, bool v_from_bottom,
                            const Model::Part& part, Primitive& primitive) {
    constexpr std::uint32_t kNone = 0xffffffff;
    const auto position = [&](std::uint32_t vertex) -> Vec3f {
      const std::uint32_t point = triangles.vertices[vertex].point;
      return Vec3(shell.mesh->vertices[point] - part.center).cast<float>();
    };
    std::vector<std::uint32_t> new_of_old(triangles.vertices.size(), kNone);
    for (std::size_t i = 0; i + 2 < indices.size(); i += 3) {
      const Vec3f a = position(indices[i]), b = position(indices[i + 1]),
                  c = position(indices[i + 2]);
      if (a == b || b == c || c == a) continue;
      for (const std::uint32_t old : {indices[i], indices[i + 1], indices[i + 2]}) {
        if (new_of_old[old] == kNone) {
          const ShellTriangles::Vertex& vertex = triangles.vertices[old];
          new_of_old[old] = static_cast<std::uint32_t>(primitive.positions.size());
          primitive.positions.push_back(position(old));
          primitive.normals.push_back(vertex.normal);
          primitive.uvs.push_back(v_from_bottom ? Vec2f(vertex.uv.x(), 1 - vertex.uv.y())
                                                : vertex.uv);
        }
        primitive.indices.push_back(new_of_old[old]);
      }
    }
  }

  json write(const Primitive& primitive, std::uint32_t material) {
    const int positions = accessor(kPositions, primitive.positions, "VEC3");
    Vec3f low = primitive.positions[0], high = low;
    for (const Vec3f& p : primitive.positions) {
      low = low.cwiseMin(p);
      high = high.cwiseMax(p);
    }
    json& described = document_["accessors"].back();
    described["min"] = {low.x(), low.y(), low.z()};
    described["max"] = {high.x(), high.y(), high.z()};
    const int normals = accessor(kNormals, primitive.normals, "VEC3");
    const int uvs = accessor(kUvs, primitive.uvs, "VEC2");
    const int indices = accessor(kIndices, primitive.indices, "SCALAR");
    return {{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uvs}}},
            {"indices", indices},
            {"material", material}};
  }

  template <class Item>
  int accessor(View view, const std::vector<Item>& items, const char* type) {
    json& accessors = document_["accessors"];
    accessors.push_back({{"bufferView", view},
                         {"byteOffset", views_[view].bytes.size()},
                         {"componentType", view == kIndices ? kUnsigned : kFloat},
                         {"count", items.size()},
                         {"type", type}});
    for (const Item& item : items) views_[view].put(item);
    return static_cast<int>(accessors.size()) - 1;
  }

  void add_views() {
    std::size_t offset = 0;
    for (std::size_t view = 0; view < kViews; ++view) {
      json described = {{"buffer", 0},
                        {"byteOffset", offset},
                        {"byteLength", views_[view].bytes.size()},
                        {"target", view == kIndices ? kElementBuffer : kArrayBuffer}};
      if (view != kIndices) described["byteStride"] = kItemBytes[view];
      document_["bufferViews"].push_back(std::move(described));
      offset += views_[view].bytes.size();
    }
    for (const EncodedImage& picture : materials_.pictures()) {
      document_["bufferViews"].push_back(
          {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", picture->size()}});
      offset += aligned(picture->size());
    }
    document_["buffers"] = {{{"byteLength", offset}}};
  }

  json document_;
  std::array<ByteWriter, kViews> views_;
  GltfMaterialWriter materials_;  ///< The views of its images follow those of `views_`.
  /// For each material: texture rows count from below, unlike in glTF.
  std::vector<bool> v_from_bottom_;
};

}  // namespace

void write_glb(const std::filesystem::path& file, const Model& model) {
  write_file(file, GlbWriter(model).file().bytes);
}

}  // namespace sunder
