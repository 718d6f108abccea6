// Camera and light, as a scene file, a camera's file or the user says.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/file/value.h"

namespace sunder::scenes {

/// What [view] says, if the document has one, with its keys. Throws InputError for a view that
/// nothing can be seen in.
void read_view(const Value& document, Scene& scene);

/// The path of a camera from a file of [[key]] tables. Throws InputError naming file, line, key and
/// what is allowed.
std::vector<ViewKey> load_view_keys(const std::filesystem::path& file);

/// Changes how something that has been simulated is looked at, by `set` as in LoadOptions. Throws
/// InputError for all but keys of [view]; `what` is what errors call it.
void change_view(View& view, const std::vector<std::string>& set, const std::string& what);

}  // namespace sunder::scenes
