#include "echopath/replay/received_power.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "echopath/base/constants.h"
#include "echopath/base/phasor.h"
#include "echopath/replay/replay.h"

namespace echopath {
namespace {

constexpr int64_t kBlock = 1 << 18;  // paths evaluated at a time: bounds the memory
constexpr double kResolved = 2.0;    // standard errors

bool same_point(const Hit& a, const Hit& b) {
  return a.mesh_id == b.mesh_id && a.triangle_id == b.triangle_id && a.u == b.u && a.v == b.v;
}

std::vector<Hit> diffuse_hits(const Paths& paths, int64_t path) {
  std::vector<Hit> hits;
  const uint64_t diffuse = paths.diffuse[static_cast<size_t>(path)];
  for (int k = 0; k < paths.num_bounces[static_cast<size_t>(path)]; ++k) {
    if (diffuse >> k & 1) hits.push_back(paths.hits_of(path)[k]);
  }
  return hits;
}

// Paths that share a random phase run over the same diffuse hits, in this or the reversed order.
bool shares_phase(const std::vector<Hit>& a, const std::vector<Hit>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), same_point) ||
         std::equal(a.begin(), a.end(), b.rbegin(), b.rend(), same_point);
}

// Sums by batch of rays; the last entry is of the paths without.
class BatchSums {
 public:
  explicit BatchSums(const Paths& paths)
      : field(static_cast<size_t>(paths.frame.num_batches) + 1), power(field.size()), paths_(paths),
        turns_per_metre_(paths.radar.waveform.start_frequency / kSpeedOfLight) {}

  void add(int64_t path, double length, std::complex<double> amplitude) {
    const Phasor phase = phasor_of_product(turns_per_metre_, length);
    const std::complex<double> arriving = amplitude * std::complex<double>(phase.re, -phase.im);
    const auto p = static_cast<size_t>(path);
    const size_t batch = std::min<size_t>(paths_.batch[p], field.size() - 1);
    if (paths_.diffuse[p] == 0) {
      field[batch] += arriving;
      return;
    }
    // A ray records the paths over one hit one after the other, and selections keep their order.
    std::vector<Hit> hits = diffuse_hits(paths_, path);
    if (batch != open_batch_ || !shares_phase(hits, open_hits_)) {
      close();
      open_batch_ = batch;
      open_hits_ = std::move(hits);
    }
    open_field_ += arriving;
  }

  // Counts the field of the diffuse hit that was added to last.
  void close() {
    if (!open_hits_.empty()) power[open_batch_] += std::norm(open_field_);
    open_field_ = 0.0;
    open_hits_.clear();
  }

  std::vector<std::complex<double>> field;  // sqrt(W)
  std::vector<double> power;                // W

 private:
  const Paths& paths_;
  double turns_per_metre_;
  size_t open_batch_ = 0;
  std::vector<Hit> open_hits_;
  std::complex<double> open_field_ = 0.0;
};

const Antenna& antenna_at(const std::vector<Antenna>& antennas, int index, const char* name) {
  if (index >= 0 && index < static_cast<int>(antennas.size())) return antennas[static_cast<size_t>(index)];
  throw std::out_of_range(std::string(name) + ": must lie in 0 to " + std::to_string(antennas.size() - 1) + ", got " +
                          std::to_string(index));
}

Radar one_channel(const Radar& radar, Channel channel) {
  Radar one = radar;
  one.transmitters = {antenna_at(radar.transmitters, channel.tx, "tx")};
  one.receivers = {antenna_at(radar.receivers, channel.rx, "rx")};
  return one;
}

BatchSums sum_batches(const Paths& paths, Channel channel, Job* job) {
  const Radar radar = one_channel(paths.radar, channel);
  const Replayer replayer(paths, radar);
  BatchSums sums(paths);
  std::vector<int64_t> indices;
  std::vector<double> lengths;
  std::vector<std::complex<double>> amplitudes;
  if (job) job->start(paths.num_paths());
  for (int64_t begin = 0; begin < paths.num_paths(); begin += kBlock) {
    if (job) job->throw_if_cancelled();
    indices.resize(static_cast<size_t>(std::min(kBlock, paths.num_paths() - begin)));
    std::iota(indices.begin(), indices.end(), begin);
    replayer.evaluate(indices, paths.frame.trace_time, lengths, amplitudes);
    for (size_t i = 0; i < indices.size(); ++i) sums.add(indices[i], lengths[i], amplitudes[i]);
    if (job) job->advance(static_cast<int64_t>(indices.size()));
  }
  sums.close();
  return sums;
}

// Estimates of the whole by each batch of rays alone.
struct Estimates {
  std::vector<std::complex<double>> field;
  std::vector<double> power;
};

Estimates scaled_up(const BatchSums& sums) {
  Estimates estimates;
  const size_t num_batches = sums.field.size() - 1;
  const auto scale = static_cast<double>(num_batches);
  for (size_t b = 0; b < num_batches; ++b) {
    estimates.field.push_back(scale * sums.field[b] + sums.field.back());
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

}  // namespace

double ReceivedPower::error_db() const {
  if (!resolved) return std::numeric_limits<double>::infinity();
  return 10.0 * std::log10(1.0 + standard_error / power);
}

ReceivedPower received_power(const Paths& paths, Job* job, Channel channel) {
  const Estimates estimates = scaled_up(sum_batches(paths, channel, job));
  const auto count = static_cast<double>(estimates.field.size());
  std::complex<double> mean = 0.0;
  for (const std::complex<double>& field : estimates.field) mean += field / count;
  ReceivedPower out;
  out.num_batches = paths.frame.num_batches;
  out.coherent = std::norm(mean);
  out.diffuse = std::accumulate(estimates.power.begin(), estimates.power.end(), 0.0) / count;
  if (out.num_batches > 1) {
    add_errors(estimates, mean, out);
  } else {
    out.standard_error = out.coherent_error = out.diffuse_error = std::numeric_limits<double>::quiet_NaN();
  }
  out.power = out.coherent + out.diffuse;
  out.resolved = out.power > 0 && out.power >= kResolved * out.standard_error;
  return out;
}

}  // namespace echopath
