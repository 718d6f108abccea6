// glTF 2.0 and GLB: the triangles of the scene's meshes, transformed by their nodes. The JSON is
// parsed by nlohmann-json; every number is checked before use.
//
// Begin with read_gltf(), then class GltfScene; engine/io/mesh/mesh_gltf_data.h reads the buffers.
#include <algorithm>
#include <array>
#include <vector>

#include "engine/io/mesh/mesh_gltf_data.h"
#include "engine/io/mesh/mesh_gltf_materials.h"

namespace sunder {
namespace {

using nlohmann::json;

constexpr std::size_t kMaxNodeDepth = 64;  ///< Largest depth of the node hierarchy.

Eigen::Matrix4d local_matrix(const json& node, const GltfData& data) {
  Eigen::Matrix4d matrix = Eigen::Matrix4d::Identity();
  if (node.contains("matrix")) {
    const auto m = data.numbers(node, "matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1});
    return Eigen::Map<const Eigen::Matrix4d>(m.data());
  }
  const auto t = data.numbers(node, "translation", {0, 0, 0});
  const auto r = data.numbers(node, "rotation", {0, 0, 0, 1});
  const auto s = data.numbers(node, "scale", {1, 1, 1});
  const Quat rotation(r[3], r[0], r[1], r[2]);
  if (!(rotation.norm() > 0)) data.fail("a node's rotation is zero; export the mesh again");
  matrix.topLeftCorner<3, 3>() =
      rotation.normalized().toRotationMatrix() * Vec3(s[0], s[1], s[2]).asDiagonal();
  matrix.topRightCorner<3, 1>() = Vec3(t[0], t[1], t[2]);
  return matrix;
}

class GltfScene {
 public:
  explicit GltfScene(const MeshSource& source)
      : source_(source), data_(source), appearances_(data_) {}

  RawMesh read() {
    add_scene();
    mesh_.missing_files = appearances_.missing();
    return std::move(mesh_);
  }

 private:
  void add_scene() {
    const json& document = data_.document();
    const json& scenes = data_.array(document, "scenes");
    if (scenes.empty()) {  // a file without scenes: all meshes are read
      for (const json& mesh : data_.array(document, "meshes")) {
        add_mesh(mesh, Eigen::Matrix4d::Identity(), {});
      }
      return;
    }
    const std::size_t scene = data_.index(document, "scene", scenes.size(), 0);
    for (const json& node : data_.array(scenes[scene], "nodes")) {
      add_node(node, Eigen::Matrix4d::Identity(), 0);
    }
  }

  void add_node(const json& node_index, const Eigen::Matrix4d& parent, std::size_t depth) {
    const json& nodes = data_.array(data_.document(), "nodes");
    if (depth > kMaxNodeDepth || ++nodes_visited_ > nodes.size()) {
      data_.fail("nodes refer to each other in a cycle, or are nested deeper than " +
                 std::to_string(kMaxNodeDepth) + " levels; export the mesh with fewer levels");
    }
    const json& node = nodes[data_.to_index(node_index, nodes.size())];
    const Eigen::Matrix4d matrix = parent * local_matrix(node, data_);
    if (node.is_object() && node.contains("mesh")) {
      const json& meshes = data_.array(data_.document(), "meshes");
      add_mesh(meshes[data_.index(node, "mesh", meshes.size())], matrix, name_of(node));
    }
    for (const json& child : data_.array(node, "children")) add_node(child, matrix, depth + 1);
  }

  void add_mesh(const json& mesh, const Eigen::Matrix4d& matrix, const std::string& node_name) {
    const json& materials = data_.array(data_.document(), "materials");
    for (const json& primitive : data_.array(mesh, "primitives")) {
      std::string material;
      GltfMaterials::UvTransform uv_transform = GltfMaterials::UvTransform::Identity();
      RawMesh::Group& group = mesh_.groups.emplace_back();
      if (primitive.is_object() && primitive.contains("material")) {
        const json& used = materials[data_.index(primitive, "material", materials.size())];
        material = name_of(used);
        group.appearance = appearances_.of(used);
        uv_transform = appearances_.uv_transform(used);
      }
      for (const std::string& name : {node_name, name_of(mesh), material}) {
        if (!name.empty()) group.names.push_back(name);
      }
      add_primitive(primitive, matrix, uv_transform);
    }
  }

  static std::string name_of(const json& thing) {
    const bool named = thing.is_object() && thing.contains("name") && thing["name"].is_string();
    return named ? thing["name"].get<std::string>() : std::string();
  }

  void add_primitive(const json& primitive, const Eigen::Matrix4d& matrix,
                     const GltfMaterials::UvTransform& uv_transform) {
    const std::size_t mode = data_.index(primitive, "mode", 7, 4);
    if (mode < 4) return;  // points and lines
    const json& attributes = data_.object(primitive, "attributes");
    const std::vector<double> positions = data_.floats(attributes, "POSITION", 3);
    const std::vector<double> normals = data_.floats(attributes, "NORMAL", 3);
    const std::vector<double> uvs = data_.floats(attributes, "TEXCOORD_0", 2);
    const std::size_t count = positions.size() / 3;
    const std::vector<std::uint32_t> order = data_.indices(primitive, count);
    const auto first = static_cast<std::uint32_t>(mesh_.vertices.size());
    for (std::size_t v = 0; v < count; ++v) {
      const Vec3 point = Eigen::Map<const Vec3>(positions.data() + 3 * v);
      mesh_.vertices.push_back((matrix * point.homogeneous()).head<3>());
    }
    const Mat3 linear = matrix.topLeftCorner<3, 3>();
    const bool mirrored = linear.determinant() < 0;
    // The transposed inverse up to a factor; defined for singular matrices as well.
    Mat3 normal_matrix;
    for (int k = 0; k < 3; ++k) {
      normal_matrix.col(k) = linear.col((k + 1) % 3).cross(linear.col((k + 2) % 3));
    }
    if (mirrored) normal_matrix = -normal_matrix;
    const std::size_t triangles =
        mode == 4 ? order.size() / 3 : std::max<std::size_t>(order.size(), 2) - 2;
    for (std::size_t t = 0; t < triangles; ++t) {
      std::array<std::uint32_t, 3> at = corners_of(t, mode, order);
      if (mirrored) std::swap(at[1], at[2]);
      add_polygon(mesh_, std::array{first + at[0], first + at[1], first + at[2]});
      for (const std::uint32_t v : at) {
        mesh_.corner_normals.push_back(Vec3f::Zero());
        mesh_.corner_uvs.push_back(Vec2f::Zero());
        if (normals.size() == 3 * count) {
          const Vec3 normal = normal_matrix * Eigen::Map<const Vec3>(normals.data() + 3 * v);
          mesh_.corner_normals.back() = normal.normalized().cast<float>();
        }
        if (uvs.size() == 2 * count) {
          const Vec2 uv = Eigen::Map<const Vec2>(uvs.data() + 2 * v);
          mesh_.corner_uvs.back() = (uv_transform * uv.homogeneous()).cast<float>();
        }
      }
    }
    source_.check_size(mesh_);
  }

  /// Returns triangle t of a list (mode 4), strip (5) or fan (6).
  static std::array<std::uint32_t, 3> corners_of(std::size_t t, std::size_t mode,
                                                 const std::vector<std::uint32_t>& order) {
    if (mode == 4) return {order[3 * t], order[3 * t + 1], order[3 * t + 2]};
    if (mode == 6) return {order[0], order[t + 1], order[t + 2]};
    return {order[t], order[t + 1 + t % 2], order[t + 2 - t % 2]};
  }

  const MeshSource& source_;
  GltfData data_;
  GltfMaterials appearances_;
  RawMesh mesh_;
  std::size_t nodes_visited_ = 0;
};

}  // namespace

RawMesh read_gltf(const MeshSource& source) { return GltfScene(source).read(); }

}  // namespace sunder
