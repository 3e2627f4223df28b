#include "echopath/signal/synthesizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <string>

#include "echopath/base/errors.h"
#include "echopath/base/parallel.h"
#include "echopath/base/simd.h"
#include "echopath/signal/carrier.h"
#include "echopath/signal/method.h"
#include "echopath/signal/per_sample.h"

namespace echopath {
namespace {

constexpr int64_t kRecurrenceLimit = 75;  // echoes below which the recurrence beats the FFT of a NUFFT row
constexpr int kChirpsPerTask = 4;         // a block of echoes is read once per this many chirps

Method choose_method(Method asked, int64_t expected_echoes) {
  if (asked != Method::kAuto) return asked;
  return expected_echoes < kRecurrenceLimit ? Method::kRecurrence : Method::kNufft;
}

std::unique_ptr<const ToneMethod> make_tones(Method method, int num_samples, double tolerance) {
  if (method == Method::kDirect) return make_direct(num_samples);
  if (method == Method::kRecurrence) return make_recurrence(num_samples);
  return make_nufft(num_samples, tolerance);
}

ECHOPATH_SIMD bool all_finite(const double* values, int64_t count) {
  int64_t bad = 0;
  for (int64_t i = 0; i < count; ++i) bad |= !(std::abs(values[i]) <= std::numeric_limits<double>::max());
  return bad == 0;
}

void require_finite(const double* values, size_t count, const char* name) {
  if (all_finite(values, static_cast<int64_t>(count))) return;
  const double* bad = std::find_if(values, values + count, [](double value) { return !std::isfinite(value); });
  require(false, name, "must be finite", *bad);
}

void validate_sampling(const TimeSampling& sampling, int num_chirps) {
  const size_t chirps = static_cast<size_t>(num_chirps);
  require(sampling.num_nodes >= 1, "sampling.num_nodes", "must be at least 1", sampling.num_nodes);
  require(sampling.order >= 1 && sampling.order <= sampling.num_nodes, "sampling.order", "must be in [1, num_nodes]",
          sampling.order);
  require(sampling.first_node.size() == chirps, "sampling.first_node", "must have one entry per chirp",
          sampling.first_node.size());
  const size_t weights = chirps * sampling.order;
  require(sampling.value.size() == weights, "sampling.value", "must have shape [chirps, order]", sampling.value.size());
  require(sampling.slope.size() == weights, "sampling.slope", "must have shape [chirps, order]", sampling.slope.size());
  for (const int node : sampling.first_node) {
    require(node >= 0 && node <= sampling.num_nodes - sampling.order, "sampling.first_node",
            "must leave `order` nodes in range", node);
  }
  require_finite(sampling.value.data(), weights, "sampling.value");
  require_finite(sampling.slope.data(), weights, "sampling.slope");
  for (const std::vector<double>* rows : {&sampling.bend, &sampling.twist}) {
    const char* name = rows == &sampling.bend ? "sampling.bend" : "sampling.twist";
    require(rows->size() == sampling.bend.size(), name, "must be empty only where the other is, values", rows->size());
    require(rows->empty() || rows->size() == weights, name, "must be empty or have shape [chirps, order]", rows->size());
    require_finite(rows->data(), rows->size(), name);
  }
}

int64_t num_tasks(int num_chirps) { return (num_chirps + kChirpsPerTask - 1) / kChirpsPerTask; }

}  // namespace

Synthesizer::Synthesizer(const ChirpSequence& waveform, int num_channels, int num_groups, int64_t expected_echoes,
                         const SynthesisOptions& options)
    : waveform_(waveform), num_groups_(num_groups), method_(choose_method(options.method, expected_echoes)) {
  waveform.validate();
  require(num_channels >= 1, "num_channels", "must be at least 1", num_channels);
  require(num_groups >= 1, "num_groups", "must be at least 1", num_groups);
  require(expected_echoes >= 0, "expected_echoes", "must not be negative", expected_echoes);
  require(options.tolerance >= 1e-13 && options.tolerance <= 0.1, "tolerance", "must be in [1e-13, 0.1]",
          options.tolerance);
  tones_ = make_tones(method_, waveform.num_samples, options.tolerance);
  model_ = std::make_unique<CarrierModel>(waveform, tones_->reference_sample());
  if (options.per_sample) {
    sample_rows_ = make_direct(waveform.num_samples);
    per_sample_ = std::make_unique<PerSample>(waveform, *model_);
  }
  channels_.resize(num_channels);
}

Synthesizer::~Synthesizer() = default;
Synthesizer::Synthesizer(Synthesizer&&) noexcept = default;

void Synthesizer::validate(int channel, const Echoes& block) const {
  if (channel < 0 || channel >= static_cast<int>(channels_.size())) {
    throw std::out_of_range("channel: must be in [0, " + std::to_string(channels_.size()) + "), got " +
                            std::to_string(channel));
  }
  validate_sampling(block.sampling, waveform_.num_chirps);
  require(block.num_echoes >= 0, "num_echoes", "must not be negative", block.num_echoes);
  const size_t echoes = static_cast<size_t>(block.num_echoes);
  const size_t values = echoes * block.sampling.num_nodes;
  require(block.delay.size() == values, "delay", "must have shape [num_nodes, num_echoes]", block.delay.size());
  require(block.amplitude.size() == values, "amplitude", "must have shape [num_nodes, num_echoes]",
          block.amplitude.size());
  require(block.group.empty() || block.group.size() == echoes, "group", "must be empty or have one entry per echo",
          block.group.size());
  for (const uint32_t group : block.group) {
    require(group < static_cast<uint32_t>(num_groups_), "group", "must be below num_groups", group);
  }
  require_finite(block.delay.data(), values, "delay");
  require_finite(reinterpret_cast<const double*>(block.amplitude.data()), 2 * values, "amplitude");
}

// Doubles of one row, both parts.
int64_t Synthesizer::row_size(bool moving) const {
  return 2 * (moving && sample_rows_ ? sample_rows_ : tones_)->row_length();
}

void Synthesizer::add(int channel, const Echoes& block, Job* job) {
  validate(channel, block);
  if (block.num_echoes == 0) return;
  ChannelRows& rows = channels_[channel];
  if (block.sampling.is_static()) {
    rows.still.resize(static_cast<size_t>(row_size(false)) * num_groups_);
    parallel_for(1, [&](int64_t) { add_rows(block, 0, 1, rows.still.data(), job); });
  } else {
    add_moving(block, rows, job);
  }
  if (job) job->advance(block.num_echoes);
}

void Synthesizer::add_moving(const Echoes& block, ChannelRows& rows, Job* job) const {
  const size_t chirp_size = static_cast<size_t>(row_size(true)) * num_groups_;
  rows.moving.resize(chirp_size * waveform_.num_chirps);
  parallel_for(num_tasks(waveform_.num_chirps), [&](int64_t task) {
    const int first = static_cast<int>(task) * kChirpsPerTask;
    const int count = std::min(kChirpsPerTask, waveform_.num_chirps - first);
    add_rows(block, first, count, rows.moving.data() + chirp_size * first, job);
  });
}

// Every chirp takes all echoes in their order, in blocks that do not depend on the tasks: hence the same bits always.
void Synthesizer::add_rows(const Echoes& block, int first_chirp, int num_chirps, double* rows, Job* job) const {
  const int64_t stride = row_size(!block.sampling.is_static());
  for (int64_t begin = 0; begin < block.num_echoes; begin += Carriers::kCapacity) {
    if (job) job->throw_if_cancelled();
    const int count = static_cast<int>(std::min<int64_t>(Carriers::kCapacity, block.num_echoes - begin));
    for (int i = 0; i < num_chirps; ++i) add_some(block, first_chirp + i, begin, count, {rows + i * num_groups_ * stride, stride});
  }
}

void Synthesizer::add_some(const Echoes& block, int chirp, int64_t begin, int count, Rows rows) const {
  if (per_sample_ && !block.sampling.is_static()) {
    per_sample_->add(block, chirp, begin, count, sample_rows_->row_length(), rows);
    return;
  }
  Carriers carriers;
  evaluate_carriers(*model_, block, chirp, begin, count, carriers);
  tones_->add(carriers, rows);
}

std::vector<std::complex<double>> Synthesizer::cube(int group, Job* job) const {
  if (group < 0 || group >= num_groups_) {
    throw std::out_of_range("group: must be in [0, " + std::to_string(num_groups_) + "), got " + std::to_string(group));
  }
  const int64_t num_samples = waveform_.num_samples, num_chirps = waveform_.num_chirps;
  std::vector<std::complex<double>> out(channels_.size() * num_chirps * num_samples);
  for (size_t channel = 0; channel < channels_.size(); ++channel) {
    const ChannelRows& rows = channels_[channel];
    std::vector<std::complex<double>> still(num_samples);
    if (!rows.still.empty()) write_row(rows.still.data() + group * row_size(false), false, still.data());
    parallel_for(num_chirps, [&](int64_t chirp) {
      if (job) job->throw_if_cancelled();
      std::complex<double>* samples = out.data() + (channel * num_chirps + chirp) * num_samples;
      if (!rows.moving.empty()) write_row(rows.moving.data() + (chirp * num_groups_ + group) * row_size(true), true, samples);
      for (int64_t n = 0; n < num_samples; ++n) samples[n] += still[n];
    });
  }
  return out;
}

void Synthesizer::write_row(const double* row, bool moving, std::complex<double>* out) const {
  (moving && sample_rows_ ? sample_rows_ : tones_)->samples(row, out);
  if (!waveform_.real) return;
  for (int n = 0; n < waveform_.num_samples; ++n) out[n] = {std::numbers::sqrt2 * out[n].real(), 0.0};
}

}  // namespace echopath
