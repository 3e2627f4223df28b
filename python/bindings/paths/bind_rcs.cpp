#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

#include "call/run_job.h"
#include "call/warn.h"
#include "echopath/base/text/streamed.h"
#include "echopath/em/mie.h"
#include "echopath/sim/rcs.h"
#include "paths/error_target.h"
#include "values/array.h"
#include "values/choice.h"

namespace echopath::bindings {
namespace {

enum class NamedChannel { kVv, kHh, kVh, kHv };  // transmitted, received
constexpr auto kChannel = choice<NamedChannel>("polarization", "vv", "hh", "vh", "hv");
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
  const size_t num_pairs = is_one ? out.size() : in.size();
  for (size_t i = 0; i < num_pairs; ++i) {
    pairs.push_back({in[is_one ? 0 : i], out[is_one_out ? 0 : i]});
  }
  is_one = is_one && is_one_out;
  return pairs;
}

RcsChannel channel_of(const std::string& name) {
  const NamedChannel named = kChannel.value_of(name);
  RcsChannel channel;
  const auto vertical = RcsPolarization::Kind::kVertical, horizontal = RcsPolarization::Kind::kHorizontal;
  channel.transmit.kind = named == NamedChannel::kVv || named == NamedChannel::kVh ? vertical : horizontal;
  channel.receive.kind = named == NamedChannel::kVv || named == NamedChannel::kHv ? vertical : horizontal;
  return channel;
}

// What was asked for as `polarization`, and whether cross sections get an axis for it.
struct Channels {
  std::vector<RcsChannel> rows;
  PolarizationModel model = PolarizationModel::kJones;
  bool is_list = false;
};

// A name, [3] or [2, 3].
Channels one_channel(const py::handle& value) {
  if (py::isinstance<py::str>(value)) return {{channel_of(value.cast<std::string>())}};
  bool is_one = false;
  const std::vector<Vec3> vectors = directions_of(value, "polarization", is_one);
  require(is_one || vectors.size() == 2, "polarization", "must be [3] or, of transmitter and receiver, [2, 3], rows",
          vectors.size());
  RcsChannel channel;
  channel.transmit.vector = vectors.front();
  channel.receive.vector = vectors.back();
  return {{channel}, is_one ? PolarizationModel::kScalar : PolarizationModel::kJones};
}

// A list holds names and pairs of vectors.
bool is_list(const py::object& value) {
  if (!py::isinstance<py::list>(value) || py::len(value) == 0) return false;
  const py::object first = value[py::int_(0)];
  return py::isinstance<py::str>(first) || py::cast<py::ssize_t>(py::module_::import("numpy").attr("ndim")(first)) == 2;
}

Channels channels_of(const py::object& value) {
  if (!is_list(value)) return one_channel(value);
  Channels channels;
  channels.is_list = true;
  for (const py::handle& one : value) channels.rows.push_back(one_channel(one).rows.front());
  return channels;
}

// Of one quantity: a number, [N], [C] or [N, C] for N pairs of directions and C polarisations.
template <class Value>
py::object column(const std::vector<RadarCrossSection>& entries, const Shape& shape, Value value) {
  if (shape.empty()) return py::float_(value(entries.front()));
  std::vector<double> numbers;
  for (const RadarCrossSection& entry : entries) numbers.push_back(value(entry));
  return numpy_take(std::move(numbers), shape);
}

// The cross sections or their errors, in parts or whole.
py::object columns(const std::vector<RadarCrossSection>& entries, const Shape& shape, bool components, bool errors) {
  using Entry = RadarCrossSection;
  if (!components) {
    return column(entries, shape, [&](const Entry& entry) { return errors ? entry.standard_error : entry.total; });
  }
  py::dict parts;
  parts["coherent"] =
      column(entries, shape, [&](const Entry& entry) { return errors ? entry.coherent_error : entry.coherent; });
  parts["diffuse"] =
      column(entries, shape, [&](const Entry& entry) { return errors ? entry.diffuse_error : entry.diffuse; });
  return parts;
}

// The coherent echoes as fields in m, the diffuse ones as cross sections in m^2, and beside each what the waves of both
// antennas are: [E, 3] unit vectors toward them and of their polarisations, E entries with the channels of a pair together.
py::dict fields_of(const std::vector<RadarCrossSection>& entries, const std::vector<RcsDirections>& pairs,
                   const std::vector<RcsChannel>& channels, const Shape& shape) {
  std::vector<std::complex<double>> fields;
  std::vector<double> diffuse, incidence, observation, transmitted, received;
  for (const RadarCrossSection& entry : entries) {
    fields.push_back(entry.field);
    diffuse.push_back(entry.diffuse);
  }
  const auto append = [](std::vector<double>& rows, const Vec3& row) { rows.insert(rows.end(), row.begin(), row.end()); };
  for (const RcsDirections& pair : pairs) {
    const Vec3 there = pair.incidence.normalized(), back = pair.observation.normalized();
    for (const RcsChannel& channel : channels) {
      append(incidence, there);
      append(observation, back);
      append(transmitted, channel.transmit.across(there));
      append(received, channel.receive.across(back));
    }
  }
  const Shape rows{std::ssize(entries), 3};
  py::dict parts;
  parts["field"] = numpy_take(std::move(fields), shape);
  parts["diffuse"] = numpy_take(std::move(diffuse), shape);
  parts["incidence"] = numpy_take(std::move(incidence), rows);
  parts["observation"] = numpy_take(std::move(observation), rows);
  parts["transmitted"] = numpy_take(std::move(transmitted), rows);
  parts["received"] = numpy_take(std::move(received), rows);
  return parts;
}

// Mesh IDs of the walls; a point of the mouth, its normal.
using CavityTuple = std::tuple<std::vector<uint32_t>, std::array<double, 3>, std::array<double, 3>>;

std::vector<RcsCavity> cavities_of(const std::vector<CavityTuple>& tuples) {
  std::vector<RcsCavity> cavities;
  for (const auto& [walls, point, normal] : tuples) {
    cavities.push_back({walls, {Vec3(point.data()), Vec3(normal.data())}});
  }
  return cavities;
}

// Returns the cross section in m^2 up to which one is nothing but rounding, as the cross-polarised one of a plate.
double largest_of_rounding(double frequency) {
  constexpr double kRounding = 1e-13;  // of that of a null
  return kRounding * largest_null(frequency);
}

// Where rays cancel each other, more of them would tell the same.
void tell_nulls(int64_t nulls, size_t num_entries, double null) {
  if (nulls == 0) return;
  warn_caller(
      streamed("rcs: ", nulls, " of ", num_entries, " cross sections are nulls, below wavelength^2 / 100 = ", null,
               " m^2 (95 %), less than physical optics leaves out at an edge a wavelength long: more rays were not added"));
}

void warn_of_missed_targets(const std::vector<RadarCrossSection>& entries, double target_error_db, double frequency) {
  const double null = largest_null(frequency), rounding = largest_of_rounding(frequency);
  const double known = std::pow(10.0, 0.1 * target_error_db);
  int64_t missed = 0, nulls = 0;
  double worst = 0.0;
  for (const RadarCrossSection& entry : entries) {
    if (entry.total == 0 || entry.high <= rounding) continue;  // rays that miss the target need no more rays
    if (entry.high <= null) {
      nulls += entry.high > known * entry.total;
    } else if (entry.error_db > target_error_db) {
      ++missed;
      worst = std::max(worst, entry.error_db);
    }
  }
  tell_nulls(nulls, entries.size(), null);
  if (missed == 0) return;
  const std::string count = std::to_string(missed) + " of " + std::to_string(entries.size());
  warn_of_missed_target("rcs: for " + count + " cross sections max_rays", worst, target_error_db);
}

// Returns whether a cross section is no more than what single precision leaves of the largest one of its direction, as the
// cross-polarised one of a dihedral is.
bool is_rounding(const std::vector<RadarCrossSection>& entries, size_t index, size_t num_channels) {
  constexpr double kRounding = 1e-14;  // of a power
  const auto first = entries.begin() + static_cast<std::ptrdiff_t>(index - index % num_channels);
  const auto largest = std::max_element(first, first + static_cast<std::ptrdiff_t>(num_channels),
                                        [](const auto& a, const auto& b) { return a.total < b.total; });
  return entries[index].high <= kRounding * largest->total;
}

// Whether the rays do not know a cross section to 3 dB. A null between lobes, far below what is seen next to it, is no
// matter.
bool is_unknown(const std::vector<RadarCrossSection>& entries, size_t index, size_t num_channels) {
  constexpr double kKnown = 2.0, kNull = 0.01;
  double beside = 0.0;
  if (index >= num_channels) beside = entries[index - num_channels].high;
  if (index + num_channels < entries.size()) beside = std::max(beside, entries[index + num_channels].high);
  return entries[index].high > kKnown * entries[index].total && entries[index].high > kNull * beside;
}

void warn_of_few_rays(const std::vector<RadarCrossSection>& entries, size_t num_channels, int64_t num_rays,
                      double rounding) {
  int64_t unknown = 0;
  double most = 0.0;
  for (size_t i = 0; i < entries.size(); ++i) {
    if (entries[i].high <= rounding || is_rounding(entries, i, num_channels)) continue;
    if (!is_unknown(entries, i, num_channels)) continue;
    ++unknown;
    most = std::max(most, entries[i].high);
  }
  if (unknown == 0) return;
  warn_caller(streamed("rcs: ", unknown, " of ", entries.size(), " cross sections are not known to 3 dB from ", num_rays,
                       " rays, whose footprints on the target are too wide for its phases: up to ", most,
                       " m^2 (95 %). More num_rays, or target_error_db, find more"));
}

py::object rcs_of(Scene scene, double frequency, const py::object& incidence, const py::object& observation,
                  const py::object& polarization, std::optional<int64_t> num_rays, int max_bounces, uint64_t seed,
                  const std::string& footprint, const std::string& sampler, std::optional<int> batches,
                  std::optional<double> target_error_db, int64_t max_rays, bool edges, bool components, bool return_error,
                  const std::vector<CavityTuple>& cavities, const py::object& progress) {
  bool is_one = false;
  const std::vector<RcsDirections> pairs = pairs_of(incidence, observation, is_one);
  const Channels channels = channels_of(polarization);
  RcsSettings settings;
  TraceSettings& tracing = settings.tracing;
  const int num_batches = batches.value_or(return_error ? kErrorBatches : tracing.batches);
  const Effort effort = target_error_db
                            ? toward(ErrorTarget{*target_error_db, max_rays}, num_rays, num_batches)
                            : Effort{num_rays.value_or(tracing.num_rays * num_batches), num_batches, std::nullopt};
  require(!return_error || effort.batches > 1, "batches", "must be >= 2 for return_error", effort.batches);
  settings.frequency = frequency;
  settings.channels = channels.rows;
  settings.target = effort.target;
  settings.cavities = cavities_of(cavities);
  tracing.num_rays = effort.num_rays;
  tracing.max_bounces = max_bounces;
  tracing.seed = seed;
  tracing.polarization = channels.model;
  tracing.footprint = kFootprint.value_of(footprint);
  tracing.sampler = kSampler.value_of(sampler);
  tracing.batches = effort.batches;
  tracing.edges = edges;
  const auto entries = run_job("rcs", progress, [&](Job& job) { return rcs(scene, pairs, settings, &job); });
  if (target_error_db) {
    warn_of_missed_targets(entries, *target_error_db, frequency);
  } else if (tracing.footprint != Footprint::kNone) {  // without one nothing tells whether they are few
    warn_of_few_rays(entries, channels.rows.size(), effort.num_rays, largest_of_rounding(frequency));
  }
  Shape shape;
  if (!is_one) shape.push_back(std::ssize(pairs));
  if (channels.is_list) shape.push_back(std::ssize(channels.rows));
  if (!cavities.empty()) return fields_of(entries, pairs, channels.rows, shape);
  const py::object values = columns(entries, shape, components, false);
  return return_error ? py::make_tuple(values, columns(entries, shape, components, true)) : values;
}

double mie_rcs_of(double radius, double frequency, double bistatic_angle, const std::string& plane) {
  return mie_rcs(radius, frequency, bistatic_angle, kPlane.value_of(plane));
}

}  // namespace

