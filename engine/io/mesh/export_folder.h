// A folder of files that an export writes, and replaces when it is repeated.
#pragma once

#include <filesystem>
#include <functional>
#include <string>

#include "engine/io/unfinished_file.h"

namespace sunder {

/// A folder under a temporary name, removed with this object unless it is published.
class ExportFolder {
 public:
  /// Plans a folder at `place`, which may end in a slash. Throws InputError if there is a file, or
  /// a folder that has other files than those whose names `is_own` accepts. Writes nothing.
  ExportFolder(const std::filesystem::path& place,
               const std::function<bool(const std::string& name)>& is_own);

  /// Returns the path of the incomplete folder, which writing a file in it creates.
  const std::filesystem::path& path() const { return partial_.path(); }
  /// Renames the folder to its place, and removes the folder that was there. Throws FileError.
  void publish();

 private:
  std::filesystem::path place_;
  UnfinishedFile partial_;
};

}  // namespace sunder
