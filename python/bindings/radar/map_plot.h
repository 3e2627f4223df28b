#pragma once
#include <pybind11/pybind11.h>

#include "call/define.h"
#include "values/in_package.h"

namespace echopath::bindings {

// Gives a map its method `plot`, which a function of echopath.plots draws with that title above.
template <class Map>
void define_map_plot(py::class_<Map>& bound, const char* function, const char* title, const char* doc) {
  define(
      bound, "plot",
      [function](const py::object& self, const py::object& ax, const py::object& vmin, const py::object& vmax,
                 Arg<"title", Text> shown) {
        return in_package("plots", function)(self, py::arg("ax") = ax, py::arg("vmin") = vmin, py::arg("vmax") = vmax,
                                             py::arg("title") = *shown);
      },
      py::kw_only(), py::arg("ax") = py::none(), py::arg("vmin") = py::none(), py::arg("vmax") = py::none(),
      py::arg("title") = title, doc);
}

}  // namespace echopath::bindings
