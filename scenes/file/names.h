// Names of a scene's solids, bodies and balls.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/file/value.h"

namespace sunder::scenes {

/// The names used in a scene while it is read, with their places; makes unique default names.
class Names {
 public:
  /// Reserves a name given at `where`. Throws InputError if it is reserved, naming both places.
  void reserve(const std::string& name, const std::string& where);
  /// Reserves and returns a name for a table at `where` that gives none: `default_name`, or
  /// "default_name 2", "default_name 3" and so on if that is taken. To be called once all given
  /// names are reserved.
  std::string reserve_default(const std::string& default_name, const std::string& where);
  /// Throws InputError if `value` is a default name of several tables, and so ambiguous.
  void check_reference(const Value& value) const;

 private:
  std::map<std::string, std::string> where_;  ///< Place of each name.
  /// Default names that were taken, with the place of the first table that got another instead.
  std::map<std::string, std::string> ambiguous_;
};

/// Returns the roots of this name, ascending: indices of solids, then of balls. "wall" names all
/// parts "wall.0", "wall.1" and so on of a structure. Throws InputError with the place of `value`
/// if there is none.
std::vector<std::uint32_t> roots_named(const Scene& scene, const std::string& name,
                                       const Value& value);

/// Returns true if a root is a solid that is anchored to the world; balls never are.
bool is_anchored(const Scene& scene, std::uint32_t root);

}  // namespace sunder::scenes
