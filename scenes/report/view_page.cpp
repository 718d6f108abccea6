#include "scenes/report/view_page.h"

#include <algorithm>
#include <cstring>
#include <fstream>
#include <functional>
#include <map>
#include <optional>
#include <string_view>

#include "engine/base/check.h"
#include "engine/io/bytes.h"
#include "engine/io/unfinished_file.h"
#include "scenes/report/page.h"
#include "scenes/report/viewer_files.h"

namespace sunder::scenes {
namespace {

constexpr std::string_view kThreeFiles[] = {"build/three.min.js",
                                            "examples/js/controls/OrbitControls.js"};
constexpr std::string_view kThreeRevision = "REVISION=\"111\"";
constexpr std::uint32_t kGlbMagic = 0x46546c67, kJsonChunk = 0x4e4f534a;
constexpr std::size_t kGlbHeader = 20;  // with that of the first chunk
// Compressions of meshes and images that need a decoder.
constexpr std::string_view kUnreadable[] = {"KHR_draco_mesh_compression", "EXT_meshopt_compression",
                                            "KHR_texture_basisu"};

std::string read_text(const std::filesystem::path& path) {
  const std::vector<std::byte> bytes = read_file(path, file_kinds::kText);
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// Throws InputError if the bytes are not those of a GLB that the page can show.
void check_glb(const std::vector<std::byte>& bytes, const std::string& file) {
  std::uint32_t header[5] = {};  // magic, version, length; length and type of the first chunk
  if (bytes.size() >= kGlbHeader) std::memcpy(header, bytes.data(), kGlbHeader);
  if (header[0] != kGlbMagic || header[4] != kJsonChunk)
    throw InputError(file + ": not a GLB file; write one with sunder export");
  if (header[1] != 2) {
    throw InputError(file + ": version " + std::to_string(header[1]) +
                     " of glTF; only version 2 can be shown");
  }
  if (header[2] > bytes.size() || header[3] > bytes.size() - kGlbHeader)
    throw InputError(file + ": the file is truncated or corrupt");
  const std::string_view json(reinterpret_cast<const char*>(bytes.data()) + kGlbHeader, header[3]);
  for (const std::string_view extension : kUnreadable) {
    if (json.find(extension) == std::string_view::npos) continue;
    throw InputError(file + ": uses " + std::string(extension) +
                     ", which the page cannot decode; write the file without compression");
  }
}

/// Returns the code of three.js. Throws InputError as check_three() does.
std::string read_three(const std::filesystem::path& folder) {
  std::string code;
  for (const std::string_view name : kThreeFiles) {
    const std::filesystem::path file = folder / name;
    if (!std::filesystem::is_regular_file(file)) {
      throw InputError(file.string() +
                       " is missing: install three.js r111, the Debian package libjs-three, or "
                       "name its folder with --three");
    }
    code += read_text(file) + "\n";
  }
  if (code.find(kThreeRevision) == std::string::npos) {
    throw InputError("--three " + folder.string() +
                     ": another version of three.js than r111, for which the page is written");
  }
  return code;
}

/// Writes text with every "{{name}}" replaced by what `insert` writes for the name.
void fill_in(std::string_view text, std::ostream& out,
             const std::map<std::string_view, std::function<void()>>& insert) {
  while (true) {
    const std::size_t begin = text.find("{{");
    out << text.substr(0, begin);
    if (begin == std::string_view::npos) return;
    const std::size_t end = text.find("}}", begin);
    insert.at(text.substr(begin + 2, end - begin - 2))();
    text.remove_prefix(end + 2);
  }
}

}  // namespace

void check_three(const std::filesystem::path& folder) { read_three(folder); }

void check_run(const std::filesystem::path& run) {
  check_glb(read_file(run, file_kinds::kRun), run.string());
}

std::uint64_t write_view_page(const std::filesystem::path& path, const ViewPage& page) {
  const std::string three = read_three(page.three);
  const std::vector<std::byte> run = read_file(page.run, file_kinds::kRun);
  check_glb(run, page.run.string());
  std::optional<UnfinishedFile> unfinished;
  if (!is_device(path)) unfinished.emplace(path);
  std::ofstream out = create_file(unfinished ? unfinished->path() : path);
  using namespace viewer_files;
  fill_in(page_html, out,
          {{"title", [&] { out << escaped(page.title); }},
           {"style", [&] { out << page_css; }},
           {"libraries", [&] { out << three; }},
           {"scripts", [&] { out << glb_js << motion_js << stage_js << player_js; }},
           {"run", [&] {
              const std::span bytes(reinterpret_cast<const std::uint8_t*>(run.data()), run.size());
              write_base64(bytes, out);
            }}});
  const auto size = static_cast<std::uint64_t>(std::max<std::streamoff>(0, out.tellp()));
  out.close();
  if (!out) throw FileError(path.string() + ": cannot be written; is the disk full?");
  if (unfinished) unfinished->publish();
  return size;
}

}  // namespace sunder::scenes
