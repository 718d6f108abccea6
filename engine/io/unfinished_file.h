// Files under temporary names until they are complete.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string_view>

namespace sunder {

/// A file, or a folder of files, that is not complete yet. It is removed with this object unless it
/// is published, and by remove_unfinished_files().
class UnfinishedFile {
 public:
  /// Chooses a name in the folder of `place`, with the process id and `ending`. Creates nothing.
  explicit UnfinishedFile(const std::filesystem::path& place, std::string_view ending = "");
  UnfinishedFile(const UnfinishedFile&) = delete;
  UnfinishedFile& operator=(const UnfinishedFile&) = delete;
  ~UnfinishedFile();

  /// Returns the path to write to.
  const std::filesystem::path& path() const { return path_; }
  /// Names the process group that writes the file, whose leader is a child of this process; 0, the
  /// default, is none. remove_unfinished_files() kills it.
  void set_writer(int group);
  /// Renames the complete file to its place. On failure removes it and throws FileError.
  void publish();

 private:
  void take_off();

  std::filesystem::path place_, path_;
  std::size_t slot_ = 0;  ///< Place in the list of unfinished files.
};

/// Kills the writers of all unfinished files of this process, and removes the files. A signal
/// handler may call it, if it ends the process.
void remove_unfinished_files();

}  // namespace sunder
