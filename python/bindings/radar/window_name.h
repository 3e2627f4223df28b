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
  if (!window.has_level()) return py::str(window.name());
  return py::make_tuple(window.name(), window.level());
}

// The windows of a map: one for both axes, or a pair of them, (range, velocity).
inline MapWindows as_map_windows(const py::object& value) {
  const bool pair = (py::isinstance<py::tuple>(value) || py::isinstance<py::list>(value)) && py::len(value) == 2;
  if (!pair) return as_window(value);
  const py::sequence parts = value;
  if (py::isinstance<py::float_>(parts[1]) || py::isinstance<py::int_>(parts[1])) return as_window(value);
  return {as_window(parts[0]), as_window(parts[1])};
}

// The same back.
inline py::object map_windows_value(const MapWindows& windows) {
  if (windows.range == windows.velocity) return window_value(windows.range);
  return py::make_tuple(window_value(windows.range), window_value(windows.velocity));
}

}  // namespace echopath::bindings
