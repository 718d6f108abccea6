#include "engine/io/mesh/export_folder.h"

#include <unistd.h>

#include "engine/base/check.h"

namespace sunder {
namespace {

namespace fs = std::filesystem;

void check_replaceable(const fs::path& folder,
                       const std::function<bool(const std::string& name)>& is_own) {
  if (!fs::exists(folder)) return;
  if (!fs::is_directory(folder))
    throw InputError(folder.string() + ": is a file; give the name of a folder");
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    if (is_own(entry.path().filename().string())) continue;
    throw InputError(
        folder.string() +
        ": the folder has files that are not of an earlier export; choose another folder");
  }
}

}  // namespace

ExportFolder::ExportFolder(const fs::path& place,
                           const std::function<bool(const std::string& name)>& is_own)
    : place_(place.has_filename() ? place : place.parent_path()), partial_(place_) {
  check_replaceable(place_, is_own);
  std::error_code ignored;
  fs::remove_all(partial_.path(), ignored);
}

void ExportFolder::publish() {
  const fs::path old = place_.string() + ".old" + std::to_string(::getpid());
  std::error_code error, no_old, ignored;
  fs::rename(place_, old, no_old);
  fs::rename(partial_.path(), place_, error);
  if (error) {
    if (!no_old) fs::rename(old, place_, ignored);
    throw FileError(place_.string() + ": cannot be written; check the folder and its permissions");
  }
  fs::remove_all(old, ignored);
}

}  // namespace sunder
