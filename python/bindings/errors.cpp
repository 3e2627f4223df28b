#include "errors.h"

#include "echopath/base/errors.h"

namespace echopath::bindings {
namespace {

namespace py = pybind11;

void translate_cancelled(std::exception_ptr failure) {
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const Cancelled& cancelled) {
    PyErr_SetString(PyExc_KeyboardInterrupt, cancelled.what());
  }
}

}  // namespace

void register_errors(py::module_& m) {
  // Users meet these names in the package, not in the extension.
  const auto name = [](py::object error, const char* meaning) {
    error.attr("__module__") = "echopath";
    error.attr("__doc__") = meaning;
  };
  name(py::register_exception<FileError>(m, "FileError", PyExc_OSError), "A file cannot be read or written; an OSError.");
  name(py::register_exception<DeviceError>(m, "DeviceError", PyExc_RuntimeError), "A device failed; a RuntimeError.");
  py::register_exception_translator(&translate_cancelled);
}

}  // namespace echopath::bindings
