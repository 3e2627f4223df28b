// Spot checks of a signal, which synthesize and decompose fill.
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "call/argument.h"
#include "call/define.h"
#include "echopath/sim/stream/signal_probe.h"
#include "values/array.h"
#include "values/travel.h"

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

// Of the first chirp; no rows before there is one.
const std::vector<RayShare>& first_shares(const SignalProbe& self) {
  static const std::vector<RayShare> none;
  return self.chirps.empty() ? none : self.chirps.front().shares;
}

py::array share_fields(const SignalProbe& self) {
  std::vector<std::complex<double>> values;
  for (const RayShare& share : first_shares(self)) values.insert(values.end(), share.field.begin(), share.field.end());
  const auto count = static_cast<Size>(first_shares(self).size());
  return numpy_take(std::move(values), {count, Size{RayShare::kSamples}});
}

py::array share_powers(const SignalProbe& self) {
  std::vector<double> values;
  for (const RayShare& share : first_shares(self)) values.push_back(share.power);
  return numpy_take(std::move(values));
}

// Probes travel with all that they hold, also with what they do not show.
void bind_probed_chirps(py::module_& m) {
  py::class_<RayShare> share(m, "_RayShare");
  def_travel(share, field("field", &RayShare::field), field("power", &RayShare::power));
  py::class_<ProbedChirp> chirp(m, "_ProbedChirp");
  def_travel(chirp, field("tx", &ProbedChirp::tx), field("rx", &ProbedChirp::rx), field("chirp", &ProbedChirp::chirp),
             field("sample", &ProbedChirp::sample), field("value", &ProbedChirp::value),
             field("amplitude_sum", &ProbedChirp::amplitude_sum), field("num_echoes", &ProbedChirp::num_echoes),
             field("phase_error", &ProbedChirp::phase_error),
             field("largest_phase_error", &ProbedChirp::largest_phase_error),
             field("amplitude_error", &ProbedChirp::amplitude_error), field("compared_power", &ProbedChirp::compared_power),
             field("strongest_power", &ProbedChirp::strongest_power), field("shares", &ProbedChirp::shares),
             field("power_sum", &ProbedChirp::power_sum), field("strongest", &ProbedChirp::strongest));
}

}  // namespace

void bind_signal_probe(py::module_& m) {
  bind_probed_chirps(m);
  py::class_<SignalProbe> type(m, "SignalProbe",
                               R"(Spot checks of a signal, which `synthesize` and `decompose` fill: SignalProbe(seed=1).

A chirp of the frame, or two of an array's (of each stretch, where it is traced anew), drawn by `seed`: eight samples of each
as direct sums of all echoes, and moving echoes, the strongest and random ones of all blocks of paths, evaluated exactly
there. Raises TypeError or ValueError naming the argument.)");
  define_init(type, [](Arg<"seed", Seed> seed) { return SignalProbe{*seed, 0, {}}; }, py::kw_only(), py::arg("seed") = 1);
  def_travel(type, attribute("seed", &SignalProbe::seed, "of the chirps and samples that are drawn"),
             field("first_chirp", &SignalProbe::first_chirp), field("chirps", &SignalProbe::chirps));
  type.def_property_readonly("tx", column(&ProbedChirp::tx), "[N] index of the transmitter")
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
      .def_property_readonly(
          "amplitude_error", column(&ProbedChirp::amplitude_error),
          "[N] rms of the differences of amplitudes in sqrt(W) over that of their largest in the frame, which "
          "count no less than a thousandth of the noise of a range-Doppler cell")
      .def_property_readonly("share_field", &share_fields,
                             "[2 batches + 1, 8] in sqrt(W): sums of the coherent paths at the samples of the first chirp, "
                             "of both halves of the rays of each batch in turn, then of the paths that rays did not find")
      .def_property_readonly("share_power", &share_powers,
                             "[2 batches + 1] in W: sums of |amplitude|^2 of the paths over rough surfaces, likewise")
      .def_property_readonly("power_sum", column(&ProbedChirp::power_sum), "[N] in W, sum of |amplitude|^2 of all paths")
      .def_property_readonly("strongest", column(&ProbedChirp::strongest),
                             "[N] in W, the largest |amplitude|^2 of a path that rays found")
      .def("__repr__",
           [](const SignalProbe& self) { return "SignalProbe(" + std::to_string(self.chirps.size()) + " chirps)"; });
}

}  // namespace echopath::bindings
