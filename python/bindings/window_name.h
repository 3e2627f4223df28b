#pragma once
#include <pybind11/pybind11.h>

#include <string>

#include "echopath/spectrum/window.h"

namespace echopath::bindings {

namespace py = pybind11;

// A window by its name in Python: "hann", or ("chebyshev", 80).
inline Window as_window(const py::object& value) {
  if (py::isinstance<py::str>(value)) return Window::named(value.cast<std::string>());
  const bool pair = (py::isinstance<py::tuple>(value) || py::isinstance<py::list>(value)) && py::len(value) == 2;
  if (!pair) {
    throw py::type_error("window: must be a name or (name, sidelobe level in dB), got " +
                         py::str(value).cast<std::string>());
  }
  const py::sequence parts = value;
  return Window::named(parts[0].cast<std::string>(), parts[1].cast<double>());
}

// The same back.
inline py::object window_value(const Window& window) {
  if (window.kind != WindowKind::kChebyshev) return py::str(window.name());
  return py::make_tuple(window.name(), window.sidelobe_db);
}

}  // namespace echopath::bindings
