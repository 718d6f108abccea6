#include <pybind11/eval.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "engine/base/check.h"
#include "engine/io/statistics.h"
#include "scenes/api/python/bindings.h"
#include "scenes/load.h"
#include "scenes/solid_break.h"

namespace sunder::python {
namespace {

std::string joined(const std::vector<std::string>& names) {
  std::string all;
  for (const std::string& name : names) all += (all.empty() ? "" : ", ") + name;
  return all;
}

std::string number_text(double number) {
  char text[40];
  std::snprintf(text, sizeof text, "%.9g", number);
  return text;
}

}  // namespace

Use::Use(bool& is_used) : is_used_(is_used) {
  if (is_used) throw std::runtime_error("the object is in use by another thread");
  is_used = true;
}

Use::~Use() { is_used_ = false; }

Quat rotation_of(const Xyzw& xyzw) {
  const double length = xyzw.norm();
  if (!std::isfinite(length) || !(length > 0)) {
    throw InputError("rotation: expected a quaternion x, y, z, w of a finite length above 0");
  }
  Quat rotation;
  rotation.coeffs() = xyzw;
  // A unit quaternion keeps its bits.
  if (std::abs(length - 1) > 1e-12) rotation.coeffs() /= length;
  return rotation;
}

Pose pose_of(const Vec3& position, const Xyzw& xyzw) { return {position, rotation_of(xyzw)}; }

std::vector<Vec3> points_of(const Points& points, const std::string& name) {
  if (points.ndim() != 2 || points.shape(1) != 3) {
    throw InputError(name + ": expected an array of shape (n, 3)");
  }
  const auto rows = points.unchecked<2>();
  std::vector<Vec3> all;
  for (py::ssize_t i = 0; i < rows.shape(0); ++i) {
    const Vec3 point(rows(i, 0), rows(i, 1), rows(i, 2));
    if (!point.allFinite()) {
      throw InputError(name + "[" + std::to_string(i) + "] is not finite; expected three numbers");
    }
    all.push_back(point);
  }
  return all;
}

std::vector<std::string> names_of(std::span<const Material> materials) {
  std::vector<std::string> names;
  for (const Material& material : materials) names.push_back(material.name);
  return names;
}

const std::vector<std::string>& builtin_names() {
  static const std::vector<std::string> names = names_of(scenes::builtin_materials());
  return names;
}

MaterialIndex material_of(const MaterialName& material, const std::vector<std::string>& names) {
  const std::string& name = material.name;
  if (const std::optional<std::uint32_t> index = material.index) {
    if (!name.empty() && (*index >= names.size() || names[*index] != name)) {
      throw InputError("material " + std::to_string(*index) + " was " + name +
                       " where it was added, and is " +
                       (*index < names.size() ? names[*index] : "nothing") +
                       " here; pass the name, or add the material here");
    }
    return MaterialIndex(std::size_t{*index});
  }
  const auto found = std::ranges::find(names, name);
  if (found == names.end()) {
    throw InputError("there is no material '" + name + "'; materials: " + joined(names));
  }
  return MaterialIndex(static_cast<std::size_t>(found - names.begin()));
}

Asset::MaterialNames names_of(const MaterialName& material) {
  if (!material.index || material.name.empty()) return {};
  return {{MaterialIndex(std::size_t{*material.index}), material.name}};
}

void bind_added_materials(py::module_& module) {
  py::dict scope;
  scope["__builtins__"] = py::module_::import("builtins");
  scope["__name__"] = "sunder";
  py::exec(R"(
class MaterialIndex(int):
    """Index of a material that was added, which knows the material's name."""
    def __reduce__(self):
        return int, (int(self),)
)",
           scope, scope);
  module.attr("_MaterialIndex") = scope["MaterialIndex"];
}

PatternSpec pattern_of(const std::string& text) {
  return text == "none" ? PatternSpec() : scenes::parse_pattern(text);
}

