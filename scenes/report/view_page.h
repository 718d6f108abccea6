// A page that plays a run, as one HTML file without links: the viewer in viewer/, three.js and the
// run.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>

namespace sunder::scenes {

/// Folder in which the Debian package libjs-three installs three.js.
inline constexpr const char* kThreeFolder = "/usr/share/javascript/three";

/// Content of a view page.
struct ViewPage {
  std::string title;
  std::filesystem::path run;                   ///< GLB file.
  std::filesystem::path three = kThreeFolder;  ///< Has build/ and examples/ of three.js r111.
};

/// Throws InputError if the folder does not have three.js r111.
void check_three(const std::filesystem::path& folder);
/// Throws InputError if a file is no complete GLB, or has meshes in a compression that the page
/// cannot decode.
void check_run(const std::filesystem::path& run);
/// Writes the page under a temporary name and renames it; returns its size in bytes. Throws
/// InputError as the two checks do, and FileError.
std::uint64_t write_view_page(const std::filesystem::path& path, const ViewPage& page);

}  // namespace sunder::scenes
