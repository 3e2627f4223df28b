#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <memory>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "call/run_job.h"
#include "echopath/base/text/streamed.h"
#include "echopath/validity/renewal.h"
#include "echopath/validity/validity.h"
#include "values/array.h"
#include "values/choice.h"
#include "values/in_package.h"
#include "values/travel.h"

namespace echopath::bindings {
namespace {

using ValidityPtr = std::shared_ptr<Validity>;

ValidityPtr check_validity(const Paths& paths, const Radar* radar, const std::string& replay, const py::object& times,
                           bool arrays, const py::object& progress) {
  ValiditySettings settings;
  if (!times.is_none()) settings.times = as_vector<double>(times, "times");
  settings.arrays = arrays;
  settings.specular = kSpecularPoints.value_of(replay);
  return run_job("validity", progress, [&](Job& job) {
    return std::make_shared<Validity>(validity(paths, radar ? *radar : paths.radar, settings, &job));
  });
}

auto share(double ValidityShares::* field) {
  return [field](const Validity& self) { return self.shares.*field; };
}

std::string repr_of(const Validity& self) {
  const std::string found = self.warnings().empty() ? "one trace serves" : counted(self.warnings().size(), "warning");
  return streamed("Validity(", found, ", ", counted(self.num_paths, "path"), ", phase error ", self.rms_phase_error,
                  " rad rms)");
}

void bind_shares(py::module_& m) {
  py::class_<ValidityShares> bound(m, "ValidityShares",
                                   "What one trace does not serve, as shares of the power of some paths.");
  define_no_init(bound, "ep.validity");
  bound.def("__repr__", [](const ValidityShares& self) {
    return streamed("ValidityShares(slid=", self.slid, ", left=", self.left, ", blocked=", self.blocked,
                    ", turned=", self.turned, ", beside_edges=", self.beside_edges, ", new_surface=", self.new_surface, ")");
  });
  def_travel(
      bound, attribute("power", &ValidityShares::power, "W, what the shares are of"),
      attribute("slid", &ValidityShares::slid, "share: phase error of points of reflection above 0.3 rad"),
      attribute("left", &ValidityShares::left, "share: points of reflection that leave the surface around their hit"),
      attribute("blocked", &ValidityShares::blocked, "share: something comes in the way"),
      attribute("turned", &ValidityShares::turned,
                "share: a cosine of incidence or departure changes its sign or by more than a factor of two, "
                "or an image's coefficient by more than 0.3"),
      attribute("beside_edges", &ValidityShares::beside_edges,
                "share: what edges of unmarked planes leave of images over them changes by more than 0.3 of the field"),
      attribute("new_surface", &ValidityShares::new_surface,
                "share of single echoes of all that is seen: of what was hidden from the trace"));
}

void bind_objects(py::module_& m) {
  py::class_<ObjectValidity, ValidityShares> bound(
      m, "ObjectValidity", "What one trace does not serve of an object: of the paths that scattered on it last.");
  define_no_init(bound, "ep.validity");
  bound.def_property_readonly("ok", &ObjectValidity::ok, "it is served, or out of the dynamic range")
      .def_readonly("in_range", &ObjectValidity::is_in_range,
                    "at most 60 dB below the strongest object, and above the noise of a range-Doppler cell")
      .def("__repr__", [](const ObjectValidity& self) {
        return streamed("<ObjectValidity ", self.name, self.ok() ? ": ok" : ": not served",
                        ", new_surface=", self.new_surface, ", disappears=", self.disappears, ", error_db=", self.error_db,
                        ">");
      });
  def_travel(
      bound, attribute("name", &ObjectValidity::name, "of the object"), field("power", &ObjectValidity::power),
      field("slid", &ObjectValidity::slid), field("left", &ObjectValidity::left), field("blocked", &ObjectValidity::blocked),
      field("turned", &ObjectValidity::turned), field("beside_edges", &ObjectValidity::beside_edges),
      field("new_surface", &ObjectValidity::new_surface),
      attribute("disappears", &ObjectValidity::disappears,
                "share of its power that is lost, mean over the times of the check"),
      attribute("error_db", &ObjectValidity::error_db,
                "dB, of its power over the frame: the replay over what is there with new surface; 0: not known"),
      attribute("seen_power", &ObjectValidity::seen_power, "W, largest power with which the times of the check see it"),
      attribute("turn", &ObjectValidity::turn, "rad, how far it turns within the frame at most"),
      attribute("has_paths", &ObjectValidity::has_paths, "False: it has no path that carries power"),
      field("is_in_range", &ObjectValidity::is_in_range), field("is_too_fast", &ObjectValidity::is_too_fast),
      field("is_asked", &ObjectValidity::is_asked));
}

// A column of what was found of each path.
template <class T>
auto found(const char* name, std::vector<T> ValidityArrays::* column, const char* doc) {
  return array_attribute(name, [column](auto& self) -> auto& { return self.arrays.*column; }, doc);
}

void def_validity_travel(py::class_<Validity, ValidityPtr>& bound) {
  def_travel(
      bound, attribute("num_paths", &Validity::num_paths, "P, their number"),
      attribute("times", &Validity::times, "[T] s, of the check"), field("has_array", &Validity::has_array),
      field("turn_of_radar", &Validity::turn_of_radar), field("is_radar_too_fast", &Validity::is_radar_too_fast),
      attribute("shares", &Validity::shares, "ValidityShares of all paths"),
      attribute("rms_phase_error", &Validity::rms_phase_error, "rad, weighted by power"),
      attribute("largest_phase_error", &Validity::largest_phase_error, "rad, over paths, times and antennas"),
      attribute("motion_phase_error", &Validity::motion_phase_error, "rad, largest for the trace's own antennas"),
      attribute("stepped_phase_error", &Validity::stepped_phase_error,
                "rad, largest that a Newton step to the moved points of reflection leaves"),
      attribute("largest_cosine_change", &Validity::largest_cosine_change, "largest change of a cosine, linear"),
      attribute("largest_edge_change", &Validity::largest_edge_change,
                "largest change of what edges of unmarked planes leave of a field, over the larger of both"),
      field("edge_slide", &Validity::edge_slide), field("objects", &Validity::objects),
      field("cell_noise", &Validity::cell_noise), field("specular", &Validity::specular, kSpecularPoints),
      found("power", &ValidityArrays::power, "[P] W"),
      found("phase_error", &ValidityArrays::phase_error,
            "[P] rad, largest where no point of reflection has left its surface"),
      found("path_stepped_phase_error", &ValidityArrays::stepped_phase_error, "[P] rad, what a Newton step leaves"),
      found("left", &ValidityArrays::left, "[P] bit k: the point of reflection of hit k leaves the surface around it"),
      found("blocked", &ValidityArrays::blocked, "[P] bit k: something comes in the way of the leg that arrives at hit k"),
      found("receiver_blocked", &ValidityArrays::receiver_blocked,
            "[P] 1: something comes in the way of the leg to the receiver"),
      found("turned", &ValidityArrays::turned, "[P] 1: a cosine or a coefficient changes too much"),
      found("cosine_change", &ValidityArrays::cosine_change, "[P] largest of a cosine, linear"),
      found("edge_change", &ValidityArrays::edge_change,
            "[P] largest of what edges leave of an image's field, over the larger of both"));
}

void bind_report(py::module_& m) {
  py::class_<Validity, ValidityPtr> bound(
      m, "Validity",
      R"(Whether one trace serves a whole frame and a whole array; `str` tells it in words.

Shares are of the power that the replay carries; a warning is due above 1 %. The power of a path is the mean of |a|^2 over
the trace time and the times of the check; physical-optics paths are scaled to the power of their sum over the band. An object
within 60 dB of the strongest and above the noise of a range-Doppler cell is not ok where one of its shares exceeds 5 %, its power
over the frame is off by more than 0.5 dB, or it is seen but has no path.)");
  define_no_init(bound, "ep.validity");
  bound
      .def_property_readonly("phase_error_share", share(&ValidityShares::slid),
                             "share of the power whose points of reflection make an error above 0.3 rad")
      .def_property_readonly("occluded_share", share(&ValidityShares::blocked), "share of the power that something blocks")
      .def_property_readonly("left_share", share(&ValidityShares::left),
                             "share of the power whose points of reflection leave the surface around their hit")
      .def_property_readonly("turned_share", share(&ValidityShares::turned),
                             "share of the power of surfaces that turn to or away from the rays, or reflect otherwise")
      .def_property_readonly(
          "beside_edges_share", share(&ValidityShares::beside_edges),
          "share of the power of images of which edges of unmarked planes leave another share of the field")
      .def_property_readonly("new_surface_share", share(&ValidityShares::new_surface),
                             "share of single echoes of all that is seen: of what was hidden from the trace")
      .def_property_readonly(
          "replay", [](const Validity& self) { return kSpecularPoints.name_of(self.specular); },
          "\"material\" or \"fermat\": the replay that was certified")
      .def_property_readonly(
          "keyframes", &Validity::keyframes,
          "traces, each for its own part of the frame, that serve it: the error by motion is then below 0.3 rad, and "
          "echoes that come, go or change their strength have 16 parts or more")
      .def_property_readonly("warnings", &Validity::warnings, "list of sentences; empty where one trace serves")
      .def_property_readonly(
          "ok", [](const Validity& self) { return self.warnings().empty(); },
          "no warnings: every object in the dynamic range is served")
      .def_property_readonly(
          "objects",
          [](const Validity& self) {
            py::dict out;
            for (const ObjectValidity& object : self.objects) out[py::str(object.name)] = object;
            return out;
          },
          "{name: ObjectValidity} by the object that a path scattered on last (mirrors by images apart), by strength")
      .def("__str__", &Validity::text)
      .def("__repr__", &repr_of);
  define(bound, "_repr_html_", from_package("presentation.notebook", "validity_html"), "A table for notebooks.");
  def_validity_travel(bound);
}

std::shared_ptr<Renewal> renew_paths(const Paths& paths, const Radar* radar, double time, const py::object& progress) {
  return run_job("renew", progress, [&](Job& job) {
    return std::make_shared<Renewal>(renew(paths, radar ? *radar : paths.radar, time, &job));
  });
}

void bind_renewal(py::module_& m) {
  py::class_<Renewal, std::shared_ptr<Renewal>> bound(m, "Renewal", "A record brought up to another time; made by `renew`.");
  define_no_init(bound, "ep.renew");
  bound
      .def_property_readonly(
          "paths", [](const Renewal& self) { return std::make_shared<Paths>(self.paths); },
          "Paths that are still there, in their order.")
      .def("__repr__", [](const Renewal& self) {
        return streamed("Renewal(paths=", self.paths.num_paths(), ", num_blocked=", self.num_blocked,
                        ", num_lost=", self.num_lost, ", num_moved=", self.num_moved, ")");
      });
  def_travel(bound, field("paths", &Renewal::paths),
             attribute("num_blocked", &Renewal::num_blocked, "Paths left out because something stands in the way of a leg."),
             attribute("num_lost", &Renewal::num_lost, "Paths left out because a point of reflection has left its surface."),
             attribute("num_moved", &Renewal::num_moved, "Paths whose points of reflection were found anew."));
  m.def("renew", &renew_paths, py::arg("paths"), py::arg("radar") = py::none(), py::kw_only(), py::arg("time"),
        py::arg("progress") = py::none(), "What ep.renew calls.");
}

}  // namespace

void bind_validity(py::module_& m) {
  bind_renewal(m);
  bind_shares(m);
  bind_objects(m);
  bind_report(m);
  m.def("validity", &check_validity, py::arg("paths"), py::arg("radar") = py::none(), py::kw_only(),
        py::arg("replay") = "material", py::arg("times") = py::none(), py::arg("arrays") = false,
        py::arg("progress") = py::none(), "What ep.validity calls.");
}

}  // namespace echopath::bindings
