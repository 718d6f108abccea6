// Validation of what a scene is made of, and of what is added to a running world.
#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "engine/model/checks/ranges.h"
#include "engine/model/scene.h"

namespace sunder {

/// Most corners of the faces of a convex: those of 10,000 points of which all are corners of
/// triangles. The solver numbers up to 65,534, so that there is room for those that cuts add.
inline constexpr std::size_t kMostConvexCorners = 60000;

/// Returns the name of an item of a list, as in "balls[2]".
std::string item(const char* list, std::size_t i);
/// Returns a number as messages show it.
std::string number_text(double number);

/// Each function throws InputError for the first invalid member of an item: with the prefix, the
/// member's name, its value and the allowed values. `name` is that of the item.
class ItemCheck {
 public:
  /// `prefix` begins all messages, as in "scene."; `materials` are those that items may have.
  ItemCheck(std::string prefix, std::span<const Material> materials)
      : prefix_(std::move(prefix)), materials_(materials) {}

  [[noreturn]] void refuse(const std::string& what, const std::string& expected) const;
  void need_number(double number, double low, double high, const std::string& name) const;
  void need_number(double number, const Range& range, const std::string& name) const {
    need_number(number, range.low, range.high, name);
  }
  /// Refuses a vector with an element out of the range, or NaN.
  void need_vector(const Vec3& vector, const Range& range, const std::string& name) const;
  void need_finite(const Vec3& vector, const std::string& name) const;
  void material_index(MaterialIndex index, const std::string& name) const;
  void pose(const Pose& X_W, const std::string& name) const;
  void material(const Material& material, const std::string& of) const;
  void pattern(const PatternSpec& pattern, const std::string& name) const;
  /// Checks all but the materials.
  void convexes(const Compound& compound, const std::string& name) const;
  void solid(const Solid& solid, const std::string& name) const;
  void ball(const Ball& ball, const std::string& name) const;
  void shot(const Shot& shot, const std::string& name) const;
  void blast(const Blast& blast, const std::string& name) const;
  // Bodies that these refer to are not checked.
  void drive(const Drive& drive, const std::string& name) const;
  void joint(const Joint& joint, const std::string& name) const;

 private:
  std::string prefix_;
  std::span<const Material> materials_;
};

}  // namespace sunder
