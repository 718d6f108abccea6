// The Python module: errors, and the classes and functions of the other sources.
#include "engine/base/check.h"
#include "engine/base/parallel.h"
#include "scenes/api/python/bindings.h"

namespace sunder::python {
namespace {

void bind_errors(py::module_& module) {
  py::register_exception<InputError>(module, "InputError", PyExc_ValueError).doc() =
      "The input is wrong: a scene, a mesh, a key, an option, or a file that cannot be read. The "
      "text names the place and what is allowed.";
  py::register_exception<FileError>(module, "FileError", PyExc_OSError).doc() =
      "A file or folder cannot be written.";
}

}  // namespace
}  // namespace sunder::python

PYBIND11_MODULE(_core, module) {
  using namespace sunder::python;
  module.doc() = "The part of the package sunder that is compiled.";
  module.attr("__version__") = SUNDER_VERSION;
  // Classes are known by the name of the package, which has all of them.
  const pybind11::object own_name = module.attr("__name__");
  module.attr("__name__") = "sunder";
  bind_errors(module);
  bind_added_materials(module);
  bind_materials(module);
  bind_assets(module);
  bind_scenes(module);
  bind_frames(module);
  bind_worlds(module);
  bind_recordings(module);
  bind_fracture(module);
  bind_renderer(module);
  module.def("set_threads", &sunder::set_threads, py::arg("count"),
             "Sets the number of threads of all worlds that were made with threads=0, and of "
             "loading and fracture. 0: one per processor.");
  module.attr("__name__") = own_name;
}
