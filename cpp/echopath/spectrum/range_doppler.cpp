#include "echopath/spectrum/range_doppler.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "echopath/base/constants.h"
#include "echopath/base/errors.h"
#include "echopath/base/threads/parallel.h"
#include "echopath/fft/fft.h"

namespace echopath {
namespace {

constexpr int kColumnsPerTask = 8;  // neighbouring range bins share cache lines

using Taper = std::vector<double>;

void transform_row(const Fft& fft, const Taper& taper, const std::complex<double>* in, int64_t num_ranges, FftBuffer& buffer,
                   std::complex<double>* out) {
  const auto num_samples = std::ssize(taper);
  for (int64_t i = 0; i < num_samples; ++i) buffer[i] = taper[i] * in[i];
  std::fill(buffer.data() + num_samples, buffer.data() + buffer.size(), 0.0);
  fft.transform(buffer);
  std::copy_n(buffer.data(), num_ranges, out);
}

// Transforms [rows, samples] to [rows, range].
std::vector<std::complex<double>> range_transform(const std::complex<double>* cube, int64_t num_rows, const Taper& taper,
                                                  const Fft& fft, int64_t num_ranges, Job* job) {
  const int64_t num_samples = std::ssize(taper);
  std::vector<std::complex<double>> profiles(num_rows * num_ranges);
  parallel_for(num_rows, [&](int64_t row) {
    if (job) job->throw_if_cancelled();
    FftBuffer buffer(fft.size());
    transform_row(fft, taper, cube + row * num_samples, num_ranges, buffer, profiles.data() + row * num_ranges);
  });
  return profiles;
}

// Transforms a strip of neighbouring columns of one map, in[chirp * num_ranges + column] -> out[velocity * num_ranges +
// column], with zero velocity in the middle. It takes all columns of a row at once: rows are often a power of two apart and
// share their cache sets, so that a cache line would be gone before the next column asks for it.
void transform_strip(const Fft& fft, const Taper& taper, const std::complex<double>* in, int64_t num_ranges,
                     int64_t num_columns, std::complex<double>* out) {
  std::vector<FftBuffer> columns;
  for (int64_t k = 0; k < num_columns; ++k) columns.emplace_back(fft.size());
  for (size_t i = 0; i < taper.size(); ++i, in += num_ranges) {
    for (int64_t k = 0; k < num_columns; ++k) columns[k][i] = taper[i] * in[k];
  }
  for (FftBuffer& column : columns) fft.transform(column);
  // Row v holds frequency v - size / 2.
  const int64_t size = fft.size(), first = size - size / 2;
  for (int64_t v = 0; v < size; ++v, out += num_ranges) {
    const int64_t bin = first + v < size ? first + v : first + v - size;
    for (int64_t k = 0; k < num_columns; ++k) out[k] = columns[k][bin];
  }
}

// Transforms [maps, chirps, range] to [maps, velocity, range].
std::vector<std::complex<double>> doppler_transform(const std::vector<std::complex<double>>& profiles, int64_t num_maps,
                                                    const Taper& taper, int fft_size, int64_t num_ranges, Job* job) {
  const Fft fft(fft_size, FftDirection::kForward);
  const int64_t num_chirps = std::ssize(taper);
  const int64_t num_strips = num_chunks(num_ranges, kColumnsPerTask);
  std::vector<std::complex<double>> values(num_maps * fft_size * num_ranges);
  parallel_for(num_maps * num_strips, [&](int64_t task) {
    if (job) job->throw_if_cancelled();
    const int64_t map = task / num_strips, first = task % num_strips * kColumnsPerTask;
    const int64_t num_columns = std::min<int64_t>(kColumnsPerTask, num_ranges - first);
    transform_strip(fft, taper, profiles.data() + map * num_chirps * num_ranges + first, num_ranges, num_columns,
                    values.data() + map * fft_size * num_ranges + first);
  });
  return values;
}

}  // namespace

std::vector<double> range_axis(const ChirpSequence& waveform, int num_bins) {
  require(num_bins >= 1, "num_bins", "must be at least 1", num_bins);
  const double step = kSpeedOfLight * waveform.sampling_rate / (2.0 * std::abs(waveform.slope()) * num_bins);
  std::vector<double> range(waveform.real ? (num_bins + 1) / 2 : num_bins);
  for (size_t i = 0; i < range.size(); ++i) range[i] = static_cast<double>(i) * step;
  return range;
}

std::vector<double> velocity_axis(const ChirpSequence& waveform, int num_slots, int num_bins) {
  require(num_bins >= 1, "num_bins", "must be at least 1", num_bins);
  const double step = 2.0 * waveform.max_velocity(num_slots) / num_bins;
  const int middle = num_bins / 2;
  std::vector<double> velocity(num_bins);
  for (int i = 0; i < num_bins; ++i) velocity[i] = (i - middle) * step;
  return velocity;
}

namespace {

void check_map(const Radar& radar, int zero_pad) {
  radar.validate();
  require(zero_pad >= 1 && zero_pad <= kMaxZeroPad, "zero_pad", "must be in [1, 64]", zero_pad);
  const int64_t longest = int64_t{zero_pad} * std::max(radar.waveform.num_samples, radar.waveform.num_chirps);
  require(longest <= std::numeric_limits<int>::max(), "zero_pad", "times num_samples and num_chirps must be below 2^31",
          longest);
}

// Echoes of chirps that fall have negative beat frequencies, -n / N in cell n.
Fft range_fft_of(const ChirpSequence& waveform, int size) {
  return Fft(size, waveform.falls() ? FftDirection::kBackward : FftDirection::kForward);
}

// A real sample sqrt(2) Re s carries s / sqrt(2) at the frequencies of its beats.
Taper range_taper_of(const ChirpSequence& waveform, const Window& window) {
  return unit_taper(window, waveform.num_samples, waveform.real ? std::numbers::sqrt2 : 1.0);
}

}  // namespace

struct MapTransform::Plan {
  Taper range_taper, doppler_taper;
  Fft range_fft, doppler_fft;
  int64_t num_ranges;
  std::vector<std::complex<double>> at_rest;  // [V], of chirps that are all 1
};

MapTransform::MapTransform(const Radar& radar, const MapWindows& window, int zero_pad) {
  check_map(radar, zero_pad);
  const ChirpSequence& waveform = radar.waveform;
  const int range_size = waveform.num_samples * zero_pad;
  Plan plan{range_taper_of(waveform, window.range),
            unit_taper(window.velocity, waveform.num_chirps),
            range_fft_of(waveform, range_size),
            Fft(waveform.num_chirps * zero_pad, FftDirection::kForward),
            static_cast<int64_t>(range_axis(waveform, range_size).size()),
            {}};
  const std::vector<std::complex<double>> ones(waveform.num_chirps, 1.0);
  plan.at_rest.resize(plan.doppler_fft.size());
  transform_strip(plan.doppler_fft, plan.doppler_taper, ones.data(), 1, 1, plan.at_rest.data());
  plan_ = std::make_unique<const Plan>(std::move(plan));
}
MapTransform::~MapTransform() = default;

int64_t MapTransform::num_velocities() const { return plan_->doppler_fft.size(); }
int64_t MapTransform::num_ranges() const { return plan_->num_ranges; }

void MapTransform::transform(const std::complex<double>* samples, std::vector<std::complex<double>>& profiles,
                             std::complex<double>* values, std::span<const uint8_t> asked) const {
  const int64_t num_chirps = std::ssize(plan_->doppler_taper);
  const int64_t num_samples = std::ssize(plan_->range_taper), num_ranges = plan_->num_ranges;
  profiles.resize(num_chirps * num_ranges);
  FftBuffer buffer(plan_->range_fft.size());
  for (int64_t chirp = 0; chirp < num_chirps; ++chirp) {
    transform_row(plan_->range_fft, plan_->range_taper, samples + chirp * num_samples, num_ranges, buffer,
                  profiles.data() + chirp * num_ranges);
  }
  for (int64_t first = 0; first < num_ranges; first += kColumnsPerTask) {
    const int64_t count = std::min<int64_t>(kColumnsPerTask, num_ranges - first);
    const auto in_strip = asked.empty() ? asked : asked.subspan(static_cast<size_t>(first), static_cast<size_t>(count));
    if (!asked.empty() && std::ranges::none_of(in_strip, [](uint8_t one) { return one != 0; })) continue;
    transform_strip(plan_->doppler_fft, plan_->doppler_taper, profiles.data() + first, num_ranges, count, values + first);
  }
}

void MapTransform::add_still(const std::complex<double>* samples, std::vector<double>& power) const {
  std::vector<std::complex<double>> profile(plan_->num_ranges);
  FftBuffer buffer(plan_->range_fft.size());
  transform_row(plan_->range_fft, plan_->range_taper, samples, plan_->num_ranges, buffer, profile.data());
  for (size_t r = 0; r < profile.size(); ++r) power[r] += std::norm(profile[r]);
}

void MapTransform::spread_still(const std::vector<double>& power, double* cells) const {
  for (const std::complex<double>& response : plan_->at_rest) {
    const double share = std::norm(response);
    for (const double at_range : power) *cells++ += share * at_range;
  }
}

RangeDoppler range_doppler(const std::vector<std::complex<double>>& cube, const Radar& radar, const MapWindows& window,
                           int zero_pad, Job* job) {
  check_map(radar, zero_pad);
  const ChirpSequence& waveform = radar.waveform;
  const int64_t num_maps = static_cast<int64_t>(radar.transmitters.size() * radar.receivers.size());
  const int64_t num_rows = num_maps * waveform.num_chirps;
  require(std::ssize(cube) == num_rows * waveform.num_samples, "cube",
          "must have transmitters x receivers x chirps x samples values", cube.size());

  RangeDoppler map;
  map.window = window;
  map.zero_pad = zero_pad;
  map.num_transmitters = static_cast<int>(radar.transmitters.size());
  map.num_receivers = static_cast<int>(radar.receivers.size());
  const int range_size = waveform.num_samples * zero_pad, doppler_size = waveform.num_chirps * zero_pad;
  map.range = range_axis(waveform, range_size);
  map.velocity = velocity_axis(waveform, radar.num_slots(), doppler_size);

  const int64_t num_ranges = std::ssize(map.range);
  const Taper range_taper = range_taper_of(waveform, window.range);
  const Taper doppler_taper = unit_taper(window.velocity, waveform.num_chirps);
  const Fft range_fft = range_fft_of(waveform, range_size);
  const auto profiles = range_transform(cube.data(), num_rows, range_taper, range_fft, num_ranges, job);
  map.values = doppler_transform(profiles, num_maps, doppler_taper, doppler_size, num_ranges, job);
  return map;
}

std::vector<double> mean_power(const RangeDoppler& map, Job* job) {
  const auto num_ranges = std::ssize(map.range);
  const int64_t size = std::ssize(map.velocity) * num_ranges;
  const int num_channels = map.num_transmitters * map.num_receivers;
  std::vector<double> power(size);
  parallel_for(std::ssize(map.velocity), [&](int64_t v) {
    double* row = power.data() + v * num_ranges;
    for (int c = 0; c < num_channels; ++c) {
      const std::complex<double>* values = map.values.data() + c * size + v * num_ranges;
      for (int64_t r = 0; r < num_ranges; ++r) row[r] += std::norm(values[r]);
    }
    for (int64_t r = 0; r < num_ranges; ++r) row[r] /= num_channels;
  }, job);
  return power;
}

double cell_noise_power(double sample_power, const ChirpSequence& waveform, const MapWindows& window) {
  const int num_samples = waveform.num_samples, num_chirps = waveform.num_chirps;
  const double range_bandwidth = equivalent_noise_bandwidth(window_samples(window.range, num_samples));
  const double doppler_bandwidth = equivalent_noise_bandwidth(window_samples(window.velocity, num_chirps));
  return sample_power * range_bandwidth * doppler_bandwidth / (static_cast<double>(num_samples) * num_chirps);
}

}  // namespace echopath
