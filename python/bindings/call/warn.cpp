#include "call/warn.h"

#include <pybind11/pybind11.h>

namespace echopath::bindings {
namespace {

namespace py = pybind11;

bool is_in_package(const py::object& frame) {
  const py::object module = py::dict(frame.attr("f_globals")).attr("get")("__name__", "");
  const std::string name = py::cast<std::string>(py::str(module));
  return name == "echopath" || name.starts_with("echopath.");
}

}  // namespace

void warn_caller(const std::string& text) {
  int level = 1;  // the innermost function of Python
  py::object frame = py::reinterpret_borrow<py::object>(reinterpret_cast<PyObject*>(PyEval_GetFrame()));
  for (; frame && !frame.is_none() && is_in_package(frame); ++level) frame = frame.attr("f_back");
  if (PyErr_WarnEx(PyExc_RuntimeWarning, text.c_str(), level) != 0) throw py::error_already_set();
}

}  // namespace echopath::bindings