std::string text_of(const PatternSpec& pattern) {
  const std::string cells = std::to_string(pattern.cells);
  using Kind = PatternSpec::Kind;
  switch (pattern.kind) {
    case Kind::kNone:
      return "none";
    case Kind::kVoronoi:
      return "voronoi:" + cells + "," + number_text(pattern.falloff);
    case Kind::kWeb:
      return "web:" + std::to_string(pattern.rings) + "x" + std::to_string(pattern.spokes);
    case Kind::kRadial:
      return "radial:" + cells;
    case Kind::kBrick:
      return "brick:" + number_text(pattern.brick_m.x()) + "," + number_text(pattern.brick_m.y()) +
             "," + number_text(pattern.brick_m.z());
    case Kind::kSlabs:
      return "slabs:" + cells;
    case Kind::kGrid:
      return "grid:" + cells;
    case Kind::kFile:
      return pattern.file;
  }
  return "none";
}

py::array view_of(const std::shared_ptr<const void>& owner, const py::dtype& type, const void* data,
                  const std::vector<py::ssize_t>& shape, const std::vector<py::ssize_t>& strides) {
  using Owner = std::shared_ptr<const void>;
  const py::capsule base(new Owner(owner), [](void* held) { delete static_cast<Owner*>(held); });
  py::array array(type, shape, strides, data, base);
  array.attr("setflags")(py::arg("write") = false);
  return array;
}

py::dict dict_of(const FrameReport& report) {
  py::dict dict, stage_ms, stage_cpu_ms, counts, energy, limits;
  for (int stage = 0; stage < kStages; ++stage) {
    stage_ms[kStageNames[stage]] = report.stage_ms[stage];
    stage_cpu_ms[kStageNames[stage]] = report.stage_cpu_ms[stage];
  }
  counts["bodies"] = report.counts.bodies;
  counts["awake"] = report.counts.awake;
  counts["convexes"] = report.counts.convexes;
  counts["compounds"] = report.counts.compounds;
  counts["contacts"] = report.counts.contacts;
  counts["debris"] = report.counts.debris;
  counts["dust"] = report.counts.dust;
  EnergyFlows::for_each(report.energy,
                        [&](const char* name, double value, int) { energy[name] = value; });
  report.limits.for_each(
      [&](const LimitText& text, std::uint32_t count) { limits[text.name] = count; });
  py::list work;
  for (const WorkItem& item : report.work) {
    py::dict one;
    one["stage"] = kStageNames[static_cast<int>(item.stage)];
    one["name"] = item.name;
    one["count"] = item.count;
    one["ms"] = item.ms;
    work.append(one);
  }
  dict["stage_ms"] = stage_ms;
  dict["stage_cpu_ms"] = stage_cpu_ms;
  dict["counts"] = counts;
  dict["work"] = work;
  dict["mass_kg"] = report.mass_kg;
  dict["volume_m3"] = report.volume_m3;
  dict["kinetic_J"] = report.kinetic_J;
  dict["potential_J"] = report.potential_J;
  dict["plastic_J"] = report.plastic_J;
  dict["energy_J"] = energy;
  dict["energy_residual_J"] = report.energy_residual_J;
  dict["momentum_residual"] = report.momentum_residual;
  dict["carried_over"] = report.carried_over;
  dict["failed"] = report.failed;
  dict["failed_m3"] = report.failed_m3;
  dict["limits_hit"] = report.limits_hit;
  dict["limits_hit_by_name"] = limits;
  dict["aged"] = report.aged;
  dict["joints_lost"] = report.joints_lost;
  return dict;
}

std::string hash_of(const FramePtr& frame) {
  StateHash hash;
  hash.take(frame);
  return hash.hex();
}

}  // namespace sunder::python

namespace pybind11::detail {

bool type_caster<sunder::python::MaterialName>::load(handle from, bool convert) {
  if (isinstance<str>(from)) {
    value = {from.cast<std::string>(), std::nullopt};
    return true;
  }
  make_caster<std::uint32_t> number;
  if (!number.load(from, convert)) return false;
  value = {"", cast_op<std::uint32_t>(number)};
  if (hasattr(from, "material_name")) value.name = from.attr("material_name").cast<std::string>();
  return true;
}

handle type_caster<sunder::python::AddedMaterial>::cast(const sunder::python::AddedMaterial& added,
                                                        return_value_policy, handle) {
  object index = module_::import("sunder._core").attr("_MaterialIndex")(added.index);
  index.attr("material_name") = added.name;
  return index.release();
}

}  // namespace pybind11::detail
