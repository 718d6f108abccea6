#include "scenes/file/mesh_cache.h"

#include <cstdio>
#include <cstdlib>

#include "engine/base/check.h"
#include "engine/io/compound_file.h"

namespace sunder::scenes {
namespace {

/// To be increased whenever results of reading, repair or decomposition, or this layout, change.
constexpr std::uint64_t kVersion = 7;

template <class Vectors>
void put_all(ByteWriter& out, const Vectors& vectors) {
  out.put(std::uint64_t{vectors.size()});
  for (const auto& vector : vectors) out.put(vector);
}

std::filesystem::path entry(std::uint64_t key) {
  char name[40];
  std::snprintf(name, sizeof name, "vacd-%016llx.bin", static_cast<unsigned long long>(key));
  return cache_folder() / name;
}

void put(ByteWriter& out, const MeshSolid& solid) {
  out.put(std::uint64_t{solid.vertices}, std::uint64_t{solid.faces}, solid.closed);
  out.put(static_cast<std::uint32_t>(solid.repairs.size()));
  for (const Repair& repair : solid.repairs) {
    out.put(repair.name, std::uint64_t{repair.count}, repair.harmless);
  }
  fracture::VacdFigures figures = *solid.vacd;
  figures.split_ms = figures.total_ms = 0;  // times vary: equal meshes give equal bytes
  out.put(figures);
  put(out, solid.compound);
}

MeshSolid take(ByteReader& in, const std::string& file) {
  MeshSolid solid;
  in.take_to(solid.vertices, solid.faces, solid.closed);
  solid.repairs.resize(in.take_count(4));
  for (Repair& repair : solid.repairs) in.take_to(repair.name, repair.count, repair.harmless);
  solid.vacd = in.take<fracture::VacdFigures>();
  solid.compound = take_compound(in, file);
  if (!in.at_end()) throw InputError(file + ": corrupt: too long");
  return solid;
}

}  // namespace

std::uint64_t cache_key(const RawMesh& mesh, const fracture::VacdOptions& vacd,
                        const std::string& repair) {
  ByteWriter all;
  all.put(kVersion);
  put_all(all, mesh.vertices);
  put_all(all, mesh.corner_normals);
  put_all(all, mesh.corner_uvs);
  for (const std::uint32_t corner : mesh.corners) all.put(corner);
  for (const RawMesh::Polygon& polygon : mesh.polygons)
    all.put(polygon.corner_count, polygon.group);
  put_all(all, vacd.nodes);
  put_all(all, vacd.materials_by_appearance);
  put_all(all, vacd.textured_by_appearance);
  all.put(vacd.node_count.value_or(0), vacd.convexes, vacd.fit.kind, vacd.fit.vertex_count, repair);
  return hash_bytes(all.bytes);
}

std::filesystem::path cache_folder() {
  if (const char* folder = std::getenv("SUNDER_CACHE")) return folder;
  if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder && *folder) {
    return std::filesystem::path(folder) / "sunder";
  }
  if (const char* home = std::getenv("HOME"); home && *home) {
    return std::filesystem::path(home) / ".cache/sunder";
  }
  return {};
}

std::optional<MeshSolid> load_cached(std::uint64_t key) {
  if (cache_folder().empty() || !std::filesystem::exists(entry(key))) return std::nullopt;
  try {
    const std::string file = entry(key).string();
    const std::vector<std::byte> bytes = read_file(file);
    ByteReader head(bytes, file);
    if (head.take<std::uint64_t>() != kVersion || head.take<std::uint64_t>() != key) {
      return std::nullopt;
    }
    const auto hash = head.take<std::uint64_t>();
    const std::vector<std::byte> content(bytes.begin() + 24, bytes.end());
    if (hash_bytes(content) != hash) return std::nullopt;
    ByteReader in(content, file);
    return take(in, file);
  } catch (const InputError&) {
    return std::nullopt;  // the entry is overwritten by the new decomposition
  }
}

void store_cached(std::uint64_t key, const MeshSolid& solid) {
  if (cache_folder().empty()) return;
  ByteWriter content, file;
  put(content, solid);
  for (const std::uint64_t value : {kVersion, key, hash_bytes(content.bytes)}) file.put(value);
  file.bytes.insert(file.bytes.end(), content.bytes.begin(), content.bytes.end());
  try {
    write_file(entry(key), file.bytes);
  } catch (const FileError&) {
    // The run goes on without a cache that cannot be written.
  }
}

}  // namespace sunder::scenes
