// What amplitudes and lengths of paths are relative to: strata, statistics and settings of a trace.
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <limits>
#include <string>

#include "call/argument.h"
#include "call/define.h"
#include "echopath/record/paths.h"
#include "values/array.h"
#include "values/choice.h"
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
                              Arg<"num_stopped_passes", Tally> stopped) {
  return {*rays,  *queries,    *hits,    *recorded,   *near,    *grazing,
          *small, *false_hits, *unaimed, *unfollowed, *unsplit, *stopped};
}

TraceFrame frame_of(Arg<"start_time", Real> start_time, Arg<"trace_time", Real> trace_time,
                    Arg<"transmitter", Vector3> transmitter, Arg<"receiver", Vector3> receiver,
                    Arg<"strata", List<Instance<Stratum>>> strata, Arg<"seed", Seed> seed,
                    Arg<"max_bounces", Count> max_bounces, Arg<"polarization", OneOf<kPolarization>> polarization,
                    Arg<"footprint", OneOf<kFootprint>> footprint, Arg<"statistics", Instance<TraceStatistics>> statistics,
                    Arg<"num_batches", Count> num_batches, Arg<"target_error_db", Number> target_error_db,
                    Arg<"error_db", Number> error_db, Arg<"sampler", OneOf<kSampler>> sampler,
                    Arg<"scatterers", OneOf<kScatterers>> scatterers, Arg<"edges", Flag> edges,
                    Arg<"attenuation", Real> attenuation) {
  const RecordSettings settings{*seed,        *max_bounces, *polarization, *footprint,  *sampler,
                                *num_batches, *scatterers,  *edges,        *attenuation};
  return {settings, *start_time, *trace_time, *transmitter, *receiver, *strata, *statistics, *target_error_db, *error_db};
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
              py::arg("num_unfollowed_frusta") = 0, py::arg("num_unsplit_rays") = 0, py::arg("num_stopped_passes") = 0);
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
                    "legs that are taken to end at a sheet, behind 64 others");

  def_travel(bound_statistics, field("num_rays", &TraceStatistics::num_rays),
             field("num_queries", &TraceStatistics::num_queries), field("num_hits", &TraceStatistics::num_hits),
             field("num_paths", &TraceStatistics::num_paths), field("num_near_antenna", &TraceStatistics::num_near_antenna),
             field("num_grazing", &TraceStatistics::num_grazing),
             field("num_small_mirrors", &TraceStatistics::num_small_mirrors),
             field("num_false_hits", &TraceStatistics::num_false_hits), field("num_unaimed", &TraceStatistics::num_unaimed),
             field("num_unfollowed_frusta", &TraceStatistics::num_unfollowed_frusta),
             field("num_unsplit_rays", &TraceStatistics::num_unsplit_rays),
             field("num_stopped_passes", &TraceStatistics::num_stopped_passes));

  py::class_<TraceFrame> bound_frame(
      m, "TraceFrame",
      "What amplitudes and lengths of paths are relative to. Raises TypeError or ValueError naming the argument.");
  define_init(bound_frame, &frame_of, py::kw_only(), py::arg("start_time"), py::arg("trace_time"), py::arg("transmitter"),
              py::arg("receiver"), py::arg("strata"), py::arg("seed"), py::arg("max_bounces"), py::arg("polarization"),
              py::arg("footprint"), py::arg("statistics"), py::arg("num_batches") = 1, py::arg("target_error_db") = 0.0,
              py::arg("error_db") = 0.0, py::arg("sampler") = "lattice", py::arg("scatterers") = "rays",
              py::arg("edges") = false, py::arg("attenuation") = 0.0);
  bound_frame.def_readonly("start_time", &TraceFrame::start_time, "s, first sample of the frame")
      .def_readonly("trace_time", &TraceFrame::trace_time, "s, the time that the rays saw")
      .def_property_readonly(
          "transmitter", [](const TraceFrame& self) { return to_numpy(self.transmitter); },
          "[3] m, where rays started, world")
      .def_property_readonly(
          "receiver", [](const TraceFrame& self) { return to_numpy(self.receiver); },
          "[3] m, where hits were connected to, world")
      .def_readonly("strata", &TraceFrame::strata, "list of Stratum")
      .def_readonly("seed", &TraceFrame::seed, "of directions and random phases")
      .def_readonly("max_bounces", &TraceFrame::max_bounces, "hits of a path at most")
      .def_property_readonly(
          "polarization", [](const TraceFrame& self) { return kPolarization.name_of(self.polarization); },
          "\"scalar\" or \"jones\"")
      .def_property_readonly(
          "footprint", [](const TraceFrame& self) { return kFootprint.name_of(self.footprint); },
          "\"second_order\", \"edges\", \"first_order\" or \"none\"")
      .def_readonly("num_batches", &TraceFrame::batches, "independent parts of the rays")
      .def_readonly("target_error_db", &TraceFrame::target_error_db,
                    "dB, error of the received power that was asked for; 0: none")
      .def_readonly("error_db", &TraceFrame::error_db,
                    "dB, the one that was reached, above the target where max_rays did not do; 0: not looked at")
      .def_property_readonly(
          "sampler", [](const TraceFrame& self) { return kSampler.name_of(self.sampler); },
          "\"lattice\", \"fibonacci\", \"r2\" or \"random\"")
      .def_property_readonly(
          "scatterers", [](const TraceFrame& self) { return kScatterers.name_of(self.scatterers); },
          "\"rays\" or \"surface\": what the scatterers of rough surfaces are")
      .def_readonly("edges", &TraceFrame::edges, "whether echoes of sharp edges were looked for")
      .def_readonly("attenuation", &TraceFrame::attenuation, "Np/m of fields in the air, along every path")
      .def_readonly("statistics", &TraceFrame::statistics, "TraceStatistics");
  def_travel(bound_frame, field("start_time", &TraceFrame::start_time), field("trace_time", &TraceFrame::trace_time),
             field("transmitter", &TraceFrame::transmitter), field("receiver", &TraceFrame::receiver),
             field("strata", &TraceFrame::strata), field("seed", &TraceFrame::seed),
             field("max_bounces", &TraceFrame::max_bounces), field("statistics", &TraceFrame::statistics),
             field("num_batches", &TraceFrame::batches), field("target_error_db", &TraceFrame::target_error_db),
             field("error_db", &TraceFrame::error_db), field("polarization", &TraceFrame::polarization, kPolarization),
             field("footprint", &TraceFrame::footprint, kFootprint), field("sampler", &TraceFrame::sampler, kSampler),
             field("scatterers", &TraceFrame::scatterers, kScatterers), field("edges", &TraceFrame::edges),
             field("attenuation", &TraceFrame::attenuation));
}

}  // namespace echopath::bindings