void bind_rcs(py::module_& m) {
  m.def("rcs", &rcs_of, py::arg("scene"), py::kw_only(), py::arg("frequency"), py::arg("incidence"),
        py::arg("observation") = py::none(), py::arg("polarization") = py::make_tuple(0, 0, 1),
        py::arg("num_rays") = py::none(), py::arg("max_bounces") = 4, py::arg("seed") = 1,
        py::arg("footprint") = "second_order", py::arg("sampler") = "lattice", py::arg("batches") = py::none(),
        py::arg("target_error_db") = py::none(), py::arg("max_rays") = kMaxRays, py::arg("edges") = false,
        py::arg("components") = false, py::arg("return_error") = false, py::arg("cavities") = py::list(),
        py::arg("progress") = py::none(),
        "What ep.rcs calls. cavities: list of (mesh IDs of the walls, a point of the mouth, its normal); with any, returns "
        "{field: complex, m; diffuse: m^2} of what stays outside of them and, each [E, 3], unit vectors of all E waves: "
        "incidence, observation, transmitted, received.");
  m.def("mie_rcs", &mie_rcs_of, py::arg("radius"), py::arg("frequency"), py::arg("bistatic_angle") = 0.0,
        py::arg("plane") = "H", "What ep.mie_rcs calls.");
}

}  // namespace echopath::bindings
