#include "echopath/power/received_power.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
#include <string>

#include "echopath/base/errors.h"

namespace echopath {
namespace {

constexpr double kStandsOut = 2.0;  // standard errors
// A lot that keeps nothing of a group has left out more than this, in faint powers, once in 40 times at most: it keeps a
// path with the probability of its share of the faint power at least, whence -ln 0.025, and a path and its reversal, which
// are kept together, arrive with four times the power of one.
constexpr double kNoneKept = 4.0 * 3.688879;

size_t antenna_at(const std::vector<Antenna>& antennas, int index, const char* name) {
  if (index >= 0 && index < static_cast<int>(antennas.size())) return static_cast<size_t>(index);
  throw std::out_of_range(std::string(name) + ": must lie in 0 to " + std::to_string(antennas.size() - 1) + ", got " +
                          std::to_string(index));
}

Radar radar_of(const Radar& radar, Channel channel) {
  return one_channel(radar, antenna_at(radar.transmitters, channel.tx, "tx"), antenna_at(radar.receivers, channel.rx, "rx"));
}

// Holds the estimates of the whole by each batch of rays alone.
struct Estimates {
  std::vector<std::complex<double>> field;
  std::vector<double> power;
};

Estimates scaled_up(const GroupSums& sums) {
  Estimates estimates;
  const std::vector<std::complex<double>>& field = sums.field;
  const size_t num_batches = field.size() - 1;
  const auto scale = static_cast<double>(num_batches);
  for (size_t b = 0; b < num_batches; ++b) {
    estimates.field.push_back(scale * field[b] + field.back());
    estimates.power.push_back(scale * sums.power[b] + sums.power.back());
  }
  return estimates;
}

double variance_of(const std::vector<std::complex<double>>& values, std::complex<double> mean) {
  double sum = 0.0;
  for (const std::complex<double>& value : values) sum += std::norm(value - mean);
  return sum / static_cast<double>(values.size() - 1);
}

void add_errors(const Estimates& estimates, std::complex<double> mean, ReceivedPower& out) {
  const size_t count = estimates.field.size();
  const double pairs = static_cast<double>(count) * static_cast<double>(count - 1);
  const double variance = variance_of(estimates.field, mean);
  out.coherent -= variance / static_cast<double>(count);
  const double size = std::abs(mean);
  const std::complex<double> along = size > 0 ? mean * (std::sqrt(std::max(out.coherent, 0.0)) / size) : 0.0;
  double coherent = 0.0, diffuse = 0.0, both = 0.0;
  for (size_t b = 0; b < count; ++b) {
    const double of_field = 2.0 * (std::conj(along) * (estimates.field[b] - mean)).real();
    const double of_power = estimates.power[b] - out.diffuse;
    coherent += of_field * of_field;
    diffuse += of_power * of_power;
    both += (of_field + of_power) * (of_field + of_power);
  }
  const double second_order = variance * variance;
  out.coherent_error = std::sqrt((coherent + second_order) / pairs);
  out.diffuse_error = std::sqrt(diffuse / pairs);
  out.standard_error = std::sqrt((both + second_order) / pairs);
}

ReceivedPower estimate(const GroupSums& sums) {
  const Estimates estimates = scaled_up(sums);
  const auto count = static_cast<double>(estimates.field.size());
  std::complex<double> mean = 0.0;
  for (const std::complex<double>& field : estimates.field) mean += field / count;
  ReceivedPower out;
  out.num_batches = static_cast<int>(estimates.field.size());
  out.coherent = std::norm(mean);
  out.diffuse = std::accumulate(estimates.power.begin(), estimates.power.end(), 0.0) / count;
  if (out.num_batches > 1) {
    add_errors(estimates, mean, out);
  } else {
    out.standard_error = out.coherent_error = out.diffuse_error = std::numeric_limits<double>::quiet_NaN();
  }
  out.power = out.coherent + out.diffuse;
  return out;
}

PowerEvidence evidence_of(const GroupSums& sums, const ReceivedPower& power, Footprint footprint) {
  PowerEvidence evidence = sums;
  evidence.coherent = power.coherent;
  evidence.diffuse = power.diffuse;
  evidence.num_batches = power.num_batches;
  evidence.standard_error = power.standard_error;
  if (footprint == Footprint::kNone && sums.largest_field > 0.0)
    evidence.coherent_at_most = sums.largest_field * sums.largest_field;
  return evidence;
}

ReceivedPower with_interval(const GroupSums& sums, const TraceFrame& frame) {
  ReceivedPower out = estimate(sums);
  const PowerEvidence evidence = evidence_of(sums, out, frame.footprint);
  static_cast<PowerInterval&>(out) = power_interval(evidence);
  for (const CoherentKind& kind : evidence.kinds) {
    out.field += kind.field[kAsLaunched];
    out.half_density_field += kind.field[kHalfDensity];
    out.unfiltered += kind.power[kUnfiltered];
    out.between_rays += power_between_rays(kind, out.num_batches);
  }
  out.num_coherent_paths = sums.num_coherent_paths;
  out.num_diffuse_hits = sums.num_diffuse_hits;
  if (out.diffuse > 0) out.strongest_share = sums.strongest_hit / out.diffuse;
  const bool has_paths = sums.num_coherent_paths + sums.num_diffuse_hits > 0;
  if (!has_paths && frame.statistics.num_faint_paths > 0) out.high = out.high_of_rays = kNoneKept * frame.faint_power;
  return out;
}

void check(const Sorting& sorting, const Paths& paths) {
  const std::span<const uint32_t> group = sorting.group_of_path;
  require(group.size() == static_cast<size_t>(paths.num_paths()), "group_of_path", "must have one group for each path",
          group.size());
  const auto last = std::ranges::max_element(group);
  require(last == group.end() || *last < sorting.num_groups, "group_of_path", "must lie below the number of groups",
          last == group.end() ? 0 : *last);
}

}  // namespace

bool ReceivedPower::is_within(double db) const {
  const double factor = std::pow(10.0, 0.1 * db);
  return power > 0 && high <= power * factor && low * factor >= power;
}

double ReceivedPower::interval_db() const {
  if (power <= 0 || low <= 0) return std::numeric_limits<double>::infinity();
  return 10.0 * std::log10(std::max(high / power, power / low));
}

double ReceivedPower::error_db() const {
  if (!(power > 0 && power >= kStandsOut * standard_error)) return std::numeric_limits<double>::infinity();
  return 10.0 * std::log10(1.0 + standard_error / power);
}

ReceivedPower received_power(const Paths& paths, Job* job, Channel channel) {
  const std::vector<uint32_t> together(paths.num_paths(), 0);
  return received_powers(paths, Sorting{together, 1}, job, channel).front();
}

std::vector<ReceivedPower> received_powers(const Paths& paths, const Sorting& sorting, Job* job, Channel channel) {
  return received_powers(paths, {&sorting, 1}, job, channel).front();
}

std::vector<std::vector<ReceivedPower>> received_powers(const Paths& paths, std::span<const Sorting> sortings, Job* job,
                                                        Channel channel, PowerAndLength* of_paths) {
  for (const Sorting& sorting : sortings) check(sorting, paths);
  std::vector<std::vector<ReceivedPower>> powers;
  for (const std::vector<GroupSums>& groups : sum_groups(paths, radar_of(paths.radar, channel), sortings, job, of_paths)) {
    std::ranges::transform(groups, std::back_inserter(powers.emplace_back()),
                           [&](const GroupSums& sums) { return with_interval(sums, paths.frame); });
  }
  return powers;
}

}  // namespace echopath
