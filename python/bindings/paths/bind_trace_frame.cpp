// What amplitudes and lengths of paths are relative to: strata, statistics and settings of a trace.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>

#include "call/argument.h"
#include "call/define.h"
#include "echopath/base/text/streamed.h"
#include "paths/record_keywords.h"
#include "values/array.h"
#include "values/travel.h"

namespace echopath::bindings {
namespace {

using Tally = Whole<0, std::numeric_limits<int64_t>::max()>;
using IndexOrNone = Whole<-1, std::numeric_limits<int>::max()>;  // -1: none

using StratumKeywords = ListOfKeywords<
    Stratum, RequiredKeyword<"axis", &Stratum::axis, Vector3, "[3] unit, world axes">,
    RequiredKeyword<"versine", &Stratum::versine, Real, "1 - cos of the half angle of a cone; 2 is the whole sphere">,
    Keyword<"across", &Stratum::across, Vector3, "[3] unit, world axes, along the great circle of a strip; zeros of a cone">,
    Keyword<"half_azimuth", &Stratum::half_azimuth, Real,
            "rad along the great circle on both sides of the axis; 0 of a cone">,
    Keyword<"low", &Stratum::low, Real, "least sine of the elevation over the great circle, toward axis x across">,
    Keyword<"high", &Stratum::high, Real, "largest sine of the elevation">,
    RequiredKeyword<"num_rays", &Stratum::num_rays, Tally, "launched in it">,
    RequiredKeyword<"ray_density", &Stratum::ray_density, Number, "rays per sr">,
    RequiredKeyword<"name", &Stratum::name, Text, "what it aims at">,
    Keyword<"object", &Stratum::object, IndexOrNone, "index of the scene's node that it aims at; -1: none">,
    Keyword<"num_mirrors", &Stratum::num_mirrors, Count, "over which it aims there">,
    Keyword<"focus_of", &Stratum::focus_of, IndexOrNone,
            "index of the stratum of which it takes over a part, with rays that lie closer; -1: none">>;
static_assert(StratumKeywords::is_whole(), "each member of Stratum needs its line");

using StatisticsKeywords = ListOfKeywords<
    TraceStatistics, Keyword<"num_rays", &TraceStatistics::num_rays, Tally, "launched">,
    Keyword<"num_queries", &TraceStatistics::num_queries, Tally, "closest-hit and shadow queries">,
    Keyword<"num_hits", &TraceStatistics::num_hits, Tally, "surface points found">,
    Keyword<"num_paths", &TraceStatistics::num_paths, Tally, "recorded; selections have fewer">,
    Keyword<"num_near_antenna", &TraceStatistics::num_near_antenna, Tally, "dropped: within 1 mm of an antenna">,
    Keyword<"num_grazing", &TraceStatistics::num_grazing, Tally, "dropped: cosine of incidence below 1e-3">,
    Keyword<"num_small_mirrors", &TraceStatistics::num_small_mirrors, Tally,
            "rays without a field ended behind an unflagged mirror of less than half its Fresnel zone">,
    Keyword<"num_false_hits", &TraceStatistics::num_false_hits, Tally, "not confirmed in double precision">,
    Keyword<"num_unaimed", &TraceStatistics::num_unaimed, Tally,
            "objects and images without a stratum, because there are too many of them">,
    Keyword<"num_unfollowed_frusta", &TraceStatistics::num_unfollowed_frusta, Tally,
            "sequences of mirrors whose further mirrors were not looked for, for want of memory">,
    Keyword<"num_unsplit_rays", &TraceStatistics::num_unsplit_rays, Tally,
            "rays that only went on at a sheet, because they had split at too many before">,
    Keyword<"num_stopped_passes", &TraceStatistics::num_stopped_passes, Tally,
            "legs that are taken to end at a sheet, behind 64 others">,
    Keyword<"num_faint_paths", &TraceStatistics::num_faint_paths, Tally, "left out by lot, because others count for them">>;
static_assert(StatisticsKeywords::is_whole(), "each member of TraceStatistics needs its line");

// Binds what the record's settings have to do with a frame: its constructor, a property each, and how it travels.
template <class... Keywords>
void bind_settings(py::class_<TraceFrame>& bound, ListOfKeywords<RecordSettings, Keywords...> of_record) {
  const auto frame_of =
      [](Arg<"start_time", Real> start_time, Arg<"trace_time", Real> trace_time, Arg<"transmitter", Vector3> transmitter,
         Arg<"receiver", Vector3> receiver, Arg<"strata", List<Instance<Stratum>>> strata,
         Arg<"statistics", Instance<TraceStatistics>> statistics, Arg<"target_error_db", Number> target_error_db,
         Arg<"error_db", Number> error_db, Arg<"objects_time", Optional<Real>> objects_time,
         typename Keywords::Argument... settings) -> TraceFrame {
    return {decltype(of_record)::made_of(settings...),
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
  define_attributes(bound, of_record);
  def_travel(
      bound, attribute("start_time", &TraceFrame::start_time, "s, first sample of the frame"),
      attribute("trace_time", &TraceFrame::trace_time, "s, the time that the rays saw"),
      field("transmitter", &TraceFrame::transmitter), field("receiver", &TraceFrame::receiver),
      attribute("strata", &TraceFrame::strata, "list of Stratum"),
      attribute("statistics", &TraceFrame::statistics, "TraceStatistics"),
      attribute("target_error_db", &TraceFrame::target_error_db,
                "dB, error of the received power that was asked for; 0: none"),
      attribute("error_db", &TraceFrame::error_db,
                "dB, the one that was reached, above the target where max_rays did not do; 0: not looked at"),
      attribute(
          "objects_time", &TraceFrame::objects_time,
          "s, when objects are told from what surrounds the antenna: in the first frame of a sequence; None: trace_time"),
      Keywords::travelling()...);
}

}  // namespace

void bind_trace_frame(py::module_& m) {
  py::class_<Stratum> bound_stratum(
      m, "Stratum",
      "One launch stratum: directions in a cone, or in a strip along a great circle (half_azimuth > 0), "
      "rays evenly over them. Raises TypeError or ValueError naming the argument.");
  define_record(bound_stratum, StratumKeywords{});
  bound_stratum.def_property_readonly("solid_angle", &Stratum::solid_angle, "sr").def("__repr__", [](const Stratum& self) {
    return "Stratum('" + self.name + "', " + counted(self.num_rays, "ray") + ")";
  });

  py::class_<TraceStatistics> bound_statistics(m, "TraceStatistics",
                                               "What a trace did. Raises TypeError or ValueError naming the argument.");
  define_record(bound_statistics, StatisticsKeywords{});
  bound_statistics.def("__repr__", [](const TraceStatistics& self) {
    return streamed("TraceStatistics(", counted(self.num_rays, "ray"), ", ", counted(self.num_queries, "query", "queries"),
                    ", ", counted(self.num_hits, "hit"), ", ", counted(self.num_paths, "path"), ")");
  });

  py::class_<TraceFrame> bound_frame(
      m, "TraceFrame",
      "What amplitudes and lengths of paths are relative to. Raises TypeError or ValueError naming the argument.");
  bind_settings(bound_frame, RecordKeywords{});
  bound_frame.def_property_readonly("transmitter", array_of(&TraceFrame::transmitter), "[3] m, where rays started, world")
      .def_property_readonly("receiver", array_of(&TraceFrame::receiver), "[3] m, where hits were connected to, world")
      .def("__repr__", [](const TraceFrame& self) {
        return streamed("TraceFrame(", counted(self.statistics.num_rays, "ray"), ", ",
                        counted(self.strata.size(), "stratum", "strata"), ", seed ", self.seed, ", at ", self.trace_time,
                        " s)");
      });
}

}  // namespace echopath::bindings
