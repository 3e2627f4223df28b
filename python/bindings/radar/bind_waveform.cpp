#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <sstream>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "call/plausible.h"
#include "echopath/radar/radar.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

ChirpSequence chirp_sequence(Arg<"start_frequency", Real> start_frequency, Arg<"bandwidth", Real> bandwidth,
                             Arg<"num_samples", Positive> num_samples, Arg<"sampling_rate", Real> sampling_rate,
                             Arg<"num_chirps", Positive> num_chirps, Arg<"chirp_interval", Real> chirp_interval,
                             Arg<"real", Flag> real, Arg<"extra_idle", VectorOf<double>> extra_idle,
                             Arg<"frequency_steps", VectorOf<double>> frequency_steps,
                             Arg<"bandwidth_steps", VectorOf<double>> bandwidth_steps) {
  const ChirpSequence waveform{*start_frequency, *bandwidth, *num_samples, *sampling_rate,   *num_chirps,
                               *chirp_interval,  *real,      *extra_idle,  *frequency_steps, *bandwidth_steps};
  waveform.validate();
  require_plausible(waveform);
  return waveform;
}

double velocity_resolution(const ChirpSequence& self, Arg<"num_slots", Positive> num_slots) {
  return self.velocity_resolution(*num_slots);
}

double slot_start(const ChirpSequence& self, Arg<"slot", Count> slot) { return self.slot_start(*slot); }

double max_velocity(const ChirpSequence& self, Arg<"num_slots", Positive> num_slots) {
  return self.max_velocity(*num_slots);
}

py::tuple tuple_of(const std::vector<double>& values) { return py::tuple(py::cast(values)); }

py::dict keywords_of(const ChirpSequence& w) {
  return py::dict(py::arg("start_frequency") = w.start_frequency, py::arg("bandwidth") = w.bandwidth,
                  py::arg("num_samples") = w.num_samples, py::arg("sampling_rate") = w.sampling_rate,
                  py::arg("num_chirps") = w.num_chirps, py::arg("chirp_interval") = w.chirp_interval,
                  py::arg("real") = w.real, py::arg("extra_idle") = tuple_of(w.extra_idle),
                  py::arg("frequency_steps") = tuple_of(w.frequency_steps),
                  py::arg("bandwidth_steps") = tuple_of(w.bandwidth_steps));
}

std::string text_of(const ChirpSequence& w) {
  std::ostringstream text;
  text << "ChirpSequence(" << w.start_frequency * 1e-9 << " GHz + " << w.bandwidth * 1e-9 << " GHz, " << w.num_samples
       << (w.real ? " real" : " complex") << " samples at " << w.sampling_rate * 1e-6 << " MHz, " << w.num_chirps
       << " chirps every " << w.chirp_interval * 1e6 << " us"
       << (w.extra_idle.empty() && w.frequency_steps.empty() && w.bandwidth_steps.empty() ? ")" : ", slots differ)");
  return text.str();
}

}  // namespace

void bind_waveform(py::module_& m) {
  py::class_<ChirpSequence> type(m, "ChirpSequence", R"(A frame of linear up-chirps.

start_frequency: Hz, at the first sample
bandwidth: Hz, swept by the samples of a chirp
num_samples: of a chirp; 1: a radar that tells no ranges apart, whose one cell, c / (2 bandwidth), is as far as it hears
sampling_rate: Hz
num_chirps: per transmitter
chirp_interval: s between neighbouring slots, at least num_samples / sampling_rate
real: real IF samples instead of complex ones
extra_idle: s, 0 or more, by which the slot after this one begins later: slot i takes entry i modulo their number (staggered
    pulse repetition); () for none
frequency_steps: Hz added to the start frequency of a slot, likewise (frequency hopping)
bandwidth_steps: Hz added to the bandwidth of a slot, likewise; maps keep the axes of the waveform without steps
Raises TypeError or ValueError naming the argument, for a start_frequency below 1 MHz, too. Warns (RuntimeWarning) of a
bandwidth above start_frequency or below 1 kHz and of a chirp_interval above 1 s, which look like other units.)");
  define_init(type, &chirp_sequence, py::kw_only(), py::arg("start_frequency") = 77e9, py::arg("bandwidth") = 1e9,
              py::arg("num_samples") = 512, py::arg("sampling_rate") = 20e6, py::arg("num_chirps") = 128,
              py::arg("chirp_interval") = 60e-6, py::arg("real") = false, py::arg("extra_idle") = py::make_tuple(),
              py::arg("frequency_steps") = py::make_tuple(), py::arg("bandwidth_steps") = py::make_tuple())
      .def_readonly("start_frequency", &ChirpSequence::start_frequency, "Hz, at the first sample")
      .def_readonly("bandwidth", &ChirpSequence::bandwidth, "Hz, sampled")
      .def_readonly("num_samples", &ChirpSequence::num_samples, "of a chirp")
      .def_readonly("sampling_rate", &ChirpSequence::sampling_rate, "Hz")
      .def_readonly("num_chirps", &ChirpSequence::num_chirps, "per transmitter")
      .def_readonly("chirp_interval", &ChirpSequence::chirp_interval, "s, between neighbouring slots")
      .def_readonly("real", &ChirpSequence::real, "whether samples are real")
      .def_property_readonly(
          "extra_idle", [](const ChirpSequence& self) { return tuple_of(self.extra_idle); }, "s, after each slot, repeated")
      .def_property_readonly(
          "frequency_steps", [](const ChirpSequence& self) { return tuple_of(self.frequency_steps); },
          "Hz, of each slot, repeated")
      .def_property_readonly(
          "bandwidth_steps", [](const ChirpSequence& self) { return tuple_of(self.bandwidth_steps); },
          "Hz, of each slot, repeated")
      .def_property_readonly("mean_interval", &ChirpSequence::mean_interval, "s, between neighbouring slots in the mean")
      .def_property_readonly("slope", &ChirpSequence::slope, "Hz/s")
      .def_property_readonly("chirp_duration", &ChirpSequence::chirp_duration, "s, sampled")
      .def_property_readonly("window_centre", &ChirpSequence::window_centre, "s from the first sample to the middle")
      .def_property_readonly("centre_frequency", &ChirpSequence::centre_frequency, "Hz")
      .def_property_readonly("wavelength", &ChirpSequence::wavelength, "m, at the centre frequency")
      .def_property_readonly("range_resolution", &ChirpSequence::range_resolution, "m, c / (2 bandwidth)")
      .def_property_readonly("max_range", &ChirpSequence::max_range, "m, unambiguous")
      .def("__repr__", [](const ChirpSequence& self) { return text_of(self); });
  define(type, "slot_start", &slot_start, py::arg("slot"), R"(When a slot begins.

slot: index, 0 or more
Returns s after the start of the first slot. Raises TypeError or ValueError naming the argument.)");
  define(type, "velocity_resolution", &velocity_resolution, py::arg("num_slots") = 1,
         "m/s, when `num_slots` transmitters take turns. Raises TypeError or ValueError naming the argument.");
  define(
      type, "max_velocity", &max_velocity, py::arg("num_slots") = 1,
      "m/s, unambiguous up to +- this, when `num_slots` transmitters take turns. Raises TypeError or ValueError naming the "
      "argument.");
  define_value<ChirpSequence>(type, &keywords_of);
  define_replace<ChirpSequence>(type, &keywords_of);
}

}  // namespace echopath::bindings
