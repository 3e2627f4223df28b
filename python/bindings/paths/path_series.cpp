#include "paths/path_series.h"

#include <pybind11/complex.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <numeric>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "call/run_job.h"
#include "echopath/base/errors.h"
#include "echopath/power/path_power.h"
#include "echopath/record/hit_points.h"
#include "echopath/replay/replay.h"
#include "values/array.h"

namespace echopath::bindings {
namespace {

size_t antenna_index(int64_t index, const char* argument, size_t count) {
  if (index >= 0 && index < static_cast<int64_t>(count)) return static_cast<size_t>(index);
  throw std::out_of_range(std::string(argument) + ": must lie in 0 to " + std::to_string(count - 1) + ", got " +
                          std::to_string(index));
}

// The antenna of that index, or an isotropic one at a position [3] in m in the radar's frame.
Antenna antenna_of(const AntennaOrPosition::Value& value, const char* argument, const std::vector<Antenna>& antennas) {
  if (const auto* index = std::get_if<int64_t>(&value)) return antennas[antenna_index(*index, argument, antennas.size())];
  Antenna made;
  made.position = std::get<Vec3>(value);
  return made;
}

std::vector<int64_t> indices_of(const Paths& paths) {
  std::vector<int64_t> indices(paths.num_paths());
  std::iota(indices.begin(), indices.end(), 0);
  return indices;
}

// Names the tables [T, P] of which an evaluation writes those that are there.
struct Tables {
  double* lengths;                   // m
  std::complex<double>* amplitudes;  // sqrt(W)
};

// Evaluates some paths at some times: all together, or so that the bits of each time are the same whatever the others. Runs
// beside Python, so that Ctrl-C is answered.
void evaluate_one_channel(const Paths& paths, const std::vector<int64_t>& indices, const std::vector<double>& times,
                          const Tables& tables, const Antenna& transmitter, const Antenna& receiver, SpecularPoints specular,
                          bool by_themselves = false) {
  for (const double time : times) require(std::isfinite(time), "times", "must be finite", time);
  run_job("replay", py::none(), [&](Job& job) {
    Radar radar = paths.radar;
    radar.transmitters = {transmitter};
    radar.receivers = {receiver};
    ReplaySettings settings;
    settings.specular = specular;
    const Replayer replayer(paths, radar, settings);
    const auto moments = Replayer::Moment::in_rows(times, indices.size(), tables.lengths, tables.amplitudes);
    if (!by_themselves) return replayer.evaluate(indices, moments, &job);
    for (const Replayer::Moment& moment : moments) replayer.evaluate(indices, {&moment, 1}, &job);
  });
}

// [T, P]
std::vector<std::complex<double>> series_of_amplitudes(const Paths& paths, const std::vector<double>& times,
                                                       const Antenna& transmitter, const Antenna& receiver,
                                                       SpecularPoints specular = SpecularPoints::kMaterial) {
  const auto num_paths = static_cast<size_t>(paths.num_paths());
  std::vector<std::complex<double>> amplitudes(times.size() * num_paths);
  evaluate_one_channel(paths, indices_of(paths), times, {nullptr, amplitudes.data()}, transmitter, receiver, specular, true);
  return amplitudes;
}

Shape series_shape(const Paths& paths, const std::vector<double>& times) {
  return {std::ssize(times), static_cast<py::ssize_t>(paths.num_paths())};
}

}  // namespace

AntennaOrPosition::Value AntennaOrPosition::from(py::handle value, const char* argument) {
  const bool is_scalar = PyIndex_Check(value.ptr()) && !PySequence_Check(value.ptr());
  if (is_scalar) return Index::from(value, argument);
  if (!PySequence_Check(value.ptr())) {
    refuse_type(argument, "must be the index of an antenna or a position [3] in m in the radar's frame", value);
  }
  return as_vec3(value, argument);
}

py::array amplitudes_of(const Paths& paths, Arg<"times", VectorOf<double>> times, Arg<"tx", Index> tx, Arg<"rx", Index> rx,
                        Arg<"replay", OneOf<kSpecularPoints>> replay) {
  const Antenna transmitter = paths.radar.transmitters[antenna_index(*tx, "tx", paths.radar.transmitters.size())];
  const Antenna receiver = paths.radar.receivers[antenna_index(*rx, "rx", paths.radar.receivers.size())];
  return numpy_take(series_of_amplitudes(paths, *times, transmitter, receiver, *replay), series_shape(paths, *times));
}

py::array amplitude_of(const Paths& paths) {
  const Radar& radar = paths.radar;
  return numpy_take(series_of_amplitudes(paths, {paths.frame.trace_time}, radar.transmitters[0], radar.receivers[0]));
}

py::array path_power_of(const Paths& paths) {
  return numpy_take(run_job("replay", py::none(), [&](Job& job) { return path_power(paths, &job); }));
}

py::array lengths_of(const Paths& paths, Arg<"times", VectorOf<double>> times,
                     Arg<"transmitter", AntennaOrPosition> transmitter, Arg<"receiver", AntennaOrPosition> receiver,
                     Arg<"replay", OneOf<kSpecularPoints>> replay) {
  const Antenna from = antenna_of(*transmitter, "transmitter", paths.radar.transmitters);
  const Antenna to = antenna_of(*receiver, "receiver", paths.radar.receivers);
  const auto num_paths = static_cast<size_t>(paths.num_paths());
  std::vector<double> lengths((*times).size() * num_paths);
  evaluate_one_channel(paths, indices_of(paths), *times, {lengths.data(), nullptr}, from, to, *replay);
  return numpy_take(std::move(lengths), series_shape(paths, *times));
}

py::tuple placed_echoes_of(const Paths& paths, Arg<"times", VectorOf<double>> times,
                           Arg<"radars", List<Instance<Radar>>> radars, Arg<"replay", OneOf<kSpecularPoints>> replay) {
  std::vector<double> delays;
  std::vector<std::complex<double>> amplitudes;
  run_job("replay", py::none(), [&](Job&) {
    ReplaySettings settings;
    settings.specular = *replay;
    const Replayer replayer(paths, paths.radar, settings);
    std::vector<Echoes> channels = replayer.placed(indices_of(paths), *times, *radars);
    for (const Echoes& channel : channels) {
      delays.insert(delays.end(), channel.delay.begin(), channel.delay.end());
      amplitudes.insert(amplitudes.end(), channel.amplitude.begin(), channel.amplitude.end());
    }
    replayer.recycle(channels);
  });
  const Shape shape{std::ssize(paths.radar.transmitters), std::ssize(paths.radar.receivers), std::ssize((*times)),
                    static_cast<py::ssize_t>(paths.num_paths())};
  return py::make_tuple(numpy_take(std::move(delays), shape), numpy_take(std::move(amplitudes), shape));
}

py::tuple echoes_at_receivers(const Paths& paths, Arg<"time", Real> time, Arg<"tx", Index> tx,
                              Arg<"receivers", List<Index>> receivers) {
  Radar radar = paths.radar;
  radar.transmitters = {paths.radar.transmitters[antenna_index(*tx, "tx", paths.radar.transmitters.size())]};
  radar.receivers.clear();
  for (const int64_t rx : *receivers) {
    radar.receivers.push_back(paths.radar.receivers[antenna_index(rx, "receivers", paths.radar.receivers.size())]);
  }
  require(!radar.receivers.empty(), "receivers", "must be at least one", radar.receivers.size());
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  run_job("replay", py::none(),
          [&](Job& job) { Replayer(paths, radar).evaluate(indices_of(paths), *time, lengths, amplitudes, &job); });
  const Shape shape{std::ssize(radar.receivers), static_cast<py::ssize_t>(paths.num_paths())};
  return py::make_tuple(numpy_take(std::move(lengths), shape), numpy_take(std::move(amplitudes), shape));
}

py::tuple echoes_together(const Paths& paths, Arg<"times", VectorOf<double>> times, Arg<"tx", Index> tx, Arg<"rx", Index> rx,
                          Arg<"begin", Index> begin, Arg<"end", Index> end) {
  const Antenna transmitter = paths.radar.transmitters[antenna_index(*tx, "tx", paths.radar.transmitters.size())];
  const Antenna receiver = paths.radar.receivers[antenna_index(*rx, "rx", paths.radar.receivers.size())];
  require(*end >= 0 && *end <= paths.num_paths(), "end", "must lie in 0 to the number of paths", *end);
  require(*begin >= 0 && *begin <= *end, "begin", "must lie in 0 to end", *begin);
  std::vector<int64_t> indices(*end - *begin);
  std::iota(indices.begin(), indices.end(), *begin);
  std::vector<double> lengths((*times).size() * indices.size());
  std::vector<std::complex<double>> amplitudes(lengths.size());
  const Tables tables{lengths.data(), amplitudes.data()};
  evaluate_one_channel(paths, indices, *times, tables, transmitter, receiver, SpecularPoints::kMaterial);
  const Shape shape{std::ssize(*times), std::ssize(indices)};
  return py::make_tuple(numpy_take(std::move(lengths), shape), numpy_take(std::move(amplitudes), shape));
}

py::array points_of(const Paths& paths, Arg<"time", Real> time) {
  std::vector<double> coordinates = run_job("points", py::none(), [&](Job& job) { return hit_points(paths, *time, &job); });
  return numpy_take(std::move(coordinates), {static_cast<py::ssize_t>(paths.num_hits()), 3});
}

}  // namespace echopath::bindings
