#pragma once
// Lengths, amplitudes and points of paths at any time, as arrays.
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <cstdint>
#include <limits>
#include <variant>

#include "call/argument.h"
#include "echopath/record/paths.h"
#include "values/choice.h"

namespace echopath::bindings {

namespace py = pybind11;

using Index = Whole<std::numeric_limits<int64_t>::min(), std::numeric_limits<int64_t>::max()>;

// The index of an antenna, or a position [3] in m in the radar's frame.
struct AntennaOrPosition {
  using Value = std::variant<int64_t, Vec3>;
  static constexpr auto type_name = py::detail::const_name("int | ArrayLike");
  static Value from(py::handle value, const char* argument);
};

// [T, P] complex, sqrt(W), at `times` [T] in s for two antennas by index; replay: SpecularPoints by name.
py::array amplitudes_of(const Paths& paths, Arg<"times", VectorOf<double>> times, Arg<"tx", Index> tx, Arg<"rx", Index> rx,
                        Arg<"replay", OneOf<kSpecularPoints>> replay);
// [P] complex, sqrt(W), at the trace time for the first antennas.
py::array amplitude_of(const Paths& paths);
// [P] W, its square; needs no more memory than the result.
py::array path_power_of(const Paths& paths);
// [T, P] m; antennas by index, or positions [3] in m in the radar's frame.
py::array lengths_of(const Paths& paths, Arg<"times", VectorOf<double>> times,
                     Arg<"transmitter", AntennaOrPosition> transmitter, Arg<"receiver", AntennaOrPosition> receiver,
                     Arg<"replay", OneOf<kSpecularPoints>> replay);
// (delays [tx, rx, T, P] in s, amplitudes [tx, rx, T, P] in sqrt(W)) for antennas that stand where radars [T] have them at
// `times` [T] in s.
py::tuple placed_echoes_of(const Paths& paths, Arg<"times", VectorOf<double>> times,
                           Arg<"radars", List<Instance<Radar>>> radars, Arg<"replay", OneOf<kSpecularPoints>> replay);
// (lengths [R, P] in m, amplitudes [R, P] in sqrt(W)) at `time` in s of one transmitter and some receivers, by index.
py::tuple echoes_at_receivers(const Paths& paths, Arg<"time", Real> time, Arg<"tx", Index> tx,
                              Arg<"receivers", List<Index>> receivers);
// (lengths [T, N] in m, amplitudes [T, N] in sqrt(W)) of paths [begin, end) at `times` [T] in s for two antennas by index.
py::tuple echoes_together(const Paths& paths, Arg<"times", VectorOf<double>> times, Arg<"tx", Index> tx, Arg<"rx", Index> rx,
                          Arg<"begin", Index> begin, Arg<"end", Index> end);
// [H, 3] m in the world at `time` in s.
py::array points_of(const Paths& paths, Arg<"time", Real> time);

}  // namespace echopath::bindings
