#pragma once
// Cubes [tx, rx, chirp, sample] from NumPy, checked against the radar they belong to.
#include <complex>
#include <stdexcept>
#include <vector>

#include "echopath/base/text/streamed.h"
#include "echopath/radar/radar.h"
#include "values/array.h"

namespace echopath::bindings {

inline Shape cube_shape(const Radar& radar) {
  return {std::ssize(radar.transmitters), std::ssize(radar.receivers), radar.waveform.num_chirps,
          radar.waveform.num_samples};
}

// Raises ValueError unless `value` has the shape of the radar's cube.
inline std::vector<std::complex<double>> as_cube(py::handle value, const Radar& radar) {
  const auto array = checked_array<std::complex<double>>(value, "cube", "[T, R, C, S]");
  const Shape shape = cube_shape(radar);
  for (py::ssize_t axis = 0; axis < 4; ++axis) {
    if (array.shape(axis) == shape[axis]) continue;
    throw std::invalid_argument(streamed("cube: must have shape [tx, rx, chirp, sample] = [", shape[0], ", ", shape[1], ", ",
                                         shape[2], ", ", shape[3], "], got [", array.shape(0), ", ", array.shape(1), ", ",
                                         array.shape(2), ", ", array.shape(3), "]"));
  }
  return vector_of(array);
}

}  // namespace echopath::bindings
