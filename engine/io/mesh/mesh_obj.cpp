// Wavefront OBJ: polygons of any size, groups, negative indices. Statements other than surfaces are
// ignored, as is usual for this format, and so are indices into a list of texture coordinates or
// normals that the file leaves out.
#include <algorithm>
#include <array>
#include <map>

#include "engine/io/mesh/mesh_mtl.h"
#include "engine/io/mesh/mesh_text.h"

namespace sunder {
namespace {

/// One of the three lists that corners refer to.
struct ObjList {
  const char* name;
  std::size_t count = 0;
  std::size_t highest_index = 0;  ///< Highest index used so far, from 1.
  std::size_t highest_line = 0;   ///< Line that used it.
};

/// Names of polygons.
struct Names {
  std::vector<std::string> groups;
  std::string object, material;
  auto operator<=>(const Names&) const = default;
};

class ObjReader {
 public:
  explicit ObjReader(const MeshSource& source) : source_(source), text_(source) {}

  RawMesh read() {
    while (text_.next_line()) statement(text_.word());
    for (const ObjList& list : lists_) {
      const bool is_left_out = list.count == 0 && &list != &lists_[0];
      if (list.highest_index <= list.count || is_left_out) continue;
      text_.fail_at(list.highest_line, "there is no " + std::string(list.name) + " " +
                                           std::to_string(list.highest_index) + ", the file has " +
                                           std::to_string(list.count) + "; export the mesh again");
    }
    set_corner_attributes();
    return std::move(mesh_);
  }

 private:
  void statement(std::string_view keyword) {
    if (keyword == "v") {
      mesh_.vertices.push_back(text_.point());
      ++lists_[0].count;
    } else if (keyword == "vt") {
      const double u = text_.number_or_nan();
      const std::string_view v = text_.word();
      uvs_.push_back(Vec2(u, v.empty() ? 0 : text_.to_number_or_nan(v)).cast<float>());
      ++lists_[1].count;
    } else if (keyword == "vn") {
      normals_.push_back(text_.point_or_nan().cast<float>());
      ++lists_[2].count;
    } else if (keyword == "f" || keyword == "fo") {
      face();
    } else if (keyword == "g") {
      names_.groups.clear();
      for (std::string_view name; !(name = text_.word()).empty();) names_.groups.emplace_back(name);
      group_ = RawMesh::kNoGroup;
    } else if (keyword == "o") {
      names_ = {{}, text_.words(), names_.material};
      group_ = RawMesh::kNoGroup;
    } else if (keyword == "mtllib") {
      appearances_.merge(read_mtl(source_, text_.words(), mesh_.missing_files));
    } else if (keyword == "usemtl") {
      names_.material = text_.words();
      group_ = RawMesh::kNoGroup;
    }
  }

  /// Returns the index of the group with the current names; a file may return to earlier names.
  std::uint32_t group() {
    if (group_ != RawMesh::kNoGroup || names_ == Names()) return group_;
    const auto number = static_cast<std::uint32_t>(mesh_.groups.size());
    const auto [known, is_new] = group_of_names_.try_emplace(names_, number);
    group_ = known->second;
    if (!is_new) return group_;
    std::vector<std::string> names = names_.groups;
    for (const std::string& name : {names_.object, names_.material}) {
      if (!name.empty()) names.push_back(name);
    }
    const auto appearance = appearances_.find(names_.material);
    mesh_.groups.push_back({std::move(names), {}});
    if (appearance != appearances_.end()) mesh_.groups.back().appearance = appearance->second;
    return group_;
  }

  void face() {
    polygon_.clear();
    for (std::string_view word = text_.word(); !word.empty(); word = text_.word()) {
      std::array<std::uint32_t, 3> corner{};  // vertex, uv, normal; from 1, 0: none
      for (std::size_t k = 0; k < 3 && !word.empty(); ++k) {
        const std::size_t slash = std::min(word.find('/'), word.size());
        if (slash > 0) corner[k] = resolve(lists_[k], text_.to_integer(word.substr(0, slash)));
        word.remove_prefix(std::min(slash + 1, word.size()));
      }
      if (corner[0] == 0) text_.fail("a corner of a face has no vertex; export the mesh again");
      polygon_.push_back(corner[0] - 1);
      corner_uvs_.push_back(corner[1]);
      corner_normals_.push_back(corner[2]);
    }
    add_polygon(mesh_, polygon_);
    mesh_.polygons.back().group = group();
    if (mesh_.polygons.size() % 4096 == 0) source_.check_size(mesh_);
  }

  /// Returns an index from 1; negative indices count from the end of the list so far.
  std::uint32_t resolve(ObjList& list, std::int64_t index) {
    const auto count = static_cast<std::int64_t>(list.count);
    if (index == 0 || index < -count || index > std::int64_t{0x7fffffff}) {
      text_.fail("there is no " + std::string(list.name) + " " + std::to_string(index) + " among " +
                 std::to_string(count) + "; export the mesh again");
    }
    const auto from_one = static_cast<std::size_t>(index > 0 ? index : count + index + 1);
    if (from_one > list.highest_index) {
      list.highest_index = from_one;
      list.highest_line = text_.line();
    }
    return static_cast<std::uint32_t>(from_one);
  }

  void set_corner_attributes() {
    for (std::size_t c = 0; c < mesh_.corners.size(); ++c) {
      const std::uint32_t uv = corner_uvs_[c], normal = corner_normals_[c];
      const bool has_uv = uv > 0 && !uvs_.empty(), has_normal = normal > 0 && !normals_.empty();
      mesh_.corner_uvs.push_back(has_uv ? uvs_[uv - 1] : Vec2f(Vec2f::Zero()));
      mesh_.corner_normals.push_back(has_normal ? normals_[normal - 1] : Vec3f(Vec3f::Zero()));
    }
  }

  const MeshSource& source_;
  MeshText text_;
  RawMesh mesh_;
  std::vector<Vec2f> uvs_;
  std::vector<Vec3f> normals_;
  Names names_;
  /// Group of `names_`, or kNoGroup if not determined yet.
  std::uint32_t group_ = RawMesh::kNoGroup;
  std::map<Names, std::uint32_t> group_of_names_;
  std::map<std::string, Appearance> appearances_;  ///< By name of the material.
  std::vector<std::uint32_t> polygon_, corner_uvs_, corner_normals_;
  std::array<ObjList, 3> lists_{{{"vertex"}, {"texture coordinate"}, {"normal"}}};
};

}  // namespace

RawMesh read_obj(const MeshSource& source) { return ObjReader(source).read(); }

}  // namespace sunder
