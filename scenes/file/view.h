// Camera and light from a scene file, from a camera path's file, and from --set.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/file/value.h"

namespace sunder::scenes {

/// Reads [view] and its [[view.key]] into a scene, if the document has them. Throws InputError,
/// also for a zero direction of the sun or an eye at its target.
void read_view(const Value& document, Scene& scene);

/// Reads the path of a camera from a file of [[key]] tables. Throws InputError that names file,
/// line, key and the allowed values.
std::vector<ViewKey> load_view_keys(const std::filesystem::path& file);

/// Changes the view of a stored frame or recording by assignments as in LoadOptions::set; errors
/// call it `what`. Throws InputError for all keys but those of [view].
void change_view(View& view, const std::vector<std::string>& set, const std::string& what);

}  // namespace sunder::scenes
