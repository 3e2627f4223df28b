#include "call/faults.h"

namespace echopath::bindings {

namespace py = pybind11;

void forget_fault() {
  if (!PyErr_Occurred()) return;
  const bool is_fault = PyErr_ExceptionMatches(PyExc_Exception) && !PyErr_ExceptionMatches(PyExc_MemoryError);
  if (!is_fault) throw py::error_already_set();
  PyErr_Clear();
}

bool has_attribute(py::handle value, const char* name) {
  const py::object found = py::reinterpret_steal<py::object>(PyObject_GetAttrString(value.ptr(), name));
  if (!found) forget_fault();
  return static_cast<bool>(found);
}

py::array array_or_none(py::handle value) {
  try {
    return py::array(py::reinterpret_borrow<py::object>(value));
  } catch (py::error_already_set& error) {
    error.restore();
    forget_fault();
    return py::reinterpret_steal<py::array>(py::handle());
  }
}

}  // namespace echopath::bindings
