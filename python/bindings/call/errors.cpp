#include "call/errors.h"

#include <exception>
#include <string_view>

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

// Text of a file, which a message repeats, may be anything: bytes that are not UTF-8 are written out.
void translate_file_error(std::exception_ptr failure) {
  try {
    if (failure) std::rethrow_exception(failure);
  } catch (const FileError& error) {
    const std::string_view text = error.what();
    const auto message = py::reinterpret_steal<py::object>(
        PyUnicode_DecodeUTF8(text.data(), static_cast<Py_ssize_t>(text.size()), "backslashreplace"));
    PyErr_SetObject(py::module_::import("echopath._core").attr("FileError").ptr(), message.ptr());
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
  py::register_exception_translator(&translate_file_error);  // before that of register_exception, as the later one
}

}  // namespace echopath::bindings
