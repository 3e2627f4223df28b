#include "call/shown.h"

#include <pybind11/numpy.h>

#include <cstddef>
#include <exception>

#include "call/faults.h"

namespace echopath::bindings {
namespace {

namespace py = pybind11;

constexpr size_t kLongest = 80;  // characters of a value that are shown

std::string type_name(py::handle value) { return Py_TYPE(value.ptr())->tp_name; }

bool has_short_text(py::handle value) {
  return value.is_none() || PyUnicode_Check(value.ptr()) || PyLong_Check(value.ptr()) || PyFloat_Check(value.ptr()) ||
         PyComplex_Check(value.ptr());
}

std::string cut(py::handle text) {
  if (py::len(text) <= kLongest) return py::cast<std::string>(text);
  return py::cast<std::string>(text[py::slice(0, kLongest, 1)]) + "...";
}

std::string array_text(const py::array& array) {
  if (array.ndim() == 0) return cut(py::str(array));
  std::string text = py::cast<std::string>(py::str(array.dtype())) + " [";
  for (py::ssize_t k = 0; k < array.ndim(); ++k) text += (k ? ", " : "") + std::to_string(array.shape(k));
  return text + "]";
}

std::string message(std::string_view argument, std::string_view rule, py::handle value) {
  return std::string(argument) + ": " + std::string(rule) + ", got " + shown(value);
}

}  // namespace

std::string shown(py::handle value) {
  try {
    if (py::isinstance<py::array>(value)) return array_text(py::reinterpret_borrow<py::array>(value));
    if (PyFloat_Check(value.ptr())) return cut(py::repr(py::float_(PyFloat_AS_DOUBLE(value.ptr()))));
    if (has_short_text(value)) return cut(py::repr(value));
    if (py::isinstance(value, py::module_::import("numpy").attr("generic"))) return cut(py::str(value));
  } catch (py::error_already_set& error) {  // such as that of an int of too many digits
    error.restore();
    forget_fault();
  } catch (const std::exception&) {  // text that UTF-8 cannot hold
  }
  return type_name(value);
}

std::string escaped(py::handle text) { return py::cast<std::string>(text.attr("encode")("utf-8", "backslashreplace")); }

void refuse_type(std::string_view argument, std::string_view rule, py::handle value) {
  throw py::type_error(message(argument, rule, value));
}

void refuse_value(std::string_view argument, std::string_view rule, py::handle value) {
  throw py::value_error(message(argument, rule, value));
}

}  // namespace echopath::bindings
