#include <pybind11/complex.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "echopath/base/errors.h"
#include "echopath/base/geometry.h"
#include "echopath/base/text/streamed.h"
#include "echopath/radar/gaussian_beam.h"
#include "echopath/radar/radar.h"
#include "values/value.h"

namespace echopath::bindings {
namespace {

constexpr double kRoundingOfCosines = 3e-6;  // of products of two vectors of single precision
constexpr auto kPatternKind = choice<AntennaPattern::Kind>("kind", "isotropic", "cosine_power", "table");

AntennaPattern isotropic(Arg<"gain", Real> gain) { return AntennaPattern::isotropic(*gain); }

AntennaPattern cosine_power(Arg<"exponent", Real> exponent, Arg<"peak_gain", Optional<Real>> peak_gain) {
  require(!*peak_gain || **peak_gain > 0.0, "peak_gain", "must be positive, or None", peak_gain->value_or(0.0));
  return AntennaPattern::cosine_power(*exponent, peak_gain->value_or(0.0));
}

AntennaPattern gain_table(Arg<"azimuth", VectorOf<double>> azimuth, Arg<"elevation", VectorOf<double>> elevation,
                          Arg<"gain", Array<double, "[E, A]">> gain, Arg<"phase", Optional<Array<double, "[E, A]">>> phase,
                          Arg<"normalize", Flag> normalize) {
  const auto samples = [&](const py::array_t<double>& given, const char* argument) {
    const bool fits = given.shape(0) == std::ssize(*elevation) && given.shape(1) == std::ssize(*azimuth);
    require(fits, argument, "must have a row for each elevation and a column for each azimuth",
            std::to_string(given.shape(0)) + " x " + std::to_string(given.shape(1)));
    return vector_of(given);
  };
  const std::vector<double> gains = samples(*gain, "gain");
  const std::vector<double> phases = *phase ? samples(**phase, "phase") : std::vector<double>{};
  return AntennaPattern::of_table(GainTable(*azimuth, *elevation, gains, phases,
                                            *normalize ? GainTable::Scale::kMeanOfOne : GainTable::Scale::kAsGiven));
}

AntennaPattern gaussian_beam_of(Arg<"azimuth", Real> azimuth, Arg<"elevation", Real> elevation,
                                Arg<"peak_gain", Optional<Real>> peak_gain) {
  return AntennaPattern::of_table(gaussian_beam(*azimuth, *elevation, *peak_gain));
}

const char* kind_of(const AntennaPattern& pattern) { return kPatternKind.name_of(pattern.kind); }

// One of the arrays of a table, in a new NumPy array; None for other patterns and where there is no phase.
py::object axis_of(const AntennaPattern& pattern, const std::vector<double>& (GainTable::*getter)() const) {
  if (!pattern.table) return py::none();
  return to_numpy(((*pattern.table).*getter)());
}

py::object samples_of(const AntennaPattern& pattern, const std::vector<double>& (GainTable::*getter)() const) {
  if (!pattern.table || ((*pattern.table).*getter)().empty()) return py::none();
  const GainTable& table = *pattern.table;
  return numpy_take(std::vector<double>((table.*getter)()), {std::ssize(table.elevation()), std::ssize(table.azimuth())});
}

double gain_of(const AntennaPattern& pattern, Arg<"cos_boresight", Real> cos_boresight) {
  require(std::abs(*cos_boresight) <= 1.0 + kRoundingOfCosines, "cos_boresight", "must be a cosine, from -1 to 1",
          *cos_boresight);
  return pattern.gain(std::clamp(*cos_boresight, -1.0, 1.0));
}

py::array_t<std::complex<double>> field_of(const AntennaPattern& pattern, Arg<"directions", Points> directions) {
  std::vector<std::complex<double>> field;
  for (const Vec3& direction : *directions) {
    const double norm = direction.norm();
    require(std::abs(norm - 1.0) <= kUnitTolerance, "directions", "must have norm 1 within 1e-6", norm);
    const AntennaGain gain = pattern.toward(direction);
    field.push_back(std::polar(std::sqrt(gain.power), gain.phase));
  }
  return numpy_take(std::move(field));
}

py::dict keywords_of_pattern(const py::object& self) {
  const auto& pattern = self.cast<const AntennaPattern&>();
  if (pattern.kind == AntennaPattern::Kind::kIsotropic) return py::dict(py::arg("gain") = pattern.peak_gain);
  if (!pattern.table) {
    return py::dict(py::arg("exponent") = pattern.exponent, py::arg("peak_gain") = pattern.peak_gain);
  }
  return py::dict(py::arg("azimuth") = axis_of(pattern, &GainTable::azimuth),
                  py::arg("elevation") = axis_of(pattern, &GainTable::elevation),
                  py::arg("gain") = samples_of(pattern, &GainTable::gain),
                  py::arg("phase") = samples_of(pattern, &GainTable::phase));
}

// The function that makes the pattern with those keywords.
py::object maker_of_pattern(const py::dict& keywords) {
  const char* name = keywords.contains("azimuth")    ? "GainTable"
                     : keywords.contains("exponent") ? "CosinePower"
                                                     : "Isotropic";
  return py::module_::import("echopath._core").attr(name);
}

std::string text_of(const AntennaPattern& pattern) {
  if (pattern.kind == AntennaPattern::Kind::kIsotropic) return streamed("Isotropic(gain=", pattern.peak_gain, ")");
  if (!pattern.table) return streamed("CosinePower(exponent=", pattern.exponent, ", peak_gain=", pattern.peak_gain, ")");
  return streamed("GainTable(", pattern.table->azimuth().size(), " azimuths x ", pattern.table->elevation().size(),
                  " elevations, peak gain ", pattern.peak_gain, pattern.table->phase().empty() ? ")" : ", with phase)");
}

}  // namespace

void bind_patterns(py::module_& m) {
  py::class_<AntennaPattern> type(m, "AntennaPattern",
                                  "Power gain over direction; made by Isotropic, CosinePower, GaussianBeam or GainTable.");
  define_no_init(type, "ep.Isotropic, ep.CosinePower, ep.GaussianBeam, ep.GainTable and ep.load_antenna");
  define(type, "gain", &gain_of, py::arg("cos_boresight"),
         "Linear power gain where cos_boresight is the cosine of the angle from the boresight, from -1 to 1. "
         "A table raises ValueError.");
  define(type, "field", &field_of, py::arg("directions"),
         "sqrt(gain) e^{j phase} [N], complex, toward unit directions [N, 3] in the antenna's frame. Raises TypeError or "
         "ValueError naming the argument.");
  define_value(type, &keywords_of_pattern, &maker_of_pattern);
  define_replace(type, &keywords_of_pattern, &maker_of_pattern);
  type.def_property_readonly("kind", &kind_of, "\"isotropic\", \"cosine_power\" or \"table\"")
      .def_readonly("peak_gain", &AntennaPattern::peak_gain, "linear; of a table its largest sample")
      .def_readonly("exponent", &AntennaPattern::exponent, "of the cosine; 0 when isotropic")
      .def_property_readonly("efficiency", &AntennaPattern::efficiency,
                             "integral of the gain over the sphere / 4 pi; at most 1 for a power gain")
      .def_property_readonly(
          "azimuth", [](const AntennaPattern& self) { return axis_of(self, &GainTable::azimuth); },
          "[A] rad of a table, else None")
      .def_property_readonly(
          "elevation", [](const AntennaPattern& self) { return axis_of(self, &GainTable::elevation); },
          "[E] rad of a table, else None")
      .def_property_readonly(
          "table_gain", [](const AntennaPattern& self) { return samples_of(self, &GainTable::gain); },
          "[E, A] linear power gain of a table, else None")
      .def_property_readonly(
          "table_phase", [](const AntennaPattern& self) { return samples_of(self, &GainTable::phase); },
          "[E, A] rad of a table with phases, else None")
      .def("__repr__", [](const AntennaPattern& self) { return text_of(self); });
  define(m, "Isotropic", &isotropic, py::arg("gain") = 1.0,
         "The same linear power gain in every direction.\n\n"
         "gain: linear, at most 1 (1.02 for rounding): without a direction to prefer it is the efficiency of the antenna\n"
         "Raises TypeError or ValueError naming the argument.");
  define(m, "CosinePower", &cosine_power, py::arg("exponent"), py::arg("peak_gain") = py::none(),
         "Gain peak_gain cos^exponent of the angle from the boresight, nothing behind.\n\n"
         "exponent: 0 or more\npeak_gain: linear, None for that of a lossless antenna, 2 (exponent + 1), which is the most\n"
         "Raises ValueError naming the argument.");
  define(m, "GaussianBeam", &gaussian_beam_of, py::kw_only(), py::arg("azimuth"), py::arg("elevation"),
         py::arg("peak_gain") = py::none(),
         R"(A beam of which the widths at half the power are known: it falls as 2^{-(2 angle/width)^2} along both angles.

azimuth, elevation: rad, whole widths at half the power, from 1e-6 to pi
peak_gain: linear, None for that of a beam without losses, which is the most: 16 ln 2/(azimuth elevation) of narrow ones
There is no gain behind, nor beyond 2.6 widths, 81 dB below the peak: for side lobes take a table. Beams of more than 69 degrees
end at 90 degrees aside, 6.8 dB below the peak for 120 degrees.
Returns an AntennaPattern, a table. Raises TypeError or ValueError naming the argument.)");
  define(m, "GainTable", &gain_table, py::kw_only(), py::arg("azimuth"), py::arg("elevation"), py::arg("gain"),
         py::arg("phase") = py::none(), py::arg("normalize") = false,
         R"(Gain sampled over direction; there is none outside the table.

azimuth: [A] rad, ascending, about z from the boresight +x to the left, over at most a turn
elevation: [E] rad, ascending, from the xy-plane, in [-pi/2, pi/2]
gain: [E, A] linear power gain
phase: [E, A] rad of the far field (e^{+jwt}) relative to the antenna's position, or None: 0 everywhere. It turns the
    amplitudes of paths by e^{j phase}, in transmission and in reception.
normalize: True scales the gain to a mean of 1 over the sphere, that of an antenna without losses, as for tables whose level
    is unknown; False takes the gain as it is
The field sqrt(gain) e^{j phase} is interpolated by bicubics; phases of neighbours should differ by less than 1 rad.
Azimuths that cover the whole turn up to one step are closed to a ring.
Returns an AntennaPattern. Raises TypeError or ValueError naming the argument, also where the mean gain over the sphere is more
than 1.02 (0.09 dB): an antenna cannot radiate more power than it is fed.)");
}

}  // namespace echopath::bindings
