#pragma once
// Lengths, amplitudes and points of paths at any time, as arrays.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>

#include "echopath/trace/record/paths.h"

namespace echopath::bindings {

namespace py = pybind11;

// [T, P] complex, sqrt(W), at `times` [T] in s for two antennas by index; replay: SpecularPoints by name.
py::array amplitudes_of(const Paths& paths, const py::object& times, const py::object& tx, const py::object& rx,
                        const std::string& replay);
// [P] complex, sqrt(W), at the trace time for the first antennas.
py::array amplitude_of(const Paths& paths);
// [P] W, its square; needs no more memory than the result.
py::array path_power_of(const Paths& paths);
// [T, P] m; antennas by index, or positions [3] in m in the radar's frame.
py::array lengths_of(const Paths& paths, const py::object& times, const py::object& transmitter, const py::object& receiver,
                     const std::string& replay);
// [H, 3] m in the world at `time` in s.
py::array points_of(const Paths& paths, double time);

}  // namespace echopath::bindings
