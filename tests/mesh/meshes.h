// Where the tests find real meshes, which are kept beside the project.
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace sunder::test {

/// SUNDER_MESHES, or the folder that lies beside the sources; may not exist.
inline std::filesystem::path meshes_folder() {
  if (const char* folder = std::getenv("SUNDER_MESHES")) return folder;
  return SUNDER_MESHES_FOLDER;
}

/// The files of a set ("good" or "nasty"), in order.
inline std::vector<std::filesystem::path> meshes(const std::string& set) {
  std::vector<std::filesystem::path> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(meshes_folder() / set, error)) {
    files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace sunder::test

/// Skips a test that needs real meshes where there are none.
#define SUNDER_NEEDS_MESHES()                                                                  \
  if (!std::filesystem::is_directory(sunder::test::meshes_folder())) {                         \
    GTEST_SKIP() << "no meshes in " << sunder::test::meshes_folder() << ": set SUNDER_MESHES"; \
  }
