#include "scenes/file/view.h"

#include "engine/base/check.h"
#include "scenes/file/keys.h"
#include "scenes/file/schema.h"
#include "scenes/file/text_file.h"

namespace sunder::scenes {
namespace {

void check_view(const View& view, const std::string& where) {
  if (!view.to_sun_W.isZero() && view.eye_W != view.target_W) return;
  throw InputError(
      where + ": [view] needs a sun that is not zero, and different points for eye and target");
}

std::vector<ViewKey> read_view_keys(const Value& parent, const Keys<ViewKey>& keys) {
  std::vector<ViewKey> path;
  for (const Value* table : tables(parent, "key")) {
    ViewKey key;
    read(keys, *table, {}, key);
    if (!path.empty() && key.time_s <= path.back().time_s) {
      throw InputError(find(*table, "time_s")->where + ": time_s in " + std::string(keys.table) +
                       " is " + format(key.time_s) + ", not after " + format(path.back().time_s) +
                       " of the previous key; sort the keys by time_s");
    }
    if (key.eye_W && key.target_W && *key.eye_W == *key.target_W) {
      throw InputError(table->where + ": eye and target in " + std::string(keys.table) +
                       " are the same point");
    }
    path.push_back(key);
  }
  return path;
}

}  // namespace

void read_view(const Value& document, Scene& scene) {
  if (const Value* table = find(document, "view")) {
    read(schema().view, *table, {}, scene.view);
    scene.view_keys = read_view_keys(*table, schema().view_key);
  }
  check_view(scene.view, document.where);
}

std::vector<ViewKey> load_view_keys(const std::filesystem::path& file) {
  const Value document = parse_toml(read_text(file, file_kinds::kScene), file.string());
  const Key only = table_key("key", "");
  check_known(document, "a camera path", {std::span(&only, 1)});
  Keys<ViewKey> keys = schema().view_key;
  keys.table = "[[key]]";
  std::vector<ViewKey> path = read_view_keys(document, keys);
  if (path.empty()) {
    throw InputError(
        file.string() +
        ": a camera path needs at least one [[key]], with time_s, eye, target, fov_deg");
  }
  return path;
}

void change_view(View& view, const std::vector<std::string>& set, const std::string& what) {
  Value document{what, Table{}};
  for (const std::string& assignment : set) {
    if (!assignment.starts_with("view.")) {
      throw InputError("--set " + assignment + ": " + what +
                       " has been simulated; only keys of [view] can be set, as view.fov_deg=30");
    }
    if (assignment.starts_with("view.key")) {
      throw InputError("--set " + assignment + ": " + what +
                       " has been simulated; give another camera path by --view FILE.toml");
    }
    set_value(document, assignment);
  }
  try {
    if (const Value* table = find(document, "view")) read(schema().view, *table, {}, view);
  } catch (const InputError& error) {
    throw InputError(what + ": " + error.what());
  }
  check_view(view, what);
}

}  // namespace sunder::scenes
