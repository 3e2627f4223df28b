#pragma once
// Methods of the extension's classes whose work the package does: tables, pictures, files. They are part of the class, so
// that help and editors show them; the module is imported when the method is called, and the core knows nothing of it.
#include <pybind11/pybind11.h>

#include <string>

namespace echopath::bindings {

namespace py = pybind11;

// A function of a module of the package, such as in_package("plots.axes", "draw").
inline py::object in_package(const char* module, const char* function) {
  return py::module_::import(("echopath." + std::string(module)).c_str()).attr(function);
}

// A method or a getter without arguments: function(self).
inline auto from_package(const char* module, const char* function) {
  return [module, function](const py::object& self) { return in_package(module, function)(self); };
}

}  // namespace echopath::bindings
