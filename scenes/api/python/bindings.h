// Shared by the sources of the Python module: conversion of arguments, views of arrays, and the
// functions that define the classes.
//
// Read first: module.cpp, then bind_world.cpp.
#pragma once

#include <pybind11/eigen.h>
#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "engine/model/frame.h"
#include "engine/model/material.h"
#include "engine/world/world.h"

namespace sunder::python {

namespace py = pybind11;

/// Quaternion as Python passes it: x, y, z, w.
using Xyzw = Eigen::Vector4d;
/// A material by its name, or by its index. Indices that add_material() returned know the name.
struct MaterialName {
  std::string name;  ///< Empty: whatever has the index.
  std::optional<std::uint32_t> index;
};
/// The index of a material that was added.
struct AddedMaterial {
  std::uint32_t index = 0;
  std::string name;
};
/// An array of points, or of triangles: a conversion to integers would wrap what is out of range.
using Points = py::array_t<double, py::array::c_style | py::array::forcecast>;
using Triangles = Points;

/// A frame in Python.
struct SharedFrame {
  FramePtr frame;
};

/// Marks an object as in use while the interpreter is unlocked. Throws std::runtime_error, the
/// RuntimeError of Python, if another thread uses the object.
class Use {
 public:
  explicit Use(bool& is_used);
  ~Use();
  Use(const Use&) = delete;
  Use& operator=(const Use&) = delete;

 private:
  bool& is_used_;
};

/// Returns the rotation of a quaternion of any length. Throws InputError if the length is zero or
/// not finite.
Quat rotation_of(const Xyzw& xyzw);
/// Returns a pose of the position and the rotation.
Pose pose_of(const Vec3& position, const Xyzw& xyzw);
/// Returns the points of an array of shape (n, 3). Throws InputError, with `name`, for another
/// shape.
std::vector<Vec3> points_of(const Points& points, const std::string& name);
/// Returns the index of a material among `names`. Throws InputError that lists the names if there
/// is none of this name, or if an index has another name; other indices are checked by their user.
MaterialIndex material_of(const MaterialName& material, const std::vector<std::string>& names);
/// Returns the name that worlds must have at the index of a material; none if any may be there.
Asset::MaterialNames names_of(const MaterialName& material);
std::vector<std::string> names_of(std::span<const Material> materials);
/// Returns the names of the built-in materials, which the lists of all scenes begin with.
const std::vector<std::string>& builtin_names();
/// Parses a pattern, or "none".
PatternSpec pattern_of(const std::string& text);
/// Returns the text of a pattern as parse_pattern() expects it.
std::string text_of(const PatternSpec& pattern);

/// Returns an array without copying: `data` is part of `owner`, which lives as long as the array.
/// The array is read-only. Strides are in bytes.
py::array view_of(const std::shared_ptr<const void>& owner, const py::dtype& type, const void* data,
                  const std::vector<py::ssize_t>& shape, const std::vector<py::ssize_t>& strides);

/// Returns a view of one member of each element of an array of structures: a scalar if `width` is
/// 0, else `width` values of type Value. `first` is the member of the first element.
template <class Value, class Element>
py::array column_of(const std::shared_ptr<const void>& owner, const std::vector<Element>& elements,
                    const void* first, py::ssize_t width = 0) {
  const auto count = static_cast<py::ssize_t>(elements.size());
  const auto stride = static_cast<py::ssize_t>(sizeof(Element));
  const auto value = static_cast<py::ssize_t>(sizeof(Value));
  if (width == 0) return view_of(owner, py::dtype::of<Value>(), first, {count}, {stride});
  return view_of(owner, py::dtype::of<Value>(), first, {count, width}, {stride, value});
}

/// Returns a view of an array of plain values: a row for each element, of `width` values.
template <class Value, class Element>
py::array rows_of(const std::shared_ptr<const void>& owner, const std::vector<Element>& elements,
                  py::ssize_t width = 0) {
  return column_of<Value>(owner, elements, elements.data(), width);
}

/// Returns a report as a dict, with the names of the JSON of the program.
py::dict dict_of(const FrameReport& report);
/// Returns the hash of one state: 16 hexadecimal digits.
std::string hash_of(const FramePtr& frame);

/// Makes the class of the indices that add_material() returns.
void bind_added_materials(py::module_& module);
void bind_materials(py::module_& module);
void bind_assets(py::module_& module);
void bind_scenes(py::module_& module);
void bind_frames(py::module_& module);
void bind_worlds(py::module_& module);
void bind_recordings(py::module_& module);
void bind_fracture(py::module_& module);
void bind_renderer(py::module_& module);

}  // namespace sunder::python

namespace pybind11::detail {

template <>
struct type_caster<sunder::python::MaterialName> {
  PYBIND11_TYPE_CASTER(sunder::python::MaterialName, const_name("Union[str, int]"));
  bool load(handle from, bool convert);
};

template <>
struct type_caster<sunder::python::AddedMaterial> {
  PYBIND11_TYPE_CASTER(sunder::python::AddedMaterial, const_name("int"));
  static handle cast(const sunder::python::AddedMaterial& added, return_value_policy, handle);
};

}  // namespace pybind11::detail
