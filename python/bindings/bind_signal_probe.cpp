// Spot checks of a signal, which synthesize and decompose fill.
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "array.h"
#include "echopath/sim/signal_probe.h"

namespace echopath::bindings {
namespace {

using Size = py::ssize_t;

// One value of each chirp, [N].
template <class T>
auto column(T ProbedChirp::* field) {
  return [field](const SignalProbe& self) {
    std::vector<T> values;
    for (const ProbedChirp& chirp : self.chirps) values.push_back(chirp.*field);
    return numpy_take(std::move(values), {static_cast<Size>(self.chirps.size())});
  };
}

// Those of its samples, [N, S].
template <class T>
auto rows(std::array<T, ProbedChirp::kSamples> ProbedChirp::* field) {
  return [field](const SignalProbe& self) {
    std::vector<T> values;
    for (const ProbedChirp& chirp : self.chirps) values.insert(values.end(), (chirp.*field).begin(), (chirp.*field).end());
    return numpy_take(std::move(values), {static_cast<Size>(self.chirps.size()), Size{ProbedChirp::kSamples}});
  };
}

}  // namespace

void bind_signal_probe(py::module_& m) {
  py::class_<SignalProbe>(m, "SignalProbe",
                          R"(Spot checks of a signal, which `synthesize` and `decompose` fill: SignalProbe(seed=1).

Two chirps of the frame (of each stretch, where it is traced anew), drawn by `seed`: eight samples of each as direct sums of
all echoes, and moving echoes, the strongest and random ones of all blocks of paths, evaluated exactly at the chirp.)")
      .def(py::init([](uint64_t seed) { return SignalProbe{seed, 0, {}}; }), py::kw_only(), py::arg("seed") = 1)
      .def_readonly("seed", &SignalProbe::seed, "of the chirps and samples that are drawn")
      .def_property_readonly("tx", column(&ProbedChirp::tx), "[N] index of the transmitter")
      .def_property_readonly("rx", column(&ProbedChirp::rx), "[N] index of the receiver")
      .def_property_readonly("chirp", column(&ProbedChirp::chirp), "[N] index of the chirp in the frame")
      .def_property_readonly("sample", rows(&ProbedChirp::sample), "[N, 8] indices of samples")
      .def_property_readonly("value", rows(&ProbedChirp::value), "[N, 8] in sqrt(W), what the samples should be")
      .def_property_readonly("amplitude_sum", column(&ProbedChirp::amplitude_sum),
                             "[N] in sqrt(W), sum of |amplitude| of all echoes in the chirp")
      .def_property_readonly("num_echoes", column(&ProbedChirp::num_echoes), "[N] moving echoes that were evaluated exactly")
      .def_property_readonly("phase_error", column(&ProbedChirp::phase_error),
                             "[N] in rad at the start frequency, rms over these echoes, weighted by power")
      .def_property_readonly("largest_phase_error", column(&ProbedChirp::largest_phase_error), "[N] in rad")
      .def_property_readonly("amplitude_error", column(&ProbedChirp::amplitude_error),
                             "[N] rms of the differences of amplitudes in sqrt(W) over their rms")
      .def("__repr__", [](const SignalProbe& self) {
        return "SignalProbe(" + std::to_string(self.chirps.size()) + " chirps)";
      });
}

}  // namespace echopath::bindings
