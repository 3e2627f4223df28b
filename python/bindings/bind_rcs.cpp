#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <string>

#include "array.h"
#include "choice.h"
#include "echopath/em/mie.h"
#include "echopath/sim/rcs.h"
#include "keywords.h"
#include "run_job.h"

namespace echopath::bindings {
namespace {

const std::vector<std::string> kKeywords = {"frequency",   "incidence", "observation", "polarization", "num_rays",
                                            "max_bounces", "seed",      "footprint",   "components",   "progress"};

constexpr auto kPlane = choice<ScatteringPlane>("plane", "E", "H");

// [3] or [N, 3] as rows.
std::vector<Vec3> directions_of(const py::handle& value, const char* argument, bool& is_one) {
  is_one = py::cast<py::ssize_t>(py::module_::import("numpy").attr("ndim")(value)) == 1;
  if (is_one) return {as_vec3(value, argument)};
  return as_points(value, argument);
}

std::vector<RcsDirections> pairs_of(const py::object& incidence, const py::object& observation, bool& is_one) {
  const std::vector<Vec3> in = directions_of(incidence, "incidence", is_one);
  if (observation.is_none()) {
    std::vector<RcsDirections> pairs;
    for (const Vec3& direction : in) pairs.push_back({direction, direction});
    return pairs;
  }
  bool is_one_out = false;
  const std::vector<Vec3> out = directions_of(observation, "observation", is_one_out);
  require(is_one || is_one_out || in.size() == out.size(), "observation", "must be one or as many as incidence, rows",
          out.size());
  std::vector<RcsDirections> pairs;
  for (size_t i = 0; i < std::max(in.size(), out.size()); ++i) {
    pairs.push_back({in[is_one ? 0 : i], out[is_one_out ? 0 : i]});
  }
  is_one = is_one && is_one_out;
  return pairs;
}

py::object rcs_of(const Scene& scene, double frequency, const py::object& incidence, const py::object& observation,
                  const py::object& polarization, int64_t num_rays, int max_bounces, uint64_t seed,
                  const std::string& footprint, bool components, const py::object& progress,
                  const py::kwargs& unknown) {
  refuse_unknown(unknown, "rcs", kKeywords);
  bool is_one = false;
  const std::vector<RcsDirections> pairs = pairs_of(incidence, observation, is_one);
  const RcsSettings settings{frequency,   as_vec3(polarization, "polarization"), num_rays,
                             max_bounces, seed, kFootprint.value_of(footprint)};
  const auto values = run_job("rcs", progress, [&](Job& job) { return rcs(scene, pairs, settings, &job); });
  const auto column = [&](auto&& value) -> py::object {
    if (is_one) return py::float_(value(values.front()));
    std::vector<double> numbers;
    for (const RadarCrossSection& entry : values) numbers.push_back(value(entry));
    return numpy_take(std::move(numbers));
  };
  if (!components) return column([](const RadarCrossSection& entry) { return entry.total(); });
  py::dict out;
  out["coherent"] = column([](const RadarCrossSection& entry) { return entry.coherent; });
  out["diffuse"] = column([](const RadarCrossSection& entry) { return entry.diffuse; });
  return out;
}

double mie_rcs_of(double radius, double frequency, double bistatic_angle, const std::string& plane) {
  return mie_rcs(radius, frequency, bistatic_angle, kPlane.value_of(plane));
}

}  // namespace

void bind_rcs(py::module_& m) {
  m.def("rcs", &rcs_of, py::arg("scene"), py::kw_only(), py::arg("frequency"), py::arg("incidence"),
        py::arg("observation") = py::none(), py::arg("polarization") = py::make_tuple(0, 0, 1),
        py::arg("num_rays") = 1 << 17, py::arg("max_bounces") = 4, py::arg("seed") = 1,
        py::arg("footprint") = "second_order", py::arg("components") = false, py::arg("progress") = py::none(),
        R"(Radar cross section of a scene in m^2, far field, at time 0.

Model: physical optics at every bounce. Coherent echoes add as fields; diffuse ones as powers, the mean over
realisations of the roughness, without coherent backscatter of multi-bounce paths. Both antennas are isotropic and
co-polarised.
frequency: Hz
incidence: toward the transmitter, seen from the target, [3] or [N, 3], any length
observation: toward the receiver, likewise; None: monostatic
polarization: [3], of both antennas; its part across the line of sight counts
num_rays: rays per direction; max_bounces: 1 to 64; seed; footprint: as in trace
components: True returns {"coherent": ..., "diffuse": ...}, which add up to the cross section
progress: callable(stage, fraction) or None
Returns a number, or [N] where directions are [N, 3]. Each direction costs a trace of its own. Raises ValueError for a
zero direction, one along the polarization, an empty scene, and mirrors, which have no cross section.)");
  m.def("mie_rcs", &mie_rcs_of, py::arg("radius"), py::arg("frequency"), py::arg("bistatic_angle") = 0.0,
        py::arg("plane") = "H",
        R"(Exact radar cross section of a perfectly conducting sphere in m^2, co-polarised, far field.

The Mie series, to 1e-9: the reference for curved metal. For ka = 2 pi radius frequency / c up to 1e6.
radius: m; frequency: Hz
bistatic_angle: rad in [0, pi] between the directions to transmitter and receiver, 0 is monostatic
plane: "E" or "H": the field that the plane of both directions holds (alike in the monostatic case)
Raises ValueError. Source: Mie 1908; Harrington, Time-Harmonic Electromagnetic Fields, 1961, section 6-9.)");
}

}  // namespace echopath::bindings
