#include "call/unmade.h"

#include <pybind11/detail/internals.h>

namespace echopath::bindings {
namespace {

namespace py = pybind11;

// Stands where pybind11 looks for memory of an object that has none, which is nowhere else.
void* refuse_memory(size_t) { throw py::type_error("the object is not made yet: its __init__ has not been called"); }

}  // namespace

void refuse_unmade(const py::module_& m) {
  for (const auto& [name, value] : py::dict(m.attr("__dict__"))) {
    if (!PyType_Check(value.ptr())) continue;
    py::detail::type_info* bound = py::detail::get_type_info(reinterpret_cast<PyTypeObject*>(value.ptr()));
    if (bound) bound->operator_new = &refuse_memory;
  }
}

}  // namespace echopath::bindings
