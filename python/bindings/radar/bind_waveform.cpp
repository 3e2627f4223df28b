#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <cmath>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "call/plausible.h"
#include "echopath/base/text/streamed.h"
#include "echopath/radar/radar.h"
#include "values/keywords.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

using WaveformKeywords = ListOfKeywords<
    ChirpSequence, Keyword<"start_frequency", &ChirpSequence::start_frequency, Real, "Hz, at the first sample">,
    Keyword<"bandwidth", &ChirpSequence::bandwidth, Real, "Hz, sampled, negative where chirps fall">,
    Keyword<"num_samples", &ChirpSequence::num_samples, Positive, "of a chirp">,
    Keyword<"sampling_rate", &ChirpSequence::sampling_rate, Real, "Hz">,
    Keyword<"num_chirps", &ChirpSequence::num_chirps, Positive, "per transmitter">,
    Keyword<"chirp_interval", &ChirpSequence::chirp_interval, Real, "s, between neighbouring slots">,
    Keyword<"real", &ChirpSequence::real, Flag, "whether samples are real">,
    Keyword<"extra_idle", &ChirpSequence::extra_idle, VectorOf<double>, "s, after each slot, repeated">,
    Keyword<"frequency_steps", &ChirpSequence::frequency_steps, VectorOf<double>, "Hz, of each slot, repeated">,
    Keyword<"bandwidth_steps", &ChirpSequence::bandwidth_steps, VectorOf<double>, "Hz, of each slot, repeated">>;
static_assert(WaveformKeywords::is_whole(), "each member of ChirpSequence needs its line");

double velocity_resolution(const ChirpSequence& self, Arg<"num_slots", Positive> num_slots) {
  return self.velocity_resolution(*num_slots);
}

double slot_start(const ChirpSequence& self, Arg<"slot", Count> slot) { return self.slot_start(*slot); }

double max_velocity(const ChirpSequence& self, Arg<"num_slots", Positive> num_slots) {
  return self.max_velocity(*num_slots);
}

std::string text_of(const ChirpSequence& w) {
  return streamed(
      "ChirpSequence(", w.start_frequency * 1e-9, w.falls() ? " GHz - " : " GHz + ", std::abs(w.bandwidth) * 1e-9, " GHz, ",
      w.num_samples, (w.real ? " real" : " complex"), " samples at ", w.sampling_rate * 1e-6, " MHz, ",
      counted(w.num_chirps, "chirp"), " every ", w.chirp_interval * 1e6, " us",
      (w.extra_idle.empty() && w.frequency_steps.empty() && w.bandwidth_steps.empty() ? ")" : ", slots differ)"));
}

}  // namespace

void bind_waveform(py::module_& m) {
  py::class_<ChirpSequence> type(m, "ChirpSequence", R"(A frame of linear chirps, which rise or fall.

start_frequency: Hz, at the first sample
bandwidth: Hz, swept by the samples of a chirp; negative where chirps fall, from start_frequency down
num_samples: of a chirp; 1: a radar that tells no ranges apart, whose one cell, c / (2 |bandwidth|), is as far as it hears
sampling_rate: Hz
num_chirps: per transmitter
chirp_interval: s between neighbouring slots, at least num_samples / sampling_rate
real: real IF samples instead of complex ones
extra_idle: s, 0 or more, by which the slot after this one begins later: slot i takes entry i modulo their number (staggered
    pulse repetition); () for none
frequency_steps: Hz added to the start frequency of a slot, likewise (frequency hopping)
bandwidth_steps: Hz added to the bandwidth of a slot, likewise; all rise or all fall, and maps keep the axes of the waveform
    without steps
Raises TypeError or ValueError naming the argument, for a start_frequency below 1 MHz, too. Warns (RuntimeWarning) of a
bandwidth above start_frequency or below 5 kHz and of a chirp_interval above 1 s, which look like other units.)");
  define_members(type, WaveformKeywords{}, [](const ChirpSequence& made) {
    made.validate();
    require_plausible(made);
  });
  type.def_property_readonly("mean_interval", &ChirpSequence::mean_interval, "s, between neighbouring slots in the mean")
      .def_property_readonly("falls", &ChirpSequence::falls, "whether chirps fall, with a negative bandwidth")
      .def_property_readonly("slope", &ChirpSequence::slope, "Hz/s, negative where chirps fall")
      .def_property_readonly("chirp_duration", &ChirpSequence::chirp_duration, "s, sampled")
      .def_property_readonly("window_centre", &ChirpSequence::window_centre, "s from the first sample to the middle")
      .def_property_readonly("centre_frequency", &ChirpSequence::centre_frequency, "Hz")
      .def_property_readonly(
          "band",
          [](const ChirpSequence& self) {
            const FrequencyBand band = self.band();
            return std::pair(band.lowest, band.highest);
          },
          "(lowest, highest) Hz, of all chirps with their steps")
      .def_property_readonly("wavelength", &ChirpSequence::wavelength, "m, at the centre frequency")
      .def_property_readonly("range_resolution", &ChirpSequence::range_resolution, "m, c / (2 |bandwidth|)")
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
  define_value(type);
  define_replace(type);
}

}  // namespace echopath::bindings
