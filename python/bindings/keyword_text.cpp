#include "keyword_text.h"

namespace echopath::bindings {
namespace {

namespace py = pybind11;

using Function = PyObject* (*)(PyObject*, PyObject* const*, Py_ssize_t, PyObject*);
constexpr int kTakesVector = METH_FASTCALL | METH_KEYWORDS;  // as pybind11 makes its functions from version 3 on

Function of_pybind11 = nullptr;  // the one function behind all that it makes

PyObject* checked(PyObject* self, PyObject* const* arguments, Py_ssize_t count, PyObject* names) {
  for (Py_ssize_t i = 0; names && i < PyTuple_GET_SIZE(names); ++i) {
    PyObject* name = PyTuple_GET_ITEM(names, i);
    if (PyUnicode_AsUTF8AndSize(name, nullptr)) continue;
    PyErr_Clear();
    return PyErr_Format(PyExc_TypeError, "unknown keyword %A: must be text without lone surrogates", name);
  }
  return of_pybind11(self, arguments, count, names);
}

void check_function(PyObject* value) {
  if (PyInstanceMethod_Check(value)) value = PyInstanceMethod_GET_FUNCTION(value);
  if (!PyCFunction_Check(value)) return;
  PyMethodDef* made = reinterpret_cast<PyCFunctionObject*>(value)->m_ml;
  const auto function = reinterpret_cast<Function>(reinterpret_cast<void (*)()>(made->ml_meth));
  if (made->ml_flags != kTakesVector || function == checked) return;
  if (!of_pybind11) of_pybind11 = function;
  if (function == of_pybind11) made->ml_meth = reinterpret_cast<PyCFunction>(reinterpret_cast<void (*)()>(checked));
}

void check_all(const py::dict& values) {
  for (const auto& [name, value] : values) {
    if (py::isinstance<py::staticmethod>(value)) check_function(py::object(value.attr("__func__")).ptr());
    else check_function(value.ptr());
  }
}

}  // namespace

void refuse_keywords_without_text(const py::module_& m) {
  const py::dict members = m.attr("__dict__");
  check_all(members);
  for (const auto& [name, value] : members) {
    if (py::isinstance<py::type>(value)) check_all(py::dict(value.attr("__dict__")));
  }
}

}  // namespace echopath::bindings
