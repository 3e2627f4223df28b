// What amplitudes and lengths of paths are relative to: strata, statistics and settings of a trace.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "paths/record_keywords.h"
#include "values/array.h"
#include "values/travel.h"

namespace echopath::bindings {
namespace {

using Tally = Whole<0, std::numeric_limits<int64_t>::max()>;
using IndexOrNone = Whole<-1, std::numeric_limits<int>::max()>;  // -1: none

Stratum stratum_of(Arg<"axis", Vector3> axis, Arg<"versine", Real> versine, Arg<"num_rays", Tally> num_rays,
                   Arg<"ray_density", Number> ray_density, Arg<"name", Text> name, Arg<"across", Vector3> across,
                   Arg<"half_azimuth", Real> half_azimuth, Arg<"low", Real> low, Arg<"high", Real> high,
                   Arg<"object", IndexOrNone> object, Arg<"num_mirrors", Count> num_mirrors,
                   Arg<"focus_of", IndexOrNone> focus_of) {
  Stratum made;
  made.axis = *axis;
  made.versine = *versine;
  made.across = *across;
  made.half_azimuth = *half_azimuth;
  made.low = *low;
  made.high = *high;
  made.object = *object;
  made.num_mirrors = *num_mirrors;
  made.focus_of = *focus_of;
  made.num_rays = *num_rays;
  made.ray_density = *ray_density;
  made.name = *name;
  return made;
}

TraceStatistics statistics_of(Arg<"num_rays", Tally> rays, Arg<"num_queries", Tally> queries, Arg<"num_hits", Tally> hits,
                              Arg<"num_paths", Tally> recorded, Arg<"num_near_antenna", Tally> near,
                              Arg<"num_grazing", Tally> grazing, Arg<"num_small_mirrors", Tally> small,
                              Arg<"num_false_hits", Tally> false_hits, Arg<"num_unaimed", Tally> unaimed,
                              Arg<"num_unfollowed_frusta", Tally> unfollowed, Arg<"num_unsplit_rays", Tally> unsplit,
                              Arg<"num_stopped_passes", Tally> stopped, Arg<"num_faint_paths", Tally> faint) {
  return {*rays,       *queries, *hits,       *recorded, *near,    *grazing, *small,
          *false_hits, *unaimed, *unfollowed, *unsplit,  *stopped, *faint};
}

// Binds what the record's settings have to do with a frame: its constructor, a property each, and how it travels.
template <class... Keywords>
void bind_settings(py::class_<TraceFrame>& bound, ListOfKeywords<Keywords...> of_record) {
  const auto frame_of =
      [](Arg<"start_time", Real> start_time, Arg<"trace_time", Real> trace_time, Arg<"transmitter", Vector3> transmitter,
         Arg<"receiver", Vector3> receiver, Arg<"strata", List<Instance<Stratum>>> strata,
         Arg<"statistics", Instance<TraceStatistics>> statistics, Arg<"target_error_db", Number> target_error_db,
         Arg<"error_db", Number> error_db, Arg<"objects_time", Optional<Real>> objects_time,
         typename Keywords::Argument... settings) -> TraceFrame {
    return {decltype(of_record)::settings_of(settings...),
            *start_time,
            *trace_time,
            *transmitter,
            *receiver,
            *strata,
            *statistics,
            *target_error_db,
            *error_db,
            *objects_time};
  };
  define_init(bound, +frame_of, py::kw_only(), py::arg("start_time"), py::arg("trace_time"), py::arg("transmitter"),
              py::arg("receiver"), py::arg("strata"), py::arg("statistics"), py::arg("target_error_db") = 0.0,
              py::arg("error_db") = 0.0, py::arg("objects_time") = py::none(), Keywords::argument()...);
  (bound.def_property_readonly(
       Keywords::name(), [](const TraceFrame& self) { return Keywords::value(self); }, Keywords::doc()),
   ...);
  def_travel(bound, field("start_time", &TraceFrame::start_time), field("trace_time", &TraceFrame::trace_time),
             field("transmitter", &TraceFrame::transmitter), field("receiver", &TraceFrame::receiver),
             field("strata", &TraceFrame::strata), field("statistics", &TraceFrame::statistics),
             field("target_error_db", &TraceFrame::target_error_db), field("error_db", &TraceFrame::error_db),
             field("objects_time", &TraceFrame::objects_time), Keywords::travelling()...);
}

}  // namespace

void bind_trace_frame(py::module_& m) {
  py::class_<Stratum> bound_stratum(
      m, "Stratum",
      "One launch stratum: directions in a cone, or in a strip along a great circle (half_azimuth > 0), "
      "rays evenly over them. Raises TypeError or ValueError naming the argument.");
  define_init(bound_stratum, &stratum_of, py::kw_only(), py::arg("axis"), py::arg("versine"), py::arg("num_rays"),
              py::arg("ray_density"), py::arg("name"), py::arg("across") = py::make_tuple(0.0, 0.0, 0.0),
              py::arg("half_azimuth") = 0.0, py::arg("low") = 0.0, py::arg("high") = 0.0, py::arg("object") = -1,
              py::arg("num_mirrors") = 0, py::arg("focus_of") = -1);
  bound_stratum
      .def_property_readonly(
          "axis", [](const Stratum& self) { return to_numpy(self.axis); }, "[3] unit, world axes")
      .def_readonly("versine", &Stratum::versine, "1 - cos of the half angle of a cone; 2 is the whole sphere")
      .def_property_readonly(
          "across", [](const Stratum& self) { return to_numpy(self.across); },
          "[3] unit, world axes, along the great circle of a strip; zeros of a cone")
      .def_readonly("half_azimuth", &Stratum::half_azimuth,
                    "rad along the great circle on both sides of the axis; 0 of a cone")
      .def_readonly("low", &Stratum::low, "least sine of the elevation over the great circle, toward axis x across")
      .def_readonly("high", &Stratum::high, "largest sine of the elevation")
      .def_property_readonly("solid_angle", &Stratum::solid_angle, "sr")
      .def_readonly("num_rays", &Stratum::num_rays, "launched in it")
      .def_readonly("name", &Stratum::name, "what it aims at")
      .def_readonly("num_mirrors", &Stratum::num_mirrors, "over which it aims there")
      .def_readonly("focus_of", &Stratum::focus_of,
                    "index of the stratum of which it takes over a part, with rays that lie closer; -1: none")
      .def_readonly("object", &Stratum::object, "index of the scene's node that it aims at; -1: none")
      .def_readonly("ray_density", &Stratum::ray_density, "rays per sr")
      .def("__repr__",
           [](const Stratum& self) { return "Stratum('" + self.name + "', " + std::to_string(self.num_rays) + " rays)"; });

  def_travel(bound_stratum, field("axis", &Stratum::axis), field("versine", &Stratum::versine),
             field("across", &Stratum::across), field("half_azimuth", &Stratum::half_azimuth), field("low", &Stratum::low),
             field("high", &Stratum::high), field("num_rays", &Stratum::num_rays),
             field("ray_density", &Stratum::ray_density), field("name", &Stratum::name), field("object", &Stratum::object),
             field("num_mirrors", &Stratum::num_mirrors), field("focus_of", &Stratum::focus_of));

  py::class_<TraceStatistics> bound_statistics(m, "TraceStatistics",
                                               "What a trace did. Raises TypeError or ValueError naming the argument.");
  define_init(bound_statistics, &statistics_of, py::kw_only(), py::arg("num_rays") = 0, py::arg("num_queries") = 0,
              py::arg("num_hits") = 0, py::arg("num_paths") = 0, py::arg("num_near_antenna") = 0, py::arg("num_grazing") = 0,
              py::arg("num_small_mirrors") = 0, py::arg("num_false_hits") = 0, py::arg("num_unaimed") = 0,
              py::arg("num_unfollowed_frusta") = 0, py::arg("num_unsplit_rays") = 0, py::arg("num_stopped_passes") = 0,
              py::arg("num_faint_paths") = 0);
  bound_statistics.def_readonly("num_rays", &TraceStatistics::num_rays, "launched")
      .def_readonly("num_queries", &TraceStatistics::num_queries, "closest-hit and shadow queries")
      .def_readonly("num_hits", &TraceStatistics::num_hits, "surface points found")
      .def_readonly("num_paths", &TraceStatistics::num_paths, "recorded; selections have fewer")
      .def_readonly("num_near_antenna", &TraceStatistics::num_near_antenna, "dropped: within 1 mm of an antenna")
      .def_readonly("num_grazing", &TraceStatistics::num_grazing, "dropped: cosine of incidence below 1e-3")
      .def_readonly("num_small_mirrors", &TraceStatistics::num_small_mirrors,
                    "rays without a field ended behind an unflagged mirror of less than half its Fresnel zone")
      .def_readonly("num_false_hits", &TraceStatistics::num_false_hits, "not confirmed in double precision")
      .def_readonly("num_unaimed", &TraceStatistics::num_unaimed,
                    "objects and images without a stratum, because there are too many of them")
      .def_readonly("num_unfollowed_frusta", &TraceStatistics::num_unfollowed_frusta,
                    "sequences of mirrors whose further mirrors were not looked for, for want of memory")
      .def_readonly("num_unsplit_rays", &TraceStatistics::num_unsplit_rays,
                    "rays that only went on at a sheet, because they had split at too many before")
      .def_readonly("num_stopped_passes", &TraceStatistics::num_stopped_passes,
                    "legs that are taken to end at a sheet, behind 64 others")
      .def_readonly("num_faint_paths", &TraceStatistics::num_faint_paths, "left out by lot, because others count for them");

  def_travel(bound_statistics, field("num_rays", &TraceStatistics::num_rays),
             field("num_queries", &TraceStatistics::num_queries), field("num_hits", &TraceStatistics::num_hits),
             field("num_paths", &TraceStatistics::num_paths), field("num_near_antenna", &TraceStatistics::num_near_antenna),
             field("num_grazing", &TraceStatistics::num_grazing),
             field("num_small_mirrors", &TraceStatistics::num_small_mirrors),
             field("num_false_hits", &TraceStatistics::num_false_hits), field("num_unaimed", &TraceStatistics::num_unaimed),
             field("num_unfollowed_frusta", &TraceStatistics::num_unfollowed_frusta),
             field("num_unsplit_rays", &TraceStatistics::num_unsplit_rays),
             field("num_stopped_passes", &TraceStatistics::num_stopped_passes),
             field("num_faint_paths", &TraceStatistics::num_faint_paths));

  py::class_<TraceFrame> bound_frame(
      m, "TraceFrame",
      "What amplitudes and lengths of paths are relative to. Raises TypeError or ValueError naming the argument.");
  bind_settings(bound_frame, RecordKeywords{});
  bound_frame.def_readonly("start_time", &TraceFrame::start_time, "s, first sample of the frame")
      .def_readonly("trace_time", &TraceFrame::trace_time, "s, the time that the rays saw")
      .def_property_readonly(
          "transmitter", [](const TraceFrame& self) { return to_numpy(self.transmitter); },
          "[3] m, where rays started, world")
      .def_property_readonly(
          "receiver", [](const TraceFrame& self) { return to_numpy(self.receiver); },
          "[3] m, where hits were connected to, world")
      .def_readonly("strata", &TraceFrame::strata, "list of Stratum")
      .def_readonly("target_error_db", &TraceFrame::target_error_db,
                    "dB, error of the received power that was asked for; 0: none")
      .def_readonly("error_db", &TraceFrame::error_db,
                    "dB, the one that was reached, above the target where max_rays did not do; 0: not looked at")
      .def_readonly(
          "objects_time", &TraceFrame::objects_time,
          "s, when objects are told from what surrounds the antenna: in the first frame of a sequence; None: trace_time")
      .def_readonly("statistics", &TraceFrame::statistics, "TraceStatistics");
}

}  // namespace echopath::bindings
