#include <pybind11/complex.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "call/run_job.h"
#include "echopath/base/errors.h"
#include "echopath/signal/noise.h"
#include "echopath/signal/synthesizer.h"
#include "radar/cube_array.h"
#include "values/array.h"
#include "values/choice.h"

namespace echopath::bindings {
namespace {

py::array noisy_cube(const py::object& cube, const Radar& radar, uint64_t seed, double start_time) {
  std::vector<std::complex<double>> values = as_cube(cube, radar);
  const uint64_t of_frame = noise_seed_of_frame(seed, start_time);
  run_job("add_noise", py::none(), [&](Job& job) { add_noise(values, radar, of_frame, &job); });
  return numpy_take(std::move(values), cube_shape(radar));
}

// One row: at rest. A row per chirp: moving, with rates from differences of rows.
TimeSampling sampling_of_rows(const ChirpSequence& waveform, py::ssize_t num_rows, int num_slots) {
  require(num_slots >= 1, "num_slots", "must be at least 1", num_slots);
  if (num_rows == 1) return static_sampling(waveform.num_chirps);
  require(num_rows == waveform.num_chirps, "delays", "must have one row, or one per chirp", num_rows);
  std::vector<double> times;
  for (int j = 0; j < waveform.num_chirps; ++j) times.push_back(j * num_slots * waveform.chirp_interval);
  return exact_sampling(times);
}

py::array synthesize_echoes(const ChirpSequence& waveform, const py::object& delays, const py::object& amplitudes,
                            const std::string& method, double tolerance, int num_slots) {
  const auto delay = checked_array<double>(delays, "delays", "[T, P]");
  const auto amplitude = checked_array<std::complex<double>>(amplitudes, "amplitudes", "[T, P]");
  require(delay.shape(0) == amplitude.shape(0) && delay.shape(1) == amplitude.shape(1), "amplitudes",
          "must have the shape of delays, rows", amplitude.shape(0));
  Echoes echoes;
  echoes.sampling = sampling_of_rows(waveform, delay.shape(0), num_slots);
  echoes.num_echoes = delay.shape(1);
  echoes.delay = vector_of(delay);
  echoes.amplitude = vector_of(amplitude);
  const SynthesisOptions options{tolerance, kMethod.value_of(method)};
  auto samples = run_job("synthesize", py::none(), [&](Job& job) {
    Synthesizer synthesizer(waveform, 1, 1, echoes.num_echoes, options);
    synthesizer.add(0, echoes, &job);
    return synthesizer.cube(0, &job);
  });
  return numpy_take(std::move(samples), {waveform.num_chirps, waveform.num_samples});
}

}  // namespace

void bind_signal(py::module_& m) {
  m.def("add_noise", &noisy_cube, py::arg("cube"), py::arg("radar"), py::kw_only(), py::arg("seed"), py::arg("start_time"),
        "What ep.add_noise calls.");
  m.def("noise_power", &noise_power, py::arg("radar"), "Noise power of one IF sample, W.");
  m.def("noise_power_in_cell", &noise_power_in_cell, py::arg("radar"),
        "Noise power of the range-Doppler cell that all samples of a frame make with even weights, W, against the received "
        "power of an echo there.");
  m.def("synthesize_echoes", &synthesize_echoes, py::arg("waveform"), py::arg("delays"), py::arg("amplitudes"),
        py::kw_only(), py::arg("method") = "auto", py::arg("tolerance") = 1e-7, py::arg("num_slots") = 1,
        R"(The IF signal of echoes given by their delays and amplitudes, for one channel.

delays: [1, P] (at rest) or [chirps, P] (at the middle of each chirp) in s, round trip
amplitudes: the same shape, complex in sqrt(W), without the phase of the delay
method: "auto", "direct" (the reference), "recurrence" or "nufft"
tolerance: rms error over the samples relative to the sum of |amplitudes|, 1e-13 to 0.1
num_slots: transmitters that take turns; rows are num_slots * chirp_interval apart
Returns [chirp, sample], complex128 in sqrt(W). Raises ValueError naming the argument.)");
}

}  // namespace echopath::bindings
