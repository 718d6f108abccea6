// Things of a scene by their names.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "engine/model/scene.h"
#include "scenes/file/value.h"

namespace sunder::scenes {

/// Who is called what in a scene being read, and where that is written. What is given no name gets
/// one of its own.
class Names {
 public:
  /// A name that was given. Throws InputError, naming both places, if it was given before.
  void give(const std::string& name, const std::string& where);
  /// A name for what has none: `usual`, or "usual 2", "usual 3" and so on where that is taken. To
  /// be asked for when all are given that will be.
  std::string pick(const std::string& usual, const std::string& where);
  /// Throws InputError if `value` is a name that more than one thing goes by for want of their own.
  void check_reference(const Value& value) const;

 private:
  std::map<std::string, std::string> where_;   ///< Of each name.
  std::map<std::string, std::string> shared_;  ///< Usual names that were taken: where next.
};

/// Indices of solids, then of balls; the parts "wall.0", "wall.1" … of a structure go by "wall"
/// together. Throws InputError with the place of `value` if there is none.
std::vector<std::uint32_t> roots_named(const Scene& scene, const std::string& name,
                                       const Value& value);

/// Whether the world holds a solid; balls it never holds.
bool is_anchored(const Scene& scene, std::uint32_t root);

}  // namespace sunder::scenes
