#include "scenes/file/mesh_cache.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <utility>

#include "engine/base/build_id.h"
#include "engine/base/check.h"
#include "engine/geometry/repair/repair.h"
#include "engine/io/compound_file.h"

namespace sunder::scenes {
namespace {

namespace fs = std::filesystem;

/// Maximum size of all entries, in bytes: the entries of older builds are never read again.
constexpr std::uintmax_t kMostBytes = 512'000'000;

template <class Vectors>
void put_all(ByteWriter& out, const Vectors& vectors) {
  out.put(std::uint64_t{vectors.size()});
  for (const auto& vector : vectors) out.put(vector);
}

fs::path entry(std::uint64_t key) {
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

/// Marks an entry as used now, so that it is among the last to be removed.
void touch(const fs::path& file) {
  std::error_code ignored;
  fs::last_write_time(file, fs::file_time_type::clock::now(), ignored);
}

}  // namespace

RawMesh cache_probe() {
  RawMesh mesh;
  for (const bool turned : {false, true}) {
    const auto first = static_cast<std::uint32_t>(mesh.vertices.size());
    for (int i = 0; i < 8; ++i) {
      const Vec3 corner(i & 1 ? 1.0 : -1.0, i & 2 ? 0.7 : -0.7, i & 4 ? 0.4 : -0.4);
      const Vec3 in_turned(0.6 * corner.x() - 0.8 * corner.y() + 0.9,
                           0.8 * corner.x() + 0.6 * corner.y() + 0.3, 1.3 * corner.z());
      mesh.vertices.push_back(turned ? in_turned : corner);
    }
    for (const auto& face :
         {std::array{0u, 4u, 6u, 2u}, std::array{1u, 3u, 7u, 5u}, std::array{0u, 1u, 5u, 4u},
          std::array{2u, 6u, 7u, 3u}, std::array{0u, 2u, 3u, 1u}, std::array{4u, 5u, 7u, 6u}}) {
      mesh.polygons.push_back({static_cast<std::uint32_t>(mesh.corners.size()), 4});
      for (const std::uint32_t corner : face) mesh.corners.push_back(first + corner);
    }
  }
  return mesh;
}

std::uint64_t decomposition_digest(RawMesh probe) {
  RepairedMesh repaired = repair_mesh(std::move(probe), "probe", {});
  fracture::VacdOptions options;
  options.node_count = 3;
  fracture::Vacd vacd = fracture::decompose(repaired, options);
  MeshSolid solid;
  solid.repairs = std::move(repaired.repairs);
  solid.compound = std::move(vacd.compound);
  solid.vacd = vacd.figures;
  ByteWriter all;
  put(all, solid);
  all.put(build_id());
  return hash_bytes(all.bytes);
}

std::uint64_t cache_key(const RawMesh& mesh, const fracture::VacdOptions& vacd,
                        const std::string& repair, std::uint64_t digest) {
  ByteWriter all;
  all.put(digest);
  put_all(all, mesh.vertices);
  put_all(all, mesh.corner_normals);
  put_all(all, mesh.corner_uvs);
  for (const std::uint32_t corner : mesh.corners) all.put(corner);
  for (const RawMesh::Polygon& polygon : mesh.polygons)
    all.put(polygon.corner_count, polygon.group);
  put_all(all, vacd.nodes);
  put_all(all, vacd.materials_by_appearance);
  put_all(all, vacd.textured_by_appearance);
  all.put(vacd.node_count.value_or(0), vacd.convexes, vacd.polygons, vacd.fit.kind,
          vacd.fit.vertex_count, repair);
  return hash_bytes(all.bytes);
}

std::uint64_t cache_key(const RawMesh& mesh, const fracture::VacdOptions& vacd,
                        const std::string& repair) {
  static const std::uint64_t digest = decomposition_digest(cache_probe());
  return cache_key(mesh, vacd, repair, digest);
}

fs::path cache_folder() {
  if (const char* folder = std::getenv("SUNDER_CACHE")) return folder;
  if (const char* folder = std::getenv("XDG_CACHE_HOME"); folder && *folder) {
    return fs::path(folder) / "sunder";
  }
  if (const char* home = std::getenv("HOME"); home && *home) {
    return fs::path(home) / ".cache/sunder";
  }
  return {};
}

void trim_cache(std::uintmax_t most_bytes) {
  struct Entry {
    fs::file_time_type used;
    fs::path file;
    std::uintmax_t size = 0;
  };
  std::vector<Entry> entries;
  std::uintmax_t total = 0;
  std::error_code error;
  for (fs::directory_iterator at(cache_folder(), error), end; !error && at != end;
       at.increment(error)) {
    if (!at->path().filename().string().starts_with("vacd-")) continue;
    std::error_code gone;
    const auto size = at->file_size(gone);
    const auto used = at->last_write_time(gone);
    if (gone) continue;
    entries.push_back({used, at->path(), size});
    total += size;
  }
  std::ranges::sort(entries, {}, &Entry::used);
  for (const Entry& oldest : entries) {
    if (total <= most_bytes) break;
    total -= oldest.size;
    fs::remove(oldest.file, error);
  }
}

std::optional<MeshSolid> load_cached(std::uint64_t key) {
  if (cache_folder().empty() || !fs::exists(entry(key))) return std::nullopt;
  try {
    const std::string file = entry(key).string();
    const std::vector<std::byte> bytes = read_file(file, file_kinds::kMesh);
    ByteReader head(bytes, file);
    if (head.take<std::uint64_t>() != key) return std::nullopt;
    const auto hash = head.take<std::uint64_t>();
    const std::vector<std::byte> content(bytes.begin() + 16, bytes.end());
    if (hash_bytes(content) != hash) return std::nullopt;
    ByteReader in(content, file);
    MeshSolid solid = take(in, file);
    touch(entry(key));
    return solid;
  } catch (const InputError&) {
    return std::nullopt;  // the entry is overwritten by the new decomposition
  }
}

void store_cached(std::uint64_t key, const MeshSolid& solid) {
  if (cache_folder().empty()) return;
  ByteWriter content, file;
  put(content, solid);
  for (const std::uint64_t value : {key, hash_bytes(content.bytes)}) file.put(value);
  file.bytes.insert(file.bytes.end(), content.bytes.begin(), content.bytes.end());
  try {
    write_file(entry(key), file.bytes);
    trim_cache(kMostBytes);
  } catch (const FileError&) {
    // The run goes on without a cache that cannot be written.
  }
}

}  // namespace sunder::scenes
